#pragma once

#include <variant>

#include <ImathVec.h>

#include "materials/texture/texture_image.h"

namespace abbe {

/// Normals of a surface by an image: three channels from 0 to 1 that stand for components from -1 to 1 along
/// dp/du, along dp/dv ("green is up") and along the outward normal.
struct NormalMap {
  TextureImage image;

  /// The unit normal at `uv`, in the axes dp/du, dp/dv and outward normal.
  [[nodiscard]] Imath::V3d normal(const Imath::V2f& uv) const;
};

/// Heights above a surface by an image: `height_m` [m] times its one channel.
struct BumpMap {
  TextureImage image;
  double height_m;

  /// How the height [m] changes with u and with v.
  [[nodiscard]] Imath::V2d slope(const Imath::V2f& uv) const;
};

/// What makes a smooth surface scatter as if it had small shapes. They throw no shadows and hide nothing.
using Relief = std::variant<NormalMap, BumpMap>;

}  // namespace abbe
