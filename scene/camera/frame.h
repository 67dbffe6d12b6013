#pragma once

#include <ImathVec.h>

namespace abbe {

/// Position and orientation of a camera: `right`, `up` and `forward` are orthonormal.
struct CameraFrame {
  Imath::V3d position{0, 0, 0};
  Imath::V3d right{1, 0, 0};
  Imath::V3d up{0, 1, 0};
  Imath::V3d forward{0, 0, 1};
};

}  // namespace abbe
