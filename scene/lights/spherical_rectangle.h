#pragma once

#include <optional>

#include <ImathVec.h>

#include "scene/shapes/shape.h"

namespace abbe {

/// A rectangle projected onto the unit sphere around a point, sampled uniformly by solid angle. [Urena2013]
class SphericalRectangle {
 public:
  /// Nothing for a parallelogram that is no rectangle, and for one that looks small or is seen edge-on: there
  /// sampling by area is as good and loses no digits.
  [[nodiscard]] static std::optional<SphericalRectangle> seen_from(const Quad& quad, const Imath::V3d& point);

  [[nodiscard]] double solid_angle() const { return solid_angle_; }
  /// Parameters (u, v) of the quad at a direction uniform in the solid angle.
  [[nodiscard]] Imath::V2d sample(Imath::V2f u) const;

 private:
  SphericalRectangle() = default;

  // Local axes along the edges, origin at the point: the rectangle is [x0_, x1_] x [y0_, y1_] at distance
  // height_.
  double x0_, x1_, y0_, y1_, height_;
  // z components of the normals of the planes through the point and the edges y = y0 and y = y1.
  double b0_, b1_;
  double k_;  // 2 pi minus the two corner angles at x = x0
  double solid_angle_;
};

}  // namespace abbe
