#include "importers/gltf/document.h"

#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/meshes/gltf_json.h"
#include "description/meshes/mesh_formats.h"
#include "io/json_values.h"

namespace abbe::importers::gltf {

bool read_document(Document& document) {
  SceneImporter& importer = document.importer;
  const auto whole = std::make_shared<const SourceText>(SourceText{document.file.string(), ""});
  const SourcePosition where{whole, SourcePosition::kWholeFile, ""};
  std::string bytes;
  MemoryReservation reservation(importer.inputs, 0);
  if (const auto fault = read_mesh_bytes(document.file, bytes, reservation)) {
    importer.diagnostics.error(where, *fault, ErrorCode::input);
    return false;
  }
  if (importer.inputs != nullptr) importer.inputs->add_file(document.file);
  const auto json = gltf_json(bytes);
  if (!json) {
    importer.diagnostics.error(where, kBadGlb, ErrorCode::input);
    return false;
  }
  auto root =
      parse_json(std::make_shared<const SourceText>(SourceText{document.file.string(), std::string(*json)}),
                 importer.diagnostics, &document.memory);
  if (!root) return false;
  document.root = *std::move(root);
  return true;
}

const JsonValue* find(const JsonValue* object, std::string_view path) {
  while (object != nullptr && !path.empty()) {
    const std::size_t slash = path.find('/');
    object = object->find(path.substr(0, slash));
    path = slash == std::string_view::npos ? std::string_view() : path.substr(slash + 1);
  }
  return object;
}

const JsonValue::Array& list(const JsonValue* object, std::string_view path) {
  static const JsonValue::Array kEmpty;
  const JsonValue* found = find(object, path);
  const auto* array = found ? std::get_if<JsonValue::Array>(&found->value) : nullptr;
  return array ? *array : kEmpty;
}

const JsonValue* element(const Document& document, std::string_view name, const JsonValue* index) {
  if (index == nullptr) return nullptr;
  const JsonValue::Array& all = list(&document.root, name);
  const auto* number = std::get_if<double>(&index->value);
  if (number && *number >= 0 && *number < static_cast<double>(all.size()))
    return &all[static_cast<std::size_t>(*number)];
  document.importer.diagnostics.error(index->where,
                                      fmt::format("\"{}\" has no element with this index", name));
  return nullptr;
}

double number(const JsonValue* object, std::string_view path, double fallback, const Document& document) {
  const JsonValue* found = find(object, path);
  if (found == nullptr) return fallback;
  return read_number(*found, Range::any(), document.importer.diagnostics).value_or(fallback);
}

std::string text(const JsonValue* object, std::string_view path, const std::string& fallback) {
  const JsonValue* found = find(object, path);
  const auto* string = found ? std::get_if<std::string>(&found->value) : nullptr;
  return string ? *string : fallback;
}

std::optional<std::vector<double>> numbers(const JsonValue* object, std::string_view path, std::size_t count,
                                           const Document& document) {
  const JsonValue* found = find(object, path);
  if (found == nullptr) return std::nullopt;
  return read_numbers(*found, count, Range::any(), document.importer.diagnostics);
}

LinearRgb colour(const JsonValue* object, std::string_view path, const LinearRgb& fallback,
                 const Document& document) {
  const JsonValue* found = find(object, path);
  if (found == nullptr) return fallback;
  const auto values = read_numbers(*found, 0, Range::unit(), document.importer.diagnostics);
  if (!values) return fallback;
  if (values->size() == 3 || values->size() == 4) return {(*values)[0], (*values)[1], (*values)[2]};
  document.importer.diagnostics.error(
      found->where, fmt::format("a colour has three or four numbers (got {})", values->size()));
  return fallback;
}

}  // namespace abbe::importers::gltf
