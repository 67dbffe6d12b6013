#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "materials/bsdf.h"
#include "materials/material.h"
#include "scene/scene.h"
#include "transport/path/media.h"
#include "transport/path/path_state.h"

namespace abbe {

// Nested media: a surface is an interface only if the medium changes there. At a point within several shapes
// the medium is that of the shape with the highest priority [Schmidt2002]; among equals, of the smallest. A
// medium without an interface has the index of the medium around it and does not refract. Coincident surfaces
// are crossed together, from the medium before all of them to the medium behind all of them.

/// Crossing of a shape's surface, into the shape or out of it.
struct CrossedSurface {
  std::uint32_t shape;  ///< Index into `Scene::shapes`.
  bool entering;        ///< True if the ray arrives against the shape's outward normal.
};

/// The one of several coincident surfaces that acts on a ray, and the media there.
struct ActingSurface {
  /// Position of the acting surface in the list of crossed surfaces; none if the ray continues straight.
  std::optional<std::size_t> acting;
  /// Refractive index of the medium on the side of the acting surface that is not in its own shape; for
  /// opaque surfaces and sheets, of the medium from which the ray arrives. nullptr is air.
  const RefractiveIndex* outside = nullptr;
  MediumStack media_behind = {};  ///< Media of a transmitted ray; those before an opaque surface.
};

/// Decides which of `surfaces`, which coincide and number at most `CoincidentHits::kMaxHits`, acts on a ray
/// in `media`. The first rule that applies decides:
/// - The first opaque surface of the list acts.
/// - If the index changes, the surface of higher priority of the two that bound the media before and behind
///   acts. Among equals this is the later one of the scene.
/// - If the index does not change, the first sheet of the list acts: a surface that encloses no medium.
///
/// A shape that is left without having been entered counts as entered before. Throws Error{resource} if more
/// than `MediumStack::kMaxShapes` media nest.
[[nodiscard]] ActingSurface acting_surface(const Scene& scene, std::span<const CrossedSurface> surfaces,
                                           const MediumStack& media);

/// Interface at which a path interacts with coincident surfaces.
struct Interface {
  SurfaceHit hit;                  ///< Hit on the acting surface, or on the first one if `passes`.
  bool passes;                     ///< True if no surface acts, so that the path continues straight.
  const RefractiveIndex* outside;  ///< See `ActingSurface::outside`.
  MediumStack media_behind;        ///< See `ActingSurface::media_behind`.
};
/// Interface of a path whose ray hits the scene first at `first`, in `media`. The coincidence radius of its
/// hit encloses all coincident surfaces. Throws as `acting_surface`.
[[nodiscard]] Interface interface_at(const Scene& scene, const Ray& ray, const SurfaceHit& first,
                                     const MediumStack& media);

/// Surface vertex of a path, with its BSDF.
struct SurfaceVertex {
  SurfaceHit hit;
  Basis<float> frame;     ///< Local frame of the BSDF; z is the shading normal.
  Imath::V3f wo;          ///< Local unit direction back towards the previous vertex.
  bool relief = false;    ///< True if a bump or normal map turns the frame away from the shape's normal.
  float cos_outside = 1;  ///< Cosine between wo and the shape's normal; set on a relief.
  /// Media of a transmitted path; set in scenes with nested media.
  std::optional<MediumStack> nested_media_behind = {};
  Bsdf bsdf;  ///< BSDF at the path's wavelengths.

  /// Vertex at a probe with the unit normal `normal`: white, diffuse, and viewed along its normal, so that
  /// its outgoing radiance is the irradiance over pi.
  static SurfaceVertex at_probe(const Imath::V3f& point, const Imath::V3f& normal) {
    return {{point, normal, 0, 0}, Basis<float>(normal), {0, 0, 1}, DiffuseBsdf{SampledSpectrum(1.0F)}};
  }

