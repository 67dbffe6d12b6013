#pragma once

#include <memory>
#include <numbers>
#include <optional>

#include <ImathBox.h>
#include <ImathVec.h>

#include "scene/lights/model.h"

namespace abbe {

/// Position [m] at that time of a point, given at time 0, that may move.
[[nodiscard]] Imath::V3f moved_position(const Imath::V3f& position, const Motion* motion, float time);
/// Direction at that time of a unit vector, given at time 0, that may rotate with a motion.
[[nodiscard]] Imath::V3f moved_direction(const Imath::V3f& direction, const Motion* motion, float time);
/// Sample of a light at `position`, for an emission factor of 1; nothing at the light itself.
[[nodiscard]] std::optional<LightSample> sample_towards_point(const Imath::V3f& position,
                                                              const Imath::V3f& point);
/// Box [m] around all positions of a point over the exposure.
[[nodiscard]] Imath::Box3d box_of_point(const Imath::V3f& position, const Motion* motion);
/// Bounds of a light at a point whose maximum intensity is `intensity`, with the given cone of emission.
[[nodiscard]] LightBounds bounds_of_point(const Imath::V3f& position, const Motion* motion,
                                          const EmissionCone& cone, double intensity);

/// A point that emits equally in all directions.
struct PointLight {
  static constexpr bool kIsDelta = true;
  static constexpr bool kAtInfinity = false;

  Imath::V3f position{0, 0, 0};                    ///< Render coordinates [m]; at time 0 if it moves.
  std::shared_ptr<const Motion> motion = nullptr;  ///< Null if it does not move.

  // Functions of `LightModel`.
  [[nodiscard]] std::optional<LightSample> sample(const LightQuery& query) const;
  [[nodiscard]] Imath::V3f emission_direction(const Imath::V3f& normal, Imath::V2f u, float time) const;
  [[nodiscard]] EmissionDensity emission_density(const EmissionQuery& query) const;
  [[nodiscard]] double etendue(double /*across*/) const { return 4 * std::numbers::pi; }
  [[nodiscard]] LightBounds bounds(const Shapes& /*shapes*/, double emission) const {
    return bounds_of_point(position, motion.get(), kEverywhere, emission);
  }
  [[nodiscard]] std::optional<BasicRay<double>> central_ray(const Ball& sphere) const;
  [[nodiscard]] double fan() const { return std::numbers::pi; }
};

/// A point that emits equally within a cone around `axis`.
struct SpotLight {
  static constexpr bool kIsDelta = true;
  static constexpr bool kAtInfinity = false;

  Imath::V3f position{0, 0, 0};  ///< Render coordinates [m]; at time 0 if it moves.
  Imath::V3f axis{0, 0, 1};      ///< Unit propagation direction along the cone's axis; at time 0 if it moves.
  float cap = 2;                 ///< 1 - cos of the half angle, in (0, 2]; precise for narrow cones.
  std::shared_ptr<const Motion> motion = nullptr;  ///< Null if it does not move.

  /// The axis at that time of the exposure.
  [[nodiscard]] Imath::V3f axis_at(float time) const { return moved_direction(axis, motion.get(), time); }
  /// True if the unit propagation direction `wi`, away from the light, lies in the cone: |wi - axis|^2 <= 2
  /// (1 - cos).
  [[nodiscard]] bool illuminates(const Imath::V3f& wi, float time) const {
    return (wi - (motion ? axis_at(time) : axis)).length2() <= 2 * cap;
  }

  // Functions of `LightModel`.
  [[nodiscard]] std::optional<LightSample> sample(const LightQuery& query) const;
  [[nodiscard]] float emission_factor(const Imath::V3f& /*normal*/, const Imath::V3f& wo, float time) const {
    return illuminates(wo, time) ? 1.0F : 0.0F;
  }
  [[nodiscard]] Imath::V3f emission_direction(const Imath::V3f& normal, Imath::V2f u, float time) const;
  [[nodiscard]] EmissionDensity emission_density(const EmissionQuery& query) const;
  [[nodiscard]] double etendue(double /*across*/) const {
    return 2 * std::numbers::pi * static_cast<double>(cap);
  }
  [[nodiscard]] LightBounds bounds(const Shapes& shapes, double emission) const;
  [[nodiscard]] std::optional<DirectionCone> cone_at(float time) const {
    return DirectionCone{time > 0 ? axis_at(time) : axis, cap};
  }
  [[nodiscard]] std::optional<BasicRay<double>> central_ray(const Ball& /*sphere*/) const {
    return BasicRay<double>{position, axis};
  }
  [[nodiscard]] double fan() const;
};

}  // namespace abbe
