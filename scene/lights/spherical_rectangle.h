#pragma once

#include <optional>

#include <ImathVec.h>

#include "scene/shapes/shape.h"

namespace abbe {

/// A rectangle and its local axes, in the coordinates of the quad [m].
struct Rectangle {
  Imath::V3d corner;
  Imath::V3d center;
  Imath::V3d x, y;        ///< Unit vectors along `Quad::edge_u` and `Quad::edge_v`.
  double size_u, size_v;  ///< Lengths of these edges [m].

  /// The rectangle of a quad; nothing for a parallelogram without right angles.
  [[nodiscard]] static std::optional<Rectangle> of(const Quad& quad);
};

/// A rectangle projected onto the unit sphere around a point and sampled uniformly by solid angle.
/// [Urena2013]
class SphericalRectangle {
 public:
  /// Projects a rectangle as viewed from `point`, from either side. Nothing if its area is less than half the
  /// squared distance of its center, or if it is viewed edge-on. Sampling by area is then as good and more
  /// precise.
  [[nodiscard]] static std::optional<SphericalRectangle> project(const Rectangle& rectangle,
                                                                 const Imath::V3d& point);

  /// Solid angle [sr].
  [[nodiscard]] double solid_angle() const { return solid_angle_; }
  /// Parameters (u, v) in [0, 1]^2 of the quad's point in a direction that is uniform in the solid angle, by
  /// random numbers in [0, 1)^2.
  [[nodiscard]] Imath::V2d sample(Imath::V2f u) const;

 private:
  SphericalRectangle() = default;
  // A complex number for the line x = const between the edges y0_ and y1_. The arguments of two such numbers
  // differ by the solid angle between the lines.
  [[nodiscard]] Imath::V2d turn_at(double x) const;

  // Local axes along the edges with the point as origin: the rectangle is [x0_, x1_] x [y0_, y1_] at distance
  // height_.
  double x0_, x1_, y0_, y1_, height_;
  Imath::V2d start_;  // turn_at(x0_)
  double solid_angle_;
};

}  // namespace abbe
