#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lens/field.h"
#include "lens/paraxial.h"
#include "lens/route.h"
#include "lens/seidel.h"

namespace abbe {

/// Properties of a lens at one field.
struct LensFieldFigures {
  double field;                                    ///< Field as in `lens::System`.
  std::vector<lens::Spot> spots;                   ///< One spot per wavelength.
  std::vector<std::optional<lens::Chief>> chiefs;  ///< One chief ray per wavelength.
  std::optional<double> relative_illumination;     ///< At the primary wavelength.
  std::vector<lens::RayFan> fans;  ///< One fan per wavelength; empty if the chief ray is blocked.
  /// One value per frequency, for lines across y; all wavelengths have equal weight.
  std::vector<double> tangential_mtf;
  std::vector<double> sagittal_mtf;

  /// Lateral colour [mm]: height of the chief ray at the shortest wavelength minus that at the longest.
  [[nodiscard]] std::optional<double> lateral_color_mm() const;
};

/// Ghost of an axial point in the image plane, at the primary wavelength.
struct GhostFigures {
  lens::Ghost ghost;
  double focus_mm;     ///< Paraxial distance of the ghost's focus behind the image plane.
  double diameter_mm;  ///< Diameter of its light in the image plane, from `lens::GhostFocus`.
};

/// All computed properties of a lens.
struct LensFigures {
  lens::System system;
  double stop_radius_mm;
  std::vector<lens::FirstOrder> first_order;  ///< One entry per wavelength.
  /// One entry per wavelength; empty if the axial beam is blocked.
  std::vector<std::optional<lens::Speed>> speed;
  /// Value for the field farthest from the axis at the primary wavelength; NaN if `speed` is empty.
  lens::SeidelSums seidel;
  std::optional<double> best_focus_mm;  ///< Result of `lens::best_focus`.
  std::vector<double> frequencies_per_mm;
  std::vector<LensFieldFigures> fields;
  std::vector<GhostFigures> ghosts;  ///< Sorted by reflectance over area, the brightest first.

  /// Label of a field: degrees for an object at infinity, millimetres for a near object.
  [[nodiscard]] std::string field_name(double field) const;
};

/// Sampling of a lens analysis.
struct LensAnalysisSettings {
  std::vector<double> frequencies_per_mm{10, 20, 40};
  int cells = 100;    ///< Cells per edge of the grid over a beam.
  int fan_rays = 41;  ///< Rays per fan.
};

/// Computes all properties of a lens. Throws the errors of `lens::stop_radius`.
[[nodiscard]] LensFigures lens_figures(const lens::System& system, const LensAnalysisSettings& settings);

}  // namespace abbe
