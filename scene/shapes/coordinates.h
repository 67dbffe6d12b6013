#pragma once

#include <cstddef>
#include <optional>

#include "scene/shapes/shape.h"

namespace abbe {

/// Texture coordinates of a point and the derivatives of the position [m] in render coordinates. `dp_du` and
/// `dp_dv` are zero where they are undefined: at the poles of a sphere, and on triangles whose corners have
/// equal coordinates or none.
struct SurfaceCoordinates {
  Imath::V2d uv{0, 0};
  Imath::V3d dp_du{0, 0, 0};
  Imath::V3d dp_dv{0, 0, 0};
};

/// Texture coordinates of a point [m] on the shape; `triangle` is the index of its triangle in a mesh and has
/// no effect on other shapes. u runs to the right and v upwards in the picture. Pictures appear upright and
/// not mirrored from outside:
/// - quad: u and v run along its edges;
/// - disc: the square around it is [0, 1]^2. v runs along the projection of +z, or of +y if the normal is
/// within 26 degrees of z. u is perpendicular to both, to the right as seen from the front;
/// - sphere: u is the longitude from +x over +y divided by 2 pi; v is 0 at the pole at -z and 1 at the pole
/// at +z;
/// - mesh: the coordinates of its file, interpolated over each triangle; for a prism those of `make_prism`.
/// An instance has the coordinates of its prototype. A moving shape is evaluated at `time`, a fraction of
/// the exposure.
[[nodiscard]] SurfaceCoordinates coordinates(const Shape& shape, const Imath::V3d& point,
                                             std::size_t triangle, float time);

/// Unit normal interpolated from the vertex normals of a mesh over triangle number `triangle`, at that time.
/// It is flipped to the side of the `geometric` normal, the outward unit normal, if necessary. Where it is
/// perpendicular to that normal, the result is `geometric`. Nothing for a shape without vertex normals.
[[nodiscard]] std::optional<Imath::V3d> interpolated_normal(const Shape& shape, const Imath::V3d& point,
                                                            std::size_t triangle, const Imath::V3d& geometric,
                                                            float time);

}  // namespace abbe
