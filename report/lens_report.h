#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lens/field.h"
#include "lens/paraxial.h"
#include "lens/route.h"
#include "lens/seidel.h"

namespace abbe {

/// Properties of a lens at one field. Spots, chief rays and fans are one per wavelength of `lens::System`.
struct LensFieldFigures {
  double field;                   ///< Field as in `lens::System`: degrees, or mm for a near object.
  std::vector<lens::Spot> spots;  ///< Without rays if the beam is blocked.
  std::vector<std::optional<lens::Chief>> chiefs;
  /// `lens::relative_illumination` at the primary wavelength.
  std::optional<double> relative_illumination;
  /// Relative to the chief ray of the primary wavelength; empty if that ray is blocked.
  std::vector<lens::RayFan> fans;
  /// `lens::geometric_mtf` of patterns that vary along y and along x, one value per frequency of
  /// `LensFigures`. The object has equal radiance at all wavelengths.
  std::vector<double> tangential_mtf, sagittal_mtf;

  /// Height of the chief ray at the shortest wavelength minus that at the longest [mm]. Nothing if either is
  /// blocked.
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

/// All computed properties of a lens.
struct LensFigures {
  lens::System system;
  double stop_radius_mm;
  std::vector<lens::FirstOrder> first_order;      ///< One per wavelength.
  std::vector<std::optional<lens::Speed>> speed;  ///< One per wavelength.
  /// Seidel sums at the primary wavelength for the field farthest from the axis. Colour sums are between the
  /// shortest and the longest wavelength. NaN if there is no `speed` at the primary wavelength.
  lens::SeidelSums seidel;
  std::optional<double> best_focus_mm;     ///< `lens::best_focus`.
  std::vector<double> frequencies_per_mm;  ///< Spatial frequencies of the MTF [cycles/mm].
  std::vector<LensFieldFigures> fields;    ///< In the order of `system`.
  std::vector<GhostFigures> ghosts;        ///< Sorted by reflectance over area, the brightest first.

  /// Label of a field, such as "14 deg" for an object at infinity or "5 mm" for a near object.
  [[nodiscard]] std::string field_name(double field) const;
};

/// Computes all properties of a lens. Throws the errors of `lens::stop_radius`.
[[nodiscard]] LensFigures lens_figures(const lens::System& system, std::vector<double> frequencies_per_mm);

/// SVG document with the section of a lens in the plane x = 0, +z to the right and +y upwards. It shows the
/// glasses, the stop and the image, with a scale bar in mm and the title of the system.
/// Each field has a colour and five rays in the plane of the section at the primary wavelength. They are the
/// chief ray, the two rays through the edges of the stop, and two halfway between them. A ray that does
/// not arrive at the image ends at the last surface that it passes. Fields whose chief ray does not pass the
/// stop have no rays. Surfaces without a clear aperture are drawn 5 % farther out than the rays hit them.
[[nodiscard]] std::string lens_drawing(const LensFigures& figures);

// Plots of a lens as SVG documents. Spots and fans of a wavelength have its colour.

/// Spot diagrams of all fields at one scale, x to the right and y upwards, centred on the chief ray of the
/// primary wavelength. The title gives the width of a box [µm]. A circle shows the Airy disc of the primary
/// wavelength on the axis. The box of a field without that chief ray contains no spots.
[[nodiscard]] std::string spot_plot(const LensFigures& figures);

/// Ray fans of one of the lens's fields. Solid curves show the error along y over the height in the stop
/// along y. Dashed curves show the error along x over the height along x. Errors are in µm, heights in radii
/// of the stop. Rays that do not arrive are omitted.
[[nodiscard]] std::string fan_plot(const LensFigures& figures, const LensFieldFigures& field);

/// Geometric modulation transfer of all fields, over frequencies [cycles/mm] from 0 to the largest of
/// `frequencies_per_mm`. There must be at least one. Each field has a colour; sagittal curves are dashed.
[[nodiscard]] std::string lens_mtf_plot(const LensFigures& figures);

/// Shift of the paraxial focus [µm] relative to the primary wavelength, from the shortest to the longest
/// wavelength of the system. It is positive if the focus is farther behind the lens.
[[nodiscard]] std::string focal_shift_plot(const LensFigures& figures);

}  // namespace abbe
