#pragma once

#include <optional>

#include <ImathVec.h>

#include "scene/shapes/shape.h"

namespace abbe {

/// A rectangle by its local axes, worked out once.
struct Rectangle {
  Imath::V3d corner;
  Imath::V3d center;
  Imath::V3d x, y;  ///< Along the edges, of unit length.
  double size_u, size_v;

  /// Nothing for a parallelogram that is no rectangle.
  [[nodiscard]] static std::optional<Rectangle> of(const Quad& quad);
};

/// A rectangle projected onto the unit sphere around a point, sampled uniformly by solid angle. [Urena2013]
class SphericalRectangle {
 public:
  /// Nothing for one that looks small or is seen edge-on: there sampling by area is as good and loses no
  /// digits.
  [[nodiscard]] static std::optional<SphericalRectangle> seen_from(const Rectangle& rectangle,
                                                                   const Imath::V3d& point);

  [[nodiscard]] double solid_angle() const { return solid_angle_; }
  /// Parameters (u, v) of the quad at a direction uniform in the solid angle.
  [[nodiscard]] Imath::V2d sample(Imath::V2f u) const;

 private:
  SphericalRectangle() = default;
  // A complex number for the line x = const between the edges y0_ and y1_: the arguments of those of two
  // lines differ by the solid angle between them.
  [[nodiscard]] Imath::V2d turn_at(double x) const;

  // Local axes along the edges, origin at the point: the rectangle is [x0_, x1_] x [y0_, y1_] at distance
  // height_.
  double x0_, x1_, y0_, y1_, height_;
  Imath::V2d start_;  // turn_at(x0_)
  double solid_angle_;
};

}  // namespace abbe