  SurfaceVertex(const SurfaceHit& surface, const Basis<float>& axes, const Imath::V3f& outgoing,
                Bsdf scattering)
      : hit(surface), frame(axes), wo(outgoing), bsdf(std::move(scattering)) {}
  /// Vertex at which a path hits the scene, with the path's ray still the one that hits it. `interface` is
  /// set in scenes with nested media. If no medium changes there, the path continues straight, as between
  /// equal indices.
  SurfaceVertex(const Scene& scene, const SurfaceHit& surface, const std::optional<Interface>& interface,
                const PathState& path)
      : hit(surface),
        frame(surface.normal),
        wo(frame.to_local(-path.ray.direction)),
        bsdf(scene.features.textures ? textured_scattering(scene, interface, path)
                                     : scattering(scene, interface, path, {0, 0})) {
    if (interface) nested_media_behind = interface->media_behind;
  }

  /// Media of a path that arrives in `media` and is transmitted. Throws as `MediumStack::cross`.
  [[nodiscard]] MediumStack media_behind(const Scene& scene, const MediumStack& media) const {
    if (nested_media_behind) return *nested_media_behind;
    MediumStack crossed = media;
    crossed.cross(scene, hit.shape, wo.z > 0);
    return crossed;
  }

  /// Context for light sampling: position, and the shading normal on the path's side unless the model
  /// scatters to both sides. Glossy if all lobes are glossy; mixtures count as not glossy.
  [[nodiscard]] LightSampleContext light_context() const {
    const bool both = scatters_to_both_sides(bsdf);
    return {hit.point, both ? std::nullopt : std::optional(wo.z > 0 ? frame.z : -frame.z), glossy(bsdf)};
  }

  /// Infinite ray that leaves in the unit world direction `w` at the time `time`, a fraction of the exposure.
  /// Its origin is offset from the surface.
  [[nodiscard]] Ray spawn_ray(const Imath::V3f& w, float time) const {
    return spawn(hit, frame.to_world(wo), w, time);
  }

  /// Samples an event of the BSDF with the hero wavelength, with the shading-normal correction; nothing if no
  /// light is scattered. Inlined, because a call would slow down every path.
  [[nodiscard, gnu::always_inline]] std::optional<BsdfSample> scatter(const BsdfRandom& u, int hero,
                                                                      TransportMode mode) const {
    std::optional<BsdfSample> event = sample(bsdf, wo, u, hero, mode);
    if (relief && event)
      event->weight *= shading_normal_correction(frame.to_world(event->wi), event->wi, mode);
    return event;
  }
  /// Mueller matrix of the event between the path's direction of arrival and the local direction `wi`, with
  /// its axis in world space; see `mueller` of the BSDFs.
  [[nodiscard]] std::optional<MuellerMatrix> mueller(const Imath::V3f& wi, bool delta,
                                                     std::optional<int> lane = {}) const {
    std::optional<MuellerMatrix> matrix = abbe::mueller(bsdf, wo, wi, delta, lane);
    if (matrix) matrix->axis = frame.to_world(matrix->axis);
    return matrix;
  }
  /// Factor by which refraction divides radiance: the squared ratio of the index on the outgoing side to that
  /// on the incident side, at the hero's wavelength. 1 without refraction.
  [[nodiscard]] float squared_eta(const BsdfSample& event, int hero) const {
    if (!event.transmitted) return 1;
    const float n = index_inside(bsdf, hero);
    return wo.z > 0 ? n * n : 1 / (n * n);
  }
  /// BSDF f(wo, wi) [1/sr] with the shading-normal correction, without the cosine. `world` and `local` are
  /// the same unit direction wi in both spaces.
  [[nodiscard]] SampledSpectrum f(const Imath::V3f& world, const Imath::V3f& local,
                                  TransportMode mode) const {
    SampledSpectrum f = eval(bsdf, wo, local, mode);
    if (relief) f *= shading_normal_correction(world, local, mode);
    return f;
  }

