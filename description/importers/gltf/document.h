#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "description/importers/shared/scene_importer.h"
#include "description/importers/shared/spectra.h"
#include "io/json.h"

namespace abbe::importers::gltf {

/// A glTF file and the importer that receives its scene.
struct Document {
  SceneImporter& importer;
  std::filesystem::path file;
  JsonValue root{};
  MemoryReservation memory{importer.inputs, 0};  ///< Memory of `root`.
};

/// Reads the JSON of a .gltf or .glb file. Source positions in a .glb refer to its JSON chunk. Reports errors
/// and returns false.
[[nodiscard]] bool read_document(Document& document);

/// The value at a path of keys such as "pbrMetallicRoughness/baseColorFactor"; nullptr if there is none or
/// `object` is nullptr.
[[nodiscard]] const JsonValue* find(const JsonValue* object, std::string_view path);
/// The element `index` of the file's top-level array `list`. Returns nullptr without an index, and after
/// reporting an index that is out of range.
[[nodiscard]] const JsonValue* element(const Document& document, std::string_view list,
                                       const JsonValue* index);
/// The array at a path; empty if there is none.
[[nodiscard]] const JsonValue::Array& list(const JsonValue* object, std::string_view path);

// Values at paths, or `fallback` if absent. Values of wrong types are reported.
[[nodiscard]] double number(const JsonValue* object, std::string_view path, double fallback,
                            const Document& document);
[[nodiscard]] std::string text(const JsonValue* object, std::string_view path, const std::string& fallback);
[[nodiscard]] std::optional<std::vector<double>> numbers(const JsonValue* object, std::string_view path,
                                                         std::size_t count, const Document& document);
[[nodiscard]] LinearRgb colour(const JsonValue* object, std::string_view path, const LinearRgb& fallback,
                               const Document& document);

}  // namespace abbe::importers::gltf
