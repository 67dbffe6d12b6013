#pragma once

#include <optional>

#include "description/importers/pbrt/import_state.h"

namespace abbe::importers::pbrt {

/// The rendering options before WorldBegin.
struct SceneOptions {
  std::optional<Directive> camera{};
  Imath::M44d camera_to_world{};
  std::string camera_medium{};
  std::optional<Directive> film{};
  std::optional<Directive> sampler{};
  std::optional<Directive> integrator{};
  std::optional<Directive> filter{};
};

/// Sets the scene's camera, sensor, render settings and output, with pbrt's defaults for absent directives,
/// and the state's `world_mirror`. `end` is the position for notes about absent directives.
void apply_options(const SceneOptions& options, const SourcePosition& end, ImportState& state);

}  // namespace abbe::importers::pbrt
