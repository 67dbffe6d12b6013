#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "io/inputs.h"
#include "io/json.h"
#include "scene/camera/meter.h"
#include "scene/scene.h"

namespace abbe::spec {
struct Scene;
}  // namespace abbe::spec

namespace abbe {

/// Reads, checks and builds a scene. Reports every error; returns nothing if there is one.
/// If `path` is `kStandardStream` the text comes from standard input, and files it names are relative to the
/// working directory. `inputs` records every file that the scene and its meshes name, and the memory of
/// images, grids and meshes. Throws Error{resource} if that memory exceeds its limit. `spec`, if given,
/// receives the parsed description.
[[nodiscard]] std::optional<Scene> load_scene(const std::filesystem::path& path,
                                              std::span<const Override> overrides, Diagnostics& diagnostics,
                                              Inputs* inputs = nullptr, spec::Scene* spec = nullptr);

/// Builds a scene from a text, as above; files that it names are relative to `folder`.
[[nodiscard]] std::optional<Scene> load_scene(const std::shared_ptr<const SourceText>& source,
                                              const std::filesystem::path& folder,
                                              std::span<const Override> overrides, Diagnostics& diagnostics,
                                              Inputs* inputs = nullptr, spec::Scene* spec = nullptr);

/// A scene file that has been read for its meters.
struct MeteredScene {
  std::shared_ptr<const spec::Scene> scene_spec;
  std::vector<Meter> meters;     ///< The meters in the order of the file; at least one.
  std::filesystem::path folder;  ///< Files that the scene names are relative to this folder.
};
/// Reads a scene for its meters, with the diagnostics of `load_scene`. It needs no camera. A scene without
/// meters is an error.
[[nodiscard]] std::optional<MeteredScene> load_meters(const std::filesystem::path& path,
                                                      std::span<const Override> overrides,
                                                      Diagnostics& diagnostics, Inputs* inputs = nullptr);
/// Reads a text for its meters, as above; files that it names are relative to `folder`.
[[nodiscard]] std::optional<MeteredScene> load_meters(const std::shared_ptr<const SourceText>& source,
                                                      const std::filesystem::path& folder,
                                                      std::span<const Override> overrides,
                                                      Diagnostics& diagnostics, Inputs* inputs = nullptr);
/// Builds the scene for one meter, which replaces the camera and gives the channels. Reports errors as
/// `load_scene` does.
[[nodiscard]] std::optional<Scene> scene_of(const MeteredScene& scene, const Meter& meter,
                                            Diagnostics& diagnostics, Inputs* inputs = nullptr);

}  // namespace abbe
