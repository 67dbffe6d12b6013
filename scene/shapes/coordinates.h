#pragma once

#include <cstddef>
#include <optional>

#include "scene/shapes/shape.h"

namespace abbe {

/// Where on a shape a point is, and how the point moves with it. `dp_du` and `dp_dv` are zero where the
/// coordinates tell no direction: at the poles of a sphere, and on triangles whose corners share coordinates
/// or have none.
struct SurfaceCoordinates {
  Imath::V2d uv{0, 0};
  Imath::V3d dp_du{0, 0, 0};
  Imath::V3d dp_dv{0, 0, 0};
};

/// The coordinates of a point on the shape, on triangle number `triangle` of a mesh. Pictures stand upright
/// and are not mirrored when seen from outside:
/// - a quad's u and v run along its edges;
/// - the square around a disc is [0, 1]^2; v runs along the part of +z in its plane, or of +y where the
///   normal is within 26 degrees of z, and u is perpendicular to both, to the right as seen from the front;
/// - on a sphere u is the longitude from +x over +y, over 2 pi, and v is 0 at the pole at -z, 1 at that at
/// +z;
/// - a mesh has what its file says, interpolated over each triangle, and a prism what `make_prism` says.
/// An instance has the coordinates of its prototype. A shape that moves is asked where it stands at `time`.
[[nodiscard]] SurfaceCoordinates coordinates(const Shape& shape, const Imath::V3d& point,
                                             std::size_t triangle, float time);

/// The normal that the vertex normals of a mesh give by interpolation over triangle number `triangle`, of
/// unit length and on the side of the `geometric` one, however the file's point, at that time. Nothing for a
/// shape without them.
[[nodiscard]] std::optional<Imath::V3d> interpolated_normal(const Shape& shape, const Imath::V3d& point,
                                                            std::size_t triangle, const Imath::V3d& geometric,
                                                            float time);

}  // namespace abbe
