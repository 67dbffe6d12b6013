#pragma once

#include <cstdint>
#include <optional>

#include "io/schema/fields.h"
#include "scene/scene.h"

namespace abbe::spec {

/// Settings of photon tracing and gathering.
struct Photons {
  std::optional<std::uint64_t> per_sample;
  std::optional<double> radius;
  int nearest = 50;
  bool final_gather = false;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Photons>);

/// Mode in which paths carry polarisation: where it matters, or never.
enum class PolarisationMode { automatic, off };

/// Settings of a render.
struct Render {
  Integrator integrator = Integrator::automatic;
  int samples = 64;
  std::optional<int> max_depth;
  schema::Located<int> roulette_depth{{4}, {}};
  std::uint64_t seed = 0;
  std::optional<Photons> photons;
  schema::Located<bool> consistent;
  PolarisationMode polarisation = PolarisationMode::automatic;
  schema::Located<DirectionSampling> directions;
  schema::Located<LightStrategy> lights;
  schema::Located<MisHeuristic> heuristic;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Render>);

}  // namespace abbe::spec

namespace abbe::description {

/// Builds the settings of a render; lengths are in scene units of `unit_m` metres. Reports:
/// - Russian roulette that never ends a path, without `max_depth`;
/// - path sampling options with another integrator than `path`;
/// - `consistent` with another integrator than `auto`.
[[nodiscard]] RenderSettings build(const spec::Render& render, double unit_m, Diagnostics& diagnostics);

}  // namespace abbe::description
