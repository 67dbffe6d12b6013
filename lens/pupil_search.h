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

/// Finds it at one wavelength: first by a grid that is moved and zoomed until it holds all that passes, then
/// by bisection from the middle to the rim. No points where nothing passes. Throws Error{scene} where there
/// is no end to what passes.
[[nodiscard]] SeenPupil search_pupil(const SpectralSystem& system, const Imath::V2d& image,
                                     double wavelength_nm);

}  // namespace abbe::lens
