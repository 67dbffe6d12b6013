#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include <ImathVec.h>

#include "scene/lights/model.h"
#include "scene/shapes/basic.h"
#include "scene/shapes/shape.h"

namespace abbe {

/// A rectangle and its local axes, in the coordinates of the quad [m].
struct Rectangle {
  Imath::V3d corner;
  Imath::V3d center;
  Imath::V3d x, y;        ///< Unit vectors along the quad's edges.
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

/// An emitting quad, in the form that is used to sample points.
struct EmittingQuad {
  RenderedQuad quad;
  std::optional<Rectangle> rectangle;  ///< Present if the quad has right angles.
};

/// A surface that emits uniform radiance in all directions, from its outer side or from both sides. Spheres
/// viewed from outside are sampled by solid angle [Pharr2023, sec. 6.2.4], as are rectangles of large solid
/// angle [Urena2013]. All other area lights are sampled by area. Photons leave it uniformly over area and in
/// proportion to the cosine on the emitting sides.
struct AreaLight {
  static constexpr bool kIsDelta = false;
  static constexpr bool kAtInfinity = false;

  std::uint32_t shape = 0;  ///< Index into `Scene::shapes`.
  bool two_sided = false;
  double area = 0;  ///< Area of one side [m^2]; 0 before `measure`.
  /// Cumulative fraction of the area by triangle, ending in 1; empty except for meshes.
  std::vector<float> triangle_cdf = {};
  /// The quad, for lights that are quads. Other lights do not spend memory on it.
  std::shared_ptr<const EmittingQuad> flat = nullptr;

  /// Computes `area`, `triangle_cdf` and `flat` from the light's shape, as `abbe::measure`.
  void measure(const Shapes& shapes);

  // Functions of `LightModel`. `bounds` has the intensity of the projected area along the axis: constant for
  // a sphere; for a closed mesh, a quarter of its area.
  [[nodiscard]] std::optional<LightSample> sample(const LightQuery& query) const;
  [[nodiscard]] float pdf(const Shapes& shapes, const LightHit& at) const;
  [[nodiscard]] bool emits_towards(const Imath::V3f& normal, const Imath::V3f& wo) const {
    return two_sided || normal.dot(wo) > 0;
  }
  [[nodiscard]] float emission_factor(const Imath::V3f& normal, const Imath::V3f& wo, float /*time*/) const {
    return emits_towards(normal, wo) ? std::abs(normal.dot(wo)) : 0.0F;
  }
  [[nodiscard]] EmissionPoint sample_emission_point(const Shapes& shapes, Imath::V2f u, float time) const;
  [[nodiscard]] Imath::V3f emission_direction(const Imath::V3f& normal, Imath::V2f u, float time) const;
  [[nodiscard]] EmissionDensity emission_density(const EmissionQuery& query) const;
  [[nodiscard]] double etendue(double /*across*/) const {
    return std::numbers::pi * area * (two_sided ? 2 : 1);
  }
  [[nodiscard]] LightBounds bounds(const Shapes& shapes, double emission) const;
  [[nodiscard]] Imath::Box3d box(const Shapes& shapes) const;
  [[nodiscard]] const Motion* motion_in(const Shapes& shapes) const;
  [[nodiscard]] std::size_t memory_bytes() const {
    return triangle_cdf.size() * sizeof(float) + (flat ? sizeof(EmittingQuad) : 0);
  }
};

}  // namespace abbe
