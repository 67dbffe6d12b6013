#pragma once

#include <optional>
#include <vector>

#include "lens/exit_pupil.h"
#include "lens/field.h"
#include "lens/route.h"
#include "lens/spectral_system.h"
#include "scene/camera/model.h"

namespace abbe {

/// A lens system ready to look through, all lengths in mm.
struct LensOptics {
  /// Whether light that surfaces reflect twice is looked for.
  enum class Ghosts { left_out, enumerated };

  lens::SpectralSystem system;
  lens::ExitPupil pupil;  ///< For a film, and wavelengths, of which nothing else may be asked.
  /// Film of the pinhole whose image is as large, paraxially, at the primary wavelength, to it; none where
  /// what the lens is to see has no image.
  std::optional<double> pinhole_distance_mm;
  /// Film to the principal plane of image space, likewise; of lenses without power that to the pinhole.
  std::optional<double> image_distance_mm;
  std::optional<lens::Speed>
      speed;  ///< On the axis at the primary wavelength; none where its beam does not get there.
  std::vector<lens::Route> routes;  ///< By `LensRoute`.
  std::vector<double> route_share;  ///< Of the rays; those of all ghosts are `kGhostShare`, if there are any.
  double least_cosine;              ///< Of the angle of incidence on the film, by all routes.

  /// Half of it is drawn by the reflectances of their surfaces, half evenly.
  static constexpr double kGhostShare = 0.25;

  /// For a film of this grid, in the plane of the image about the axis, and the wavelengths between the ends
  /// of a range. With ghosts, surfaces without a clear aperture have that of `with_clear_apertures`. Throws
  /// what `lens::ExitPupil` does.
  LensOptics(lens::System lens, double stop_radius_mm, const FilmGrid& grid, double low_nm, double high_nm,
             Ghosts ghosts = Ghosts::left_out);

  [[nodiscard]] bool has_ghosts() const { return routes.size() > 1; }
  [[nodiscard]] std::size_t last_surface() const { return system.system().surfaces.size() - 1; }
  [[nodiscard]] double semi_aperture_mm(std::size_t surface) const {
    return *system.system().surfaces[surface].semi_aperture_mm;
  }

 private:
  void enumerate_ghosts(const Imath::V2d& half_film_mm, double low_nm, double high_nm);
};

}  // namespace abbe
