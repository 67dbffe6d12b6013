#pragma once

#include <cstdint>
#include <optional>

#include "io/schema/fields.h"
#include "scene/scene.h"

namespace abbe::spec {

/// How to render.
struct Render {
  Integrator integrator = Integrator::automatic;
  int samples = 64;
  std::optional<int> max_depth;
  schema::Located<int> roulette_depth{{4}, {}};
  std::uint64_t seed = 0;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Render>);

}  // namespace abbe::spec

namespace abbe::description {

/// Reports paths that nothing ends.
[[nodiscard]] RenderSettings build(const spec::Render& render, Diagnostics& diagnostics);

}  // namespace abbe::description
