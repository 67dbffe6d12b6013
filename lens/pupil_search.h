#pragma once

#include <vector>

#include <ImathBox.h>

#include "lens/spectral_system.h"

namespace abbe::lens {

/// Light that passes backwards through a lens from an image point.
struct VisiblePupil {
  /// Points inside the pupil, then points just outside its rim, in the tangent plane of the last vertex [mm].
  std::vector<Imath::V2d> points;
  /// Rays through the inner points and through points just inside the rim. They start at the first surface
  /// and travel towards -z.
  std::vector<Ray> leaving;
};

/// Movement of the center of the exit pupil in the tangent plane of the last vertex, over that of the image
/// point, near the axis; 1 for a distant pupil.
[[nodiscard]] double pupil_shift(const SpectralSystem& system, double wavelength_nm);

/// Finds the exit pupil from a point (x, y) of the image [mm] at one wavelength, with clear apertures. A grid
/// is moved and zoomed until it contains all passing rays; bisection from the center then finds the rim.
/// Empty if no ray passes. Throws Error{scene} if the passing rays have no bound.
[[nodiscard]] VisiblePupil search_pupil(const SpectralSystem& system, const Imath::V2d& image,
                                        double wavelength_nm);

}  // namespace abbe::lens
