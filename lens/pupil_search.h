#pragma once

#include <vector>

#include <ImathBox.h>

#include "lens/spectral_system.h"

namespace abbe::lens {

/// What gets from a point of the image through a lens, backwards.
struct SeenPupil {
  std::vector<Imath::V2d> points;  ///< In the tangent plane of the last vertex [mm]: inside it, and its rim.
  std::vector<Ray> leaving;        ///< The rays of the object's side that these points make.
};

/// How far the middle of the exit pupil moves in that plane, over how far the point of the image does that
/// sees it, near the axis: 1 where the pupil is far away.
[[nodiscard]] double pupil_shift(const SpectralSystem& system, double wavelength_nm);

/// Finds it at one wavelength: first by a grid that is moved and zoomed until it holds all that passes, then
/// by bisection from the middle to the rim. No points where nothing passes. Throws Error{scene} where there
/// is no end to what passes.
[[nodiscard]] SeenPupil search_pupil(const SpectralSystem& system, const Imath::V2d& image,
                                     double wavelength_nm);

}  // namespace abbe::lens
