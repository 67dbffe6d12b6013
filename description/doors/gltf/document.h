#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "description/doors/shared/door.h"
#include "description/doors/shared/spectra.h"
#include "io/json.h"

namespace abbe::doors::gltf {

/// A glTF file, and where its scene goes.
struct Document {
  Door& door;
  std::filesystem::path file;
  JsonValue root{};
  HeldMemory memory{door.inputs, 0};  ///< Of the root.
};

/// Reads the JSON of a .gltf or .glb file; places in the latter are those in its JSON. False, after an error,
/// for what is none.
[[nodiscard]] bool read_document(Document& document);

/// The member at a path of keys, as "pbrMetallicRoughness/baseColorFactor"; nullptr without it, or of
/// nullptr.
[[nodiscard]] const JsonValue* find(const JsonValue* object, std::string_view path);
/// The element of one of the file's lists that `index` names; one that does not exist is reported. nullptr
/// then, or without an index.
[[nodiscard]] const JsonValue* element(const Document& document, std::string_view list,
                                       const JsonValue* index);
/// The list at a path, empty without it.
[[nodiscard]] const JsonValue::Array& list(const JsonValue* object, std::string_view path);

// Values at paths, or what holds in their absence; those of other kinds are reported.
[[nodiscard]] double number(const JsonValue* object, std::string_view path, double absent,
                            const Document& document);
[[nodiscard]] std::string text(const JsonValue* object, std::string_view path, const std::string& absent);
[[nodiscard]] std::optional<std::vector<double>> numbers(const JsonValue* object, std::string_view path,
                                                         std::size_t count, const Document& document);
[[nodiscard]] LinearRgb colour(const JsonValue* object, std::string_view path, const LinearRgb& absent,
                               const Document& document);

}  // namespace abbe::doors::gltf
