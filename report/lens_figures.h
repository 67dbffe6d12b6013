#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lens/field.h"
#include "lens/paraxial.h"
#include "lens/route.h"
#include "lens/seidel.h"

namespace abbe {

/// Properties of a lens at one field. Lists per wavelength have the order of `lens::System`.
struct LensFieldFigures {
  double field;                   ///< Field as in `lens::System`: degrees, or mm for a near object.
  std::vector<lens::Spot> spots;  ///< One spot per wavelength; without rays if its beam is blocked.
  /// One chief ray per wavelength; nothing if it does not arrive at the image.
  std::vector<std::optional<lens::Chief>> chiefs;
  /// Irradiance relative to that on the axis, at the primary wavelength; nothing as for
  /// `lens::relative_illumination`.
  std::optional<double> relative_illumination;
  /// One fan per wavelength, relative to the chief ray of the primary wavelength. Empty if that ray is
  /// blocked.
  std::vector<lens::RayFan> fans;
  /// Geometric modulation in [0, 1] of a pattern that varies along y, one value per frequency of
  /// `LensFigures`. The object has equal radiance at all wavelengths.
  std::vector<double> tangential_mtf;
  /// Geometric modulation in [0, 1] of a pattern that varies along x, one value per frequency of
  /// `LensFigures`.
  std::vector<double> sagittal_mtf;

  /// Lateral colour [mm]: y of the chief ray at the shortest wavelength minus that at the longest. Nothing if
  /// either is blocked.
  [[nodiscard]] std::optional<double> lateral_color_mm() const;
};

/// Ghost of an axial point in the image plane, at the primary wavelength.
struct GhostFigures {
  lens::Ghost ghost;
  /// Paraxial distance of the ghost's focus behind the image plane; negative in front of it, infinite for
  /// parallel light.
  double focus_mm;
  double diameter_mm;  ///< Beam diameter in the image plane; infinite if no aperture limits it.
};

/// All computed properties of a lens. Lists per wavelength have the order of `system`.
struct LensFigures {
  lens::System system;                        ///< The analysed lens.
  double stop_radius_mm;                      ///< Result of `lens::stop_radius`.
  std::vector<lens::FirstOrder> first_order;  ///< One entry per wavelength.
  /// One entry per wavelength; nothing if the axial beam does not arrive at the image.
  std::vector<std::optional<lens::Speed>> speed;
  /// Seidel sums at the primary wavelength for the field farthest from the axis. Colour sums are between the
  /// shortest and the longest wavelength. NaN if there is no `speed` at the primary wavelength.
  lens::SeidelSums seidel;
  /// Displacement of the image plane towards +z that `lens::best_focus` finds; nothing as there.
  std::optional<double> best_focus_mm;
  std::vector<double> frequencies_per_mm;  ///< Spatial frequencies of the MTF [cycles/mm], as requested.
  std::vector<LensFieldFigures> fields;    ///< One entry per field, in the order of `system`.
  std::vector<GhostFigures> ghosts;        ///< Sorted by reflectance over area, the brightest first.

  /// Label of a field, such as "14 deg" for an object at infinity or "5 mm" for a near object.
  [[nodiscard]] std::string field_name(double field) const;
};

/// Sampling of a lens analysis.
struct LensAnalysisSettings {
  std::vector<double> frequencies_per_mm{10, 20, 40};  ///< Spatial frequencies of the MTF [cycles/mm].
  int cells = 100;    ///< Cells per edge of the square grid of rays over a beam.
  int fan_rays = 41;  ///< Rays per fan, evenly spaced from one edge of the stop to the other.
};

/// Computes all properties of a lens with at least one field and one wavelength. Throws the errors of
/// `lens::stop_radius`.
[[nodiscard]] LensFigures lens_figures(const lens::System& system, const LensAnalysisSettings& settings);

}  // namespace abbe
