#pragma once

#include <cstdint>
#include <optional>

#include "io/schema/fields.h"
#include "scene/scene.h"

namespace abbe::spec {

/// How to gather photons.
struct Photons {
  std::optional<std::uint64_t> per_sample;
  std::optional<double> radius;
  int nearest = 50;
  bool final_gather = false;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Photons>);

/// Whether paths carry polarisation: where it matters, or never.
enum class Polarising { automatic, off };

/// How to render.
struct Render {
  Integrator integrator = Integrator::automatic;
  int samples = 64;
  std::optional<int> max_depth;
  schema::Located<int> roulette_depth{{4}, {}};
  std::uint64_t seed = 0;
  std::optional<Photons> photons;
  schema::Located<bool> consistent;
  Polarising polarisation = Polarising::automatic;
  schema::Located<DirectionSampling> directions;
  schema::Located<LightStrategy> lights;
  schema::Located<MisHeuristic> heuristic;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Render>);

}  // namespace abbe::spec

namespace abbe::description {

/// Reports paths that nothing ends, how `path` is to draw paths where it is not the integrator, and what
/// `auto` may choose where it is not. Lengths are in units of `unit_m`.
[[nodiscard]] RenderSettings build(const spec::Render& render, double unit_m, Diagnostics& diagnostics);

}  // namespace abbe::description
