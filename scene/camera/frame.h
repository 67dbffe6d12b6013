#pragma once

#include <ImathVec.h>

namespace abbe {

/// Position [m] and orientation of a camera in render coordinates. `forward` is the unit viewing direction
/// into the scene. `right` and `up` are unit vectors along the picture's right and up. The scene file's
/// cameras have `up` = `right` x `forward`; the default values do not.
struct CameraFrame {
  Imath::V3d position{0, 0, 0};
  Imath::V3d right{1, 0, 0};
  Imath::V3d up{0, 1, 0};
  Imath::V3d forward{0, 0, 1};
};

}  // namespace abbe
