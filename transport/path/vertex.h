#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "materials/bsdf/polarisation.h"
#include "materials/material.h"
#include "scene/scene.h"
#include "scene/surface.h"
#include "transport/path/interface.h"
#include "transport/path/walk.h"

namespace abbe {

/// A path's arrival at a surface, ready to scatter.
struct SurfaceVertex {
  SurfaceHit hit;
  Basis<float> frame;
  Imath::V3f wo;                           ///< Local.
  bool relief = false;                     ///< The frame's z differs from the normal of the shape.
  float cos_outside = 1;                   ///< Of wo with the normal of the shape, on a relief.
  std::optional<MediumStack> beyond = {};  ///< What a path let through is in, where matter may be nested.
  Bsdf bsdf;

  /// Where a meter stands: white, diffuse, and seen along its normal, so that the radiance leaving it is the
  /// irradiance over pi.
  static SurfaceVertex meter(const Imath::V3f& point, const Imath::V3f& normal) {
    return {{point, normal, 0, 0}, Basis<float>(normal), {0, 0, 1}, DiffuseBsdf{SampledSpectrum(1.0F)}};
  }

  SurfaceVertex(const SurfaceHit& surface, const Basis<float>& axes, const Imath::V3f& outgoing,
                Bsdf scattering)
      : hit(surface), frame(axes), wo(outgoing), bsdf(std::move(scattering)) {}
  /// Where a walk meets the scene; `met` tells of matter that may be nested. Where nothing changes there the
  /// path goes straight on, as through equal indices.
  SurfaceVertex(const Scene& scene, const SurfaceHit& surface, const std::optional<Interface>& met,
                const Walk& walk)
      : hit(surface),
        frame(surface.normal),
        wo(frame.to_local(-walk.ray.direction)),
        bsdf(scene.needs.textures ? placed(scene, met, walk) : scattering(scene, met, walk, {0, 0})) {
    if (met) beyond = met->beyond;
  }

  /// What a path within `inside` is in when it has been let through.
  [[nodiscard]] MediumStack behind(const Scene& scene, const MediumStack& inside) const {
    if (beyond) return *beyond;
    MediumStack crossed = inside;
    crossed.cross(scene, hit.shape, wo.z > 0);
    return crossed;
  }

  /// Where it is, for light to arrive: on the side of the path by the normal that the model sees, from both
  /// sides where it scatters to both. Glossy where lobes scatter alone; which parts a mixture has is not
  /// asked.
  [[nodiscard]] LightSampleContext place() const {
    const bool both = std::holds_alternative<RoughDielectricBsdf>(bsdf);
    const bool glossy = is_any_of<RoughDielectricBsdf, RoughConductorBsdf, CosinePowerBsdf<false>,
                                  CosinePowerBsdf<true>, PhongBsdf, RetroreflectorBsdf>(bsdf);
    return {hit.point, both ? std::nullopt : std::optional(wo.z > 0 ? frame.z : -frame.z), glossy};
  }

  /// A ray that leaves it into the unit direction `w`, at that time of the exposure.
  [[nodiscard]] Ray leave(const Imath::V3f& w, float time) const {
    return spawn(hit, frame.to_world(wo), w, time);
  }

  /// The model's event, corrected on a relief. In line, as a call would cost every path.
  [[nodiscard, gnu::always_inline]] std::optional<BsdfSample> scatter(const BsdfRandom& u, int hero,
                                                                      TransportMode mode) const {
    std::optional<BsdfSample> event = sample(bsdf, wo, u, hero, mode);
    if (relief && event)
      event->weight *= shading_normal_correction(frame.to_world(event->wi), event->wi, mode);
    return event;
  }
  /// What it does to polarisation between the way that the path came and the local direction `wi`, in the
  /// world; see `mueller` of scattering models.
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane = {}) const {
    std::optional<MuellerMatrix> matrix = abbe::mueller(bsdf, wo, wi, delta, lane);
    if (matrix) matrix->axis = frame.to_world(matrix->axis);
    return matrix;
  }
  /// By which refraction has divided radiance, were the event's light radiance: the square of the index it
  /// goes on in over that it came in, at the hero's wavelength; 1 where nothing is refracted.
  [[nodiscard]] float squared_eta(const BsdfSample& event, int hero) const {
    if (!event.transmitted) return 1;
    const float n = index_inside(bsdf, hero);
    return wo.z > 0 ? n * n : 1 / (n * n);
  }
  /// f(wo, wi) of the model, corrected likewise, towards a direction in the world and local.
  [[nodiscard]] SampledSpectrum f(const Imath::V3f& world, const Imath::V3f& local,
                                  TransportMode mode) const {
    SampledSpectrum f = eval(bsdf, wo, local, mode);
    if (relief) f *= shading_normal_correction(world, local, mode);
    return f;
  }

  /// What goes on towards a direction of the world: nothing towards one that floats do not tell from the
  /// plane of the surface, as it may lead to either side.
  struct Departure {
    Imath::V3f wi;      ///< The direction, local.
    SampledSpectrum f;  ///< See `f`; what goes on is this times |wi.z|.
    bool crosses;       ///< To the other side of the surface than the path came from.
  };
  [[nodiscard]] Departure towards(const Imath::V3f& world, TransportMode mode) const {
    constexpr float kGrazing = 4 * std::numeric_limits<float>::epsilon();
    const Imath::V3f wi = frame.to_local(world);
    const bool leaves = std::abs(wi.z) > kGrazing;
    return {wi, leaves ? f(world, wi, mode) : SampledSpectrum(0.0F), wi.z * wo.z < 0};
  }

 private:
  // What scattering towards a direction counts on a relief, over what the model says. It is 0 for
  // directions that the model and the shape see on different sides, so that no light leaks through. Power,
  // unlike radiance, takes |wo.z cos_i|/|cos_o wi.z|, the cosines being those with the normal of the shape
  // and z those with the model's: then both mean the same light. [Veach1997, sec. 5.3]
  [[nodiscard]] float shading_normal_correction(const Imath::V3f& world, const Imath::V3f& local,
                                                TransportMode mode) const {
    const float cos_world = world.dot(hit.normal);
    if (!(cos_world * local.z > 0)) return 0;
    return mode == TransportMode::radiance ? 1 : std::abs(wo.z * cos_world / (cos_outside * local.z));
  }

  [[nodiscard]] Bsdf scattering(const Scene& scene, const std::optional<Interface>& met, const Walk& walk,
                                const Imath::V2f& uv) const {
    if (met && met->passes) return DielectricBsdf{SampledSpectrum(1), false};
    return make_bsdf(scene.materials[scene.shapes[hit.shape].material],
                     {walk.lambda_nm(), uv, met ? met->outside : nullptr});
  }

  // The scattering where the material may need more than a normal: turns what has been made so far. Out of
  // line, as a scene without textures pays for a longer loop.
  [[nodiscard, gnu::noinline]] Bsdf placed(const Scene& scene, const std::optional<Interface>& met,
                                           const Walk& walk) {
    if (met && met->passes) return scattering(scene, met, walk, {0, 0});
    const SurfacePlace place = textured_place(scene, hit, walk.ray.time);
    frame = place.frame;
    wo = frame.to_local(-walk.ray.direction);
    relief = place.relief;
    cos_outside = -walk.ray.direction.dot(hit.normal);
    // Seen from the side that faces away, a relief is black.
    if (relief && !(cos_outside * wo.z > 0)) return DiffuseBsdf{};
    return scattering(scene, met, walk, place.uv);
  }
};

}  // namespace abbe
