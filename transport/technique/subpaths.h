#pragma once

#include "transport/path/film_response.h"
#include "transport/path/path_recorder.h"
#include "transport/path/strategies.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Sets a path out from the camera through pixel (x, y) at that time, with its packet and by its own numbers.
/// Returns where it exposes the film; behind a lens that displaces lanes, `images` keeps that of each of
/// them.
FilmPoint start_from_camera(const Plan& plan, int x, int y, float time, RecordedPath& path,
                            LaneImages& images);

/// Sets a path out from one of the plan's traced lights at that time, with its packet and by its own numbers,
/// as the light emits by itself. Light from infinity comes in through the disc that the scene fills, seen
/// from there. Where it gets nowhere the path has no vertex.
void start_from_light(const Plan& plan, RayCaster& caster, float time, RecordedPath& path);

/// A point of a light, chosen for a vertex by the four numbers `u`, to connect it to; nothing where none of
/// its light arrives.
[[nodiscard]] std::optional<PathVertex> light_for(const Plan& plan, const PathVertex& vertex,
                                                  const std::array<float, 4>& u);

/// What the functions above draw the ends of a path by whose last vertex is `light` and the one before `lit`.
/// Of the camera nothing is told.
[[nodiscard]] EndDensities end_densities(const Plan& plan, const PathVertex& lit, const PathVertex& light);

}  // namespace abbe
