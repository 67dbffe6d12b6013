#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "importers/shared/scene_importer.h"
#include "importers/shared/spectra.h"
#include "io/json.h"

namespace abbe::importers::gltf {

/// A glTF file and the importer that receives its scene.
struct Document {
  SceneImporter& importer;
  std::filesystem::path file;                    ///< A .gltf or .glb file.
  JsonValue root{};                              ///< Parsed JSON, once `read_document` has succeeded.
  MemoryReservation memory{importer.inputs, 0};  ///< Memory of `root`.
};

/// Reads the JSON of `document.file` into `document.root`. Source positions in a .glb refer to its JSON
/// chunk. Reports a missing or unreadable file, a malformed GLB and malformed JSON, and returns false.
[[nodiscard]] bool read_document(Document& document);

/// The value at a path of keys separated by "/", such as "pbrMetallicRoughness/baseColorFactor". Returns
/// nullptr, without an error, if there is none or `object` is nullptr.
[[nodiscard]] const JsonValue* find(const JsonValue* object, std::string_view path);
/// The element number `index`, counted from 0, of the array at the path `list` of the file's root. Returns
/// nullptr, without an error, if `index` is nullptr. Reports an index that is not a number or is out of
/// range, and returns nullptr.
[[nodiscard]] const JsonValue* element(const Document& document, std::string_view list,
                                       const JsonValue* index);
/// The array at a path of `object`; empty, without an error, if there is none.
[[nodiscard]] const JsonValue::Array& list(const JsonValue* object, std::string_view path);

/// The number at a path; `fallback` if absent. Reports a value that is not a number, and returns `fallback`.
[[nodiscard]] double number(const JsonValue* object, std::string_view path, double fallback,
                            const Document& document);
/// The text at a path; `fallback`, without an error, if it is absent or not a text.
[[nodiscard]] std::string text(const JsonValue* object, std::string_view path, const std::string& fallback);
/// The array of `count` numbers at a path; nothing if absent. Reports a value that is not an array of
/// numbers, or has another length, and returns nothing.
[[nodiscard]] std::optional<std::vector<double>> numbers(const JsonValue* object, std::string_view path,
                                                         std::size_t count, const Document& document);
/// The colour at a path, of three numbers in [0, 1]; a fourth is ignored. `fallback` if absent. Reports any
/// other value and returns `fallback`.
[[nodiscard]] LinearRgb colour(const JsonValue* object, std::string_view path, const LinearRgb& fallback,
                               const Document& document);

/// Distinct names of the file's materials, in its order, as the mesh reader gives them. The last name is that
/// of primitives without a material.
[[nodiscard]] std::vector<std::string> material_names(const Document& document);

/// Converts a material; nullptr is the default material of the format. The result is one of:
/// - a principled surface for metallic-roughness;
/// - a dielectric if it transmits and has a volume with a thickness above 0;
/// - thin glass if it transmits without such a volume.
/// `where` is the position for notes. Notes what Abbe cannot represent. Reports values of wrong types and
/// image files that are missing; the result then has defaults in their place.
[[nodiscard]] spec::Material material_of(const JsonValue* material, const SourcePosition& where,
                                         const Document& document);

/// The emission of a material: `emissiveFactor` times D65, with `emissiveStrength` as the luminance [cd/m2]
/// of white. Nothing if the factor is 0 or `material` is nullptr.
[[nodiscard]] std::optional<spec::Emission> emission_of(const JsonValue* material, const Document& document);

}  // namespace abbe::importers::gltf
