#pragma once

#include "transport/path/film_response.h"
#include "transport/path/path_recorder.h"
#include "transport/path/strategies.h"
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

}  // namespace abbe
