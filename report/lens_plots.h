#pragma once

#include <string>

#include "report/lens_figures.h"

// Plots of a lens as SVG documents. Spots and fans of a wavelength have its colour.
namespace abbe {

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
