#pragma once

#include <string>

#include "validation/lens/figures.h"

// Plots of a lens as SVG documents. Curves of a wavelength have its colour.
namespace abbe {

/// Spot diagrams of all fields at one scale, centred on the chief ray of the primary wavelength. A circle
/// shows the Airy disc.
[[nodiscard]] std::string spot_plot(const LensFigures& figures);

/// Ray fans of a field: the error along y over the height in the stop along y, and dashed the error along x
/// over the height along x.
[[nodiscard]] std::string fan_plot(const LensFigures& figures, const LensFieldFigures& field);

/// Geometric modulation transfer over frequency for all fields; sagittal curves are dashed.
[[nodiscard]] std::string lens_mtf_plot(const LensFigures& figures);

/// Shift of the paraxial focus over wavelength, relative to the primary wavelength.
[[nodiscard]] std::string focal_shift_plot(const LensFigures& figures);

}  // namespace abbe
