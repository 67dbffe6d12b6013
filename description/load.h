#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "io/inputs.h"
#include "io/json.h"
#include "materials/material.h"
#include "scene/camera/meter.h"
#include "scene/scene.h"

namespace abbe::spec {
struct Scene;
}  // namespace abbe::spec

namespace abbe {

/// Reads, checks and builds a scene, and commits it, so that it can be rendered. Reports every error to
/// `diagnostics`; returns nothing if they then have one, also an earlier one. Files that the scene names are
/// relative to its folder, or to the working directory if `path` is `kStandardStream` for standard input.
/// `overrides` are applied to the JSON in order, before it is checked.
/// `inputs`, if given, records every file that the scene and its meshes name, and the memory of images, grids
/// and meshes. `spec`, if given, receives the parsed description, as far as it was read.
/// Throws Error{resource} if the memory limit is exceeded, and Error{input} for an unreadable environment
/// image.
[[nodiscard]] std::optional<Scene> load_scene(const std::filesystem::path& path,
                                              std::span<const Override> overrides, Diagnostics& diagnostics,
                                              Inputs* inputs = nullptr, spec::Scene* spec = nullptr);

/// Builds a scene from the text `source`. Files that it names are relative to `folder`; if that is empty, to
/// the working directory.
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
/// Reads a scene file for its meters, with the parameters of `load_scene`. It needs no camera. Only the
/// description and the meters are checked; `scene_of` checks the rest. Reports errors, also a scene without
/// meters, and returns nothing after one. Throws Error{resource} if the memory limit of `inputs` is exceeded.
[[nodiscard]] std::optional<MeteredScene> load_meters(const std::filesystem::path& path,
                                                      std::span<const Override> overrides,
                                                      Diagnostics& diagnostics, Inputs* inputs = nullptr);
/// Reads the text `source` for its meters. Files that it names are relative to `folder`.
[[nodiscard]] std::optional<MeteredScene> load_meters(const std::shared_ptr<const SourceText>& source,
                                                      const std::filesystem::path& folder,
                                                      std::span<const Override> overrides,
                                                      Diagnostics& diagnostics, Inputs* inputs = nullptr);
/// Builds and commits the scene for one of `scene.meters`, which replaces the camera and gives the channels.
/// Its hash `sha256` stays empty. Reports errors, returns nothing after one and throws as `load_scene` does.
[[nodiscard]] std::optional<Scene> scene_of(const MeteredScene& scene, const Meter& meter,
                                            Diagnostics& diagnostics, Inputs* inputs = nullptr);

/// The text of a scene file in canonical form: keys in the order of the key tables, no comments, no default
/// values. It describes the same scene with `overrides` applied; the keys of a sensor model are written out.
/// The file is not changed. Reports the same diagnostics and throws the same errors as `load_scene`; returns
/// nothing after an error. `inputs`, if given, records the files that are read.
[[nodiscard]] std::optional<std::string> canonical_scene(const std::filesystem::path& path,
                                                         std::span<const Override> overrides,
                                                         Diagnostics& diagnostics, Inputs* inputs = nullptr);

/// Line width of the JSON that Abbe writes for readers [characters].
inline constexpr std::size_t kJsonWidth = 140;

/// The text of `docs/reference/scene.schema.json`: the JSON Schema of scene files, generated from the key
/// tables.
[[nodiscard]] std::string scene_schema();

/// The text of `docs/reference/scene.md` with its key tables regenerated from those of the program. `guide`
/// is its current text, from which everything else is taken. Throws Error{internal} if it names an unknown
/// table or a table has no end.
[[nodiscard]] std::string scene_guide(const std::string& guide);

/// Reads and builds one material, which `words` gives as one of:
/// - JSON text that begins with "{";
/// - the name of a file with such text;
/// - "FILE.json:NAME", one of the `materials` of a scene; ":NAME" may be omitted if there is only one.
/// Lengths are in the `units` of the text, or metres without that key. All materials of a scene are built.
/// Reports every error to `diagnostics`; returns nothing if they then have one. `inputs`, if given, records
/// the files that are read. Throws Error{resource} if its memory limit is exceeded.
[[nodiscard]] std::optional<Material> load_material(const std::string& words, Diagnostics& diagnostics,
                                                    Inputs* inputs = nullptr);

}  // namespace abbe
