#pragma once

#include <optional>

#include "importers/pbrt/spectra.h"

namespace abbe::importers::pbrt {

/// The rendering options before WorldBegin. A directive that the file does not have is absent.
struct SceneOptions {
  std::optional<Directive> camera{};
  Imath::M44d camera_to_world{};  ///< Matrix for row vectors; x right, y up, z forward.
  std::string camera_medium{};    ///< Name of the medium around the camera; empty if none.
  std::optional<Directive> film{};
  std::optional<Directive> sampler{};
  std::optional<Directive> integrator{};
  std::optional<Directive> filter{};
};

/// Sets camera, sensor, render settings and output of `state.importer.scene`, with pbrt's defaults for absent
/// directives, and `state.world_mirror`. `end` is the position for notes about absent directives. Reports
/// unknown types of cameras and integrators, a film without pixels and a shutter that does not open.
void apply_options(const SceneOptions& options, const SourcePosition& end, ImportState& state);

}  // namespace abbe::importers::pbrt
