#pragma once

#include <variant>

#include <ImathVec.h>

#include "materials/texture/texture_image.h"

namespace abbe {

/// An image of surface normals. Its first three channels, in [0, 1], encode the components from -1 to 1 along
/// dp/du, along dp/dv ("green is up") and along the outward normal.
struct NormalMap {
  TextureImage image;

  /// The unit normal at `uv`, in the axes dp/du, dp/dv and the outward normal.
  [[nodiscard]] Imath::V3d normal(const Imath::V2f& uv) const;
};

/// An image of heights above the surface: `height_m` [m] times its first channel.
struct BumpMap {
  TextureImage image;
  double height_m;

  /// Derivatives of the height [m] with respect to u and v.
  [[nodiscard]] Imath::V2d slope(const Imath::V2f& uv) const;
};

/// A map that perturbs the shading normal. It neither casts shadows nor occludes.
using Relief = std::variant<NormalMap, BumpMap>;

}  // namespace abbe
