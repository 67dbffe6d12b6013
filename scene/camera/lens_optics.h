#pragma once

#include <optional>
#include <vector>

#include "lens/exit_pupil.h"
#include "lens/field.h"
#include "lens/route.h"
#include "lens/spectral_system.h"
#include "scene/camera/model.h"

namespace abbe {

/// A lens system prepared for rendering; all lengths in mm.
struct LensOptics {
  /// Treatment of light that two surfaces reflect: no routes for it, or one for each pair of surfaces.
  enum class Ghosts { left_out, enumerated };

  lens::SpectralSystem system;
  lens::ExitPupil pupil;  ///< Valid only for the film and the wavelengths of the constructor.
  /// Distance >= 0 from the film to the pinhole that would give an image of the same size, paraxially and at
  /// the primary wavelength. Nothing if the object has no image at a finite distance.
  std::optional<double> pinhole_distance_mm;
  /// Paraxial distance >= 0 from the film to the rear principal plane at the primary wavelength. For a lens
  /// without power it is the distance of the pinhole.
  std::optional<double> image_distance_mm;
  /// Speed on the axis at the primary wavelength; nothing if the axial beam does not arrive.
  std::optional<lens::Speed> speed;
  std::vector<lens::Route> routes;  ///< Indexed by `LensRoute`; the first is that of the image.
  /// Probability of each route; those of all ghosts sum to `kGhostProbability`, if there are any.
  std::vector<double> route_probability;
  double least_cosine;  ///< Minimum cosine of the angle of incidence on the film, over all routes.

  /// Probability of all ghosts. Half of it is distributed in proportion to the reflectances of their
  /// surfaces, half uniformly.
  static constexpr double kGhostProbability = 0.25;

  /// Prepares a lens for a film of this grid, centred on the axis in the image plane, and for wavelengths
  /// from `low_nm` to `high_nm`. With ghosts, surfaces without a clear aperture get that of
  /// `with_clear_apertures`. Throws Error{scene} if no light arrives, if the pupil has no bound, or if the
  /// field exceeds 87 degrees from the axis.
  LensOptics(lens::System lens, double stop_radius_mm, const FilmGrid& grid, double low_nm, double high_nm,
             Ghosts ghosts = Ghosts::left_out);

  /// True if there are routes of ghosts.
  [[nodiscard]] bool has_ghosts() const { return routes.size() > 1; }
  /// Index of the surface nearest to the film.
  [[nodiscard]] std::size_t last_surface() const { return system.system().surfaces.size() - 1; }
  /// Clear radius of a surface that has a clear aperture; all have one if ghosts are enumerated.
  [[nodiscard]] double semi_aperture_mm(std::size_t surface) const {
    return *system.system().surfaces[surface].semi_aperture_mm;
  }

 private:
  void enumerate_ghosts(const Imath::V2d& half_film_mm, double low_nm, double high_nm);
};

}  // namespace abbe
