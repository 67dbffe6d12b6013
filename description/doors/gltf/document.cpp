#include "description/doors/gltf/document.h"

#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/meshes/gltf_json.h"
#include "description/meshes/mesh_formats.h"
#include "io/json_values.h"

namespace abbe::doors::gltf {

bool read_document(Document& document) {
  Door& door = document.door;
  const auto whole = std::make_shared<const SourceText>(SourceText{document.file.string(), ""});
  const SourcePosition where{whole, SourcePosition::kWholeFile, ""};
  std::string bytes;
  HeldMemory held(door.inputs, 0);
  if (const auto fault = read_mesh_bytes(document.file, bytes, held)) {
    door.diagnostics.error(where, *fault, ErrorCode::input);
    return false;
  }
  if (door.inputs != nullptr) door.inputs->add_file(document.file);
  const auto json = gltf_json(bytes);
  if (!json) {
    door.diagnostics.error(where, kBadGlb, ErrorCode::input);
    return false;
  }
  auto root =
      parse_json(std::make_shared<const SourceText>(SourceText{document.file.string(), std::string(*json)}),
                 door.diagnostics, &document.memory);
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
  static const JsonValue::Array kNothing;
  const JsonValue* found = find(object, path);
  const auto* array = found ? std::get_if<JsonValue::Array>(&found->value) : nullptr;
  return array ? *array : kNothing;
}

const JsonValue* element(const Document& document, std::string_view name, const JsonValue* index) {
  if (index == nullptr) return nullptr;
  const JsonValue::Array& all = list(&document.root, name);
  const auto* number = std::get_if<double>(&index->value);
  if (number && *number >= 0 && *number < static_cast<double>(all.size()))
    return &all[static_cast<std::size_t>(*number)];
  document.door.diagnostics.error(index->where,
                                  fmt::format("an element of \"{}\" that does not exist", name));
  return nullptr;
}

double number(const JsonValue* object, std::string_view path, double absent, const Document& document) {
  const JsonValue* found = find(object, path);
  if (found == nullptr) return absent;
  return read_number(*found, Range::any(), document.door.diagnostics).value_or(absent);
}

std::string text(const JsonValue* object, std::string_view path, const std::string& absent) {
  const JsonValue* found = find(object, path);
  const auto* said = found ? std::get_if<std::string>(&found->value) : nullptr;
  return said ? *said : absent;
}

std::optional<std::vector<double>> numbers(const JsonValue* object, std::string_view path, std::size_t count,
                                           const Document& document) {
  const JsonValue* found = find(object, path);
  if (found == nullptr) return std::nullopt;
  return read_numbers(*found, count, Range::any(), document.door.diagnostics);
}

LinearRgb colour(const JsonValue* object, std::string_view path, const LinearRgb& absent,
                 const Document& document) {
  const JsonValue* found = find(object, path);
  if (found == nullptr) return absent;
  const auto values = read_numbers(*found, 0, Range::unit(), document.door.diagnostics);
  if (!values) return absent;
  if (values->size() == 3 || values->size() == 4) return {(*values)[0], (*values)[1], (*values)[2]};
  document.door.diagnostics.error(found->where,
                                  fmt::format("a colour has three numbers (got {})", values->size()));
  return absent;
}

}  // namespace abbe::doors::gltf
