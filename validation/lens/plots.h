#pragma once

#include <string>

#include "validation/lens/figures.h"

// Plots of a lens as SVG documents, curves of a wavelength in its colour.
namespace abbe {

/// The spots of all fields side by side at one scale, about the chief ray of the primary wavelength, with a
/// circle of the Airy disc's radius there.
[[nodiscard]] std::string spot_plot(const LensFigures& figures);

/// The ray fans of a field: errors along y over the stop's y diameter, and along x over its x diameter,
/// dashed.
[[nodiscard]] std::string fan_plot(const LensFigures& figures, const LensFieldFigures& field);

/// Geometric modulation transfer of all fields over frequency, sagittal dashed.
[[nodiscard]] std::string lens_mtf_plot(const LensFigures& figures);

/// Back focus over wavelength, less that of the primary wavelength.
[[nodiscard]] std::string focal_shift_plot(const LensFigures& figures);

}  // namespace abbe
