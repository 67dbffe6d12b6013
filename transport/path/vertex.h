#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <ImathVec.h>

#include "materials/material.h"
#include "scene/scene.h"
#include "scene/surface.h"
#include "transport/path/interface.h"
#include "transport/path/packet.h"

namespace abbe {

/// A path's arrival at a surface, ready to scatter.
struct Vertex {
  SurfaceHit hit;
  Basis<float> frame;
  Imath::V3f wo;                        ///< Local.
  bool relief = false;                  ///< The frame's z differs from the normal of the shape.
  float cos_outside = 1;                ///< Of wo with the normal of the shape, on a relief.
  const MediumStack* beyond = nullptr;  ///< What a path let through is in, where matter may be nested.
  Bsdf bsdf;

  /// Where a meter stands: white, diffuse, and seen along its normal, so that the radiance leaving it is the
  /// irradiance over pi.
  static Vertex meter(const Imath::V3f& point, const Imath::V3f& normal) {
    return {{point, normal, 0, 0}, Basis<float>(normal), {0, 0, 1}, DiffuseBsdf{SampledSpectrum(1.0F)}};
  }

  Vertex(const SurfaceHit& surface, const Basis<float>& axes, const Imath::V3f& outgoing, Bsdf scattering)
      : hit(surface), frame(axes), wo(outgoing), bsdf(std::move(scattering)) {}
  Vertex(const Scene& scene, const SurfaceHit& surface, const Imath::V3f& incoming,
         const SampledSpectrum& wavelengths_nm)
      : Vertex(scene, surface, nullptr, incoming, wavelengths_nm) {}
  /// Of matter that may be nested; where nothing changes the path goes straight on, as through equal indices.
  /// `met` must outlive the vertex.
  Vertex(const Scene& scene, const Interface& met, const Imath::V3f& incoming,
         const SampledSpectrum& wavelengths_nm)
      : Vertex(scene, met.hit, &met, incoming, wavelengths_nm) {}

  /// What a path within `inside` is in when it has been let through.
  [[nodiscard]] MediumStack behind(const Scene& scene, const MediumStack& inside) const {
    if (beyond != nullptr) return *beyond;
    MediumStack crossed = inside;
    crossed.cross(scene, hit.shape, wo.z > 0);
    return crossed;
  }

  /// The normal on the side that light may come from to be scattered; nothing where that is both sides, or
  /// may be: which parts a mixture has is not asked.
  [[nodiscard]] std::optional<Imath::V3f> lit_side() const {
    if (std::holds_alternative<RoughDielectricBsdf>(bsdf) || std::holds_alternative<MixtureBsdf>(bsdf))
      return std::nullopt;
    return wo.z > 0 ? hit.normal : -hit.normal;
  }

  /// The model's event, corrected on a relief. In line, as a call would cost every path.
  [[nodiscard, gnu::always_inline]] std::optional<BsdfSample> scatter(const BsdfRandom& u,
                                                                      TransportMode mode) const {
    std::optional<BsdfSample> event = sample(bsdf, wo, u, kHero, mode);
    if (relief && event)
      event->weight *= shading_normal_correction(frame.to_world(event->wi), event->wi, mode);
    return event;
  }
  /// Likewise of f towards a direction, in the world and local.
  [[nodiscard]] SampledSpectrum towards(const Imath::V3f& world, const Imath::V3f& local,
                                        TransportMode mode) const {
    SampledSpectrum f = eval(bsdf, wo, local, mode);
    if (relief) f *= shading_normal_correction(world, local, mode);
    return f;
  }

 private:
  // On a relief, what scattering towards a direction is worth against what the model says. It is 0 for
  // directions that the model and the shape see on different sides, so that no light leaks through. Power,
  // unlike radiance, takes |wo.z cos_i|/|cos_o wi.z|, the cosines being those with the normal of the shape
  // and z those with the model's: then both mean the same light. [Veach1997, sec. 5.3]
  [[nodiscard]] float shading_normal_correction(const Imath::V3f& world, const Imath::V3f& local,
                                                TransportMode mode) const {
    const float cos_world = world.dot(hit.normal);
    if (!(cos_world * local.z > 0)) return 0;
    return mode == TransportMode::radiance ? 1 : std::abs(wo.z * cos_world / (cos_outside * local.z));
  }

  Vertex(const Scene& scene, const SurfaceHit& surface, const Interface* met, const Imath::V3f& incoming,
         const SampledSpectrum& wavelengths_nm)
      : hit(surface),
        frame(surface.normal),
        wo(frame.to_local(-incoming)),
        beyond(met != nullptr ? &met->beyond : nullptr),
        bsdf(scene.needs.textures ? placed(scene, met, incoming, wavelengths_nm)
                                  : scattering(scene, met, wavelengths_nm, {0, 0})) {}

  [[nodiscard]] Bsdf scattering(const Scene& scene, const Interface* met,
                                const SampledSpectrum& wavelengths_nm, const Imath::V2f& uv) const {
    if (met != nullptr && met->passes) return DielectricBsdf{SampledSpectrum(1), false};
    return make_bsdf(scene.materials[scene.shapes[hit.shape].material],
                     {wavelengths_nm, uv, met != nullptr ? met->outside : nullptr});
  }

  // The same where the material may need more than a normal: turns what has been made so far. Out of line, as
  // a scene without textures pays for a longer loop.
  [[nodiscard, gnu::noinline]] Bsdf placed(const Scene& scene, const Interface* met,
                                           const Imath::V3f& incoming,
                                           const SampledSpectrum& wavelengths_nm) {
    if (met != nullptr && met->passes) return scattering(scene, met, wavelengths_nm, {0, 0});
    const SurfacePlace place = textured_place(scene, hit);
    frame = place.frame;
    wo = frame.to_local(-incoming);
    relief = place.relief;
    cos_outside = -incoming.dot(hit.normal);
    // Seen from the side that faces away, a relief is black.
    if (relief && !(cos_outside * wo.z > 0)) return DiffuseBsdf{};
    return scattering(scene, met, wavelengths_nm, place.uv);
  }
};

}  // namespace abbe
