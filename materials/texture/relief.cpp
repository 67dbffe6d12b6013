#include "materials/texture/relief.h"

namespace abbe {

Imath::V3d NormalMap::normal(const Imath::V2f& uv) const {
  const TextureImage::Blend blend = image.blend(uv);
  const Imath::V3f code(image.value(blend, 0), image.value(blend, 1), image.value(blend, 2));
  return (Imath::V3d(code) * 2 - Imath::V3d(1)).normalized();
}

Imath::V2d BumpMap::slope(const Imath::V2f& uv) const {
  return image.gradient(uv, 0) * height_m;
}

}  // namespace abbe
