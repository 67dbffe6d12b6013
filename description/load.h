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

/// Reads, checks and builds a scene, from standard input where the path is `kStandardStream`; the files it
/// names are then looked for in the current folder. Everything wrong with it is reported; nothing is returned
/// if there is an error. `inputs` learns of every file that scene and meshes name, and counts the memory of
/// images, grids and meshes: throws Error{resource} for one that is too large. `said` is given what the file
/// says.
[[nodiscard]] std::optional<Scene> load_scene(const std::filesystem::path& path,
                                              std::span<const Override> overrides, Diagnostics& diagnostics,
                                              Inputs* inputs = nullptr, spec::Scene* said = nullptr);

/// The same of a text; the files it names are looked for in `folder`.
[[nodiscard]] std::optional<Scene> load_scene(const std::shared_ptr<const SourceText>& source,
                                              const std::filesystem::path& folder,
                                              std::span<const Override> overrides, Diagnostics& diagnostics,
                                              Inputs* inputs = nullptr, spec::Scene* said = nullptr);

/// A scene that has been read for its meters.
struct MeteredScene {
  std::shared_ptr<const spec::Scene> said;
  std::vector<Meter> meters;     ///< In their order; at least one.
  std::filesystem::path folder;  ///< Where the files it names are looked for.
};
/// Reads a scene for its meters, as `load_scene` does; it needs no camera. One without meters is an error.
[[nodiscard]] std::optional<MeteredScene> load_meters(const std::filesystem::path& path,
                                                      std::span<const Override> overrides,
                                                      Diagnostics& diagnostics, Inputs* inputs = nullptr);
/// The same of a text; the files it names are looked for in `folder`.
[[nodiscard]] std::optional<MeteredScene> load_meters(const std::shared_ptr<const SourceText>& source,
                                                      const std::filesystem::path& folder,
                                                      std::span<const Override> overrides,
                                                      Diagnostics& diagnostics, Inputs* inputs = nullptr);
/// Builds the scene as that meter sees it, with its camera and channels. Reports as `load_scene` does.
[[nodiscard]] std::optional<Scene> scene_of(const MeteredScene& scene, const Meter& meter,
                                            Diagnostics& diagnostics, Inputs* inputs = nullptr);

}  // namespace abbe
