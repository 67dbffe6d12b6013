#pragma once

#include <vector>

#include <ImathBox.h>

#include "lens/spectral_system.h"

namespace abbe::lens {

/// Light that passes backwards through a lens from an image point.
struct VisiblePupil {
  std::vector<Imath::V2d>
      points;  ///< Points inside the pupil and on its rim, in the tangent plane of the last vertex [mm].
  std::vector<Ray> leaving;  ///< Rays in object space through these points.
};

/// Movement of the center of the exit pupil in that plane over that of the image point, near the axis; 1 for
/// a distant pupil.
[[nodiscard]] double pupil_shift(const SpectralSystem& system, double wavelength_nm);

/// Finds the exit pupil from an image point at one wavelength. A grid is moved and zoomed until it contains
/// all passing rays; bisection from the center then finds the rim. Empty if no ray passes. Throws
/// Error{scene} if the passing rays have no bound.
[[nodiscard]] VisiblePupil search_pupil(const SpectralSystem& system, const Imath::V2d& image,
                                        double wavelength_nm);

}  // namespace abbe::lens
