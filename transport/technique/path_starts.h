#pragma once

#include <cstdint>

#include "transport/path/film_response.h"
#include "transport/path/mis_weight.h"
#include "transport/path/path_recorder.h"
#include "transport/path/path_state.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Starts a camera subpath through pixel (x, y) at a time (fraction of the exposure), with its packet and
/// random numbers. Returns its film point. For lenses that disperse wavelengths, `images` receives the film
/// position of each, and the film point refers to it. The path has no vertex if the lens transmits nothing.
/// Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
FilmPoint start_from_camera(const Plan& plan, int x, int y, float time, RecordedPath& path,
                            WavelengthImages& images);

/// Starts a light subpath at one of the plan's traced lights at a time, with its packet and random numbers.
/// Directions follow the light's emission; light from infinity enters through the disc of the scene as the
/// light views it. The path has no vertex if no light is emitted. Throws Error{resource} if more than
/// `MediumStack::kMaxShapes` media nest.
void start_from_light(const Plan& plan, RayCaster& caster, float time, RecordedPath& path);

/// Samples a light vertex for next-event estimation at a vertex with four random numbers in [0, 1). Its
/// throughput is one over its pdf, in the measure of `PathVertex`. Occlusion is not tested. Returns nothing
/// if no light can be sampled there.
[[nodiscard]] std::optional<PathVertex> sample_light_vertex(const Plan& plan, const PathVertex& vertex,
                                                            const std::array<float, 4>& u);

/// Pdfs with which the functions above sample the ends of a path whose last vertex is `light`, a
/// `LightVertex`, and whose previous one is `illuminated`. Sets `light_start`, `light_connection` and
/// `emission` alone.
[[nodiscard]] EndDensities end_densities(const Plan& plan, const PathVertex& illuminated,
                                         const PathVertex& light);

/// Sets the media of a path at the start of its ray from the camera, at the ray's time. Ray and wavelengths
/// must be set. Throws as `enclosing_media`.
void enter_camera_media(const Plan& plan, PathState& path);
/// Medium stack of a point of the lens at a time, a fraction of the exposure. Throws as `enclosing_media`.
[[nodiscard]] MediumStack camera_media(const Plan& plan, const Imath::V3f& lens_point, float time);
/// Sets the media of a path at the start of its ray from the traced light of index `light`, at the ray's
/// time. Ray and wavelengths must be set. Throws as `enclosing_media`.
void enter_light_media(const Plan& plan, std::uint32_t light, PathState& path);

/// Start of a photon at its light.
struct PhotonStart {
  std::uint32_t light = 0;        ///< Index into `Scene::lights`.
  Imath::V3f from{0, 0, 0};       ///< Origin of its ray; for distant lights a point in front of the target.
  Imath::V3f direction{0, 0, 1};  ///< Unit direction of its ray.
  /// Branch of the photon's first contribution to the film: a hash of the specular events before the first
  /// other event, and of their shapes. `start_photon` leaves it 0; the training of photon guides sets it.
  std::uint32_t branch = 0;
};

/// Starts a photon at one of the plan's traced lights, with the random numbers of `photon.sampler`. Sets the
/// photon's ray, media and packet: wavelengths, throughput and polarisation. If the light emits nothing along
/// the ray, or a distant light is occluded there, only the throughput is set, to zero. `Plan::traced_lights`
/// must not be empty. Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
[[nodiscard]] PhotonStart start_photon(const Plan& plan, RayCaster& caster, PathState& photon);

}  // namespace abbe