  /// BSDF in an outgoing direction; 0 for a direction so close to the surface's plane that rounding decides
  /// its side.
  struct OutgoingDirection {
    Imath::V3f wi;      ///< Local direction.
    SampledSpectrum f;  ///< BSDF [1/sr]; the cosine |wi.z| is not included.
    bool crosses;       ///< True if the direction is on the other side than the path's arrival.
  };
  /// Evaluates the BSDF in the unit world direction `world`.
  [[nodiscard]] OutgoingDirection eval_towards(const Imath::V3f& world, TransportMode mode) const {
    constexpr float kGrazing = 4 * std::numeric_limits<float>::epsilon();
    const Imath::V3f wi = frame.to_local(world);
    const bool leaves = std::abs(wi.z) > kGrazing;
    return {wi, leaves ? f(world, wi, mode) : SampledSpectrum(0.0F), wi.z * wo.z < 0};
  }

 private:
  // Shading-normal correction on a relief. It is 0 for directions on different sides of the shading and
  // geometric surfaces, so that no light leaks. Power, unlike radiance, is multiplied by |wo.z cos_i|/|cos_o
  // wi.z|, the cosines being those with the shape's normal. Both quantities then describe the same light.
  // [Veach1997, sec. 5.3]
  [[nodiscard]] float shading_normal_correction(const Imath::V3f& world, const Imath::V3f& local,
                                                TransportMode mode) const {
    const float cos_world = world.dot(hit.normal);
    if (!(cos_world * local.z > 0)) return 0;
    return mode == TransportMode::radiance ? 1 : std::abs(wo.z * cos_world / (cos_outside * local.z));
  }

  [[nodiscard]] Bsdf scattering(const Scene& scene, const std::optional<Interface>& interface,
                                const PathState& path, const Imath::V2f& uv) const {
    if (interface && interface->passes) return DielectricBsdf{SampledSpectrum(1), false};
    return make_bsdf(scene.materials[scene.shapes[hit.shape].material],
                     {path.lambda_nm(), uv, interface ? interface->outside : nullptr});
  }

  // BSDF of a material with textures; sets frame, wo and relief. Not inlined, because scenes without textures
  // would pay for a longer loop.
  [[nodiscard, gnu::noinline]] Bsdf textured_scattering(const Scene& scene,
                                                        const std::optional<Interface>& interface,
                                                        const PathState& path) {
    if (interface && interface->passes) return scattering(scene, interface, path, {0, 0});
    const ShadingPoint textured = textured_shading_point(scene, hit, path.ray.time);
    frame = textured.frame;
    wo = frame.to_local(-path.ray.direction);
    relief = textured.relief;
    cos_outside = -path.ray.direction.dot(hit.normal);
    // A relief viewed from its back side is black.
    if (relief && !(cos_outside * wo.z > 0)) return DiffuseBsdf{};
    return scattering(scene, interface, path, textured.uv);
  }
};

/// Sampling of directions at a surface independently of its BSDF: by the cosine with the shading normal, or
/// uniformly. Both sides are sampled if the surface transmits. `DirectionSampling::bsdf` is not allowed. Let
/// q_k be the probability that wavelength k's event is delta, and p(wi) the pdf of DirectionSampling. The pdf
/// of a direction is
///     P_k(wi) = (1 - q_k) p(wi),
/// and the weight of an event is f |cos wi| / P_hero. Surfaces with delta distributions only are sampled by
/// their BSDF.

/// P_k(wi) [1/sr] per wavelength, for a local unit direction. 0 on the far side of a surface that does not
/// transmit.
[[nodiscard]] SampledSpectrum pdf_of_directions(DirectionSampling directions, const SurfaceVertex& vertex,
                                                const Imath::V3f& wi);

/// Samples an event with the hero wavelength: the BSDF's own if that is delta, otherwise one with the pdf
/// P_hero(wi). Returns nothing if the surface scatters no light there. `mode` is the quantity that the path
/// carries.
[[nodiscard]] std::optional<BsdfSample> sample_directions(DirectionSampling directions,
                                                          const SurfaceVertex& vertex, const BsdfRandom& u,
                                                          int hero, TransportMode mode);

}  // namespace abbe
