#include "scene/shapes/gltf_buffers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
// Component types of the format.
constexpr std::size_t kByte = 5121;
constexpr std::size_t kShort = 5123;
constexpr std::size_t kInt = 5125;
constexpr std::size_t kFloat = 5126;

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

// A GLB is a header of 12 bytes and chunks of a length, a type and that many bytes: JSON first, then perhaps
// a buffer.
bool split_glb(std::string_view bytes, std::string& json, std::optional<std::string>& buffer,
               MeshReading& reading) {
  constexpr std::size_t kHeader = 12;
  constexpr std::size_t kChunkHeader = 8;
  constexpr std::uint32_t kJson = 0x4E4F534A;
  constexpr std::uint32_t kBinary = 0x004E4942;
  if (bytes.size() < kHeader || word_at(bytes, 4) != 2 || word_at(bytes, 8) > bytes.size())
    return reading.refuse("malformed or truncated GLB");
  std::string_view rest = bytes.substr(kHeader, std::max<std::size_t>(word_at(bytes, 8), kHeader) - kHeader);
  for (std::size_t chunk = 0; !rest.empty(); ++chunk) {
    if (rest.size() < kChunkHeader || word_at(rest, 0) > rest.size() - kChunkHeader)
      return reading.refuse("malformed or truncated GLB");
    const std::string_view body = rest.substr(kChunkHeader, word_at(rest, 0));
    if (chunk == 0 && word_at(rest, 4) == kJson) json = body;
    if (chunk == 1 && word_at(rest, 4) == kBinary) buffer = std::string(body);
    rest.remove_prefix(kChunkHeader + body.size());
  }
  return true;
}

std::optional<std::string> decode_base64(std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) return std::nullopt;
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<char>(bits >> held & 0xFF));
  }
  return bytes;
}

// A URI's %20 and the like as the bytes they stand for.
std::string percent_decoded(const std::string& uri) {
  constexpr std::string_view kHex = "0123456789abcdef";
  const auto digit = [&](char c) { return kHex.find(static_cast<char>(c >= 'A' && c <= 'F' ? c + 32 : c)); };
  std::string plain;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool coded =
        uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) < 16 && digit(uri[i + 2]) < 16;
    plain.push_back(coded ? static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2])) : uri[i]);
    if (coded) i += 2;
  }
  return plain;
}

bool read_buffer(const JsonValue& json, std::optional<std::string>& own, Gltf& gltf, MeshReading& reading) {
  std::string& bytes = gltf.buffers.emplace_back();
  const std::string name = json.where.pointer;
  const JsonValue* uri_value = json.find("uri");
  const auto* uri = uri_value ? std::get_if<std::string>(&uri_value->value) : nullptr;
  if (uri == nullptr) {
    if (!own) return reading.refuse(name + " has no bytes");
    bytes = std::move(*own);
    own.reset();
  } else if (uri->starts_with("data:")) {
    constexpr std::string_view kMarker = ";base64,";
    const std::size_t at = uri->find(kMarker);
    auto decoded = at == std::string::npos
                       ? std::nullopt
                       : decode_base64(std::string_view(*uri).substr(at + kMarker.size()));
    if (!decoded) return reading.refuse(name + " is no base64");
    bytes = std::move(*decoded);
  } else if (!read_named_bytes(percent_decoded(*uri), bytes, reading)) {
    return false;
  }
  const std::size_t promised = natural(json, "byteLength").value_or(kNone);
  if (promised <= bytes.size()) return true;
  return reading.refuse(fmt::format("{} promises more bytes than there are (got {}, allowed {})", name,
                                    promised == kNone ? "no length" : std::to_string(promised),
                                    bytes.size()));
}

std::size_t width_of(std::size_t component_type) {
  switch (component_type) {
    case kByte:
      return 1;
    case kShort:
      return 2;
    case kInt:
    case kFloat:
      return 4;
    default:
      return 0;
  }
}

// The bytes of a view of a buffer, and its stride if it has one.
struct View {
  std::string_view bytes;
  std::size_t stride;
};
std::optional<View> view_of(const Gltf& gltf, const JsonValue& accessor) {
  const JsonValue* view = element(gltf, "bufferViews", natural(accessor, "bufferView"));
  if (!view) return std::nullopt;
  const auto buffer = natural(*view, "buffer");
  const std::size_t offset = natural(*view, "byteOffset").value_or(0);
  const std::size_t length = natural(*view, "byteLength").value_or(kNone);
  if (!buffer || *buffer >= gltf.buffers.size()) return std::nullopt;
  const std::string_view bytes = gltf.buffers[*buffer];
  if (offset > bytes.size() || length > bytes.size() - offset) return std::nullopt;
  return View{bytes.substr(offset, length), natural(*view, "byteStride").value_or(0)};
}

}  // namespace

const JsonValue* element(const Gltf& gltf, std::string_view array, std::optional<std::size_t> index) {
  const JsonValue* json = gltf.root.find(array);
  const auto* list = json ? std::get_if<JsonValue::Array>(&json->value) : nullptr;
  return list && index && *index < list->size() ? &(*list)[*index] : nullptr;
}

std::optional<std::size_t> natural(const JsonValue& json, std::string_view key) {
  constexpr double kLargest = 9007199254740992;
  const JsonValue* member = json.find(key);
  if (!member) return std::nullopt;
  const auto* number = std::get_if<double>(&member->value);
  if (!number || !(*number >= 0 && *number <= kLargest && *number == std::floor(*number))) return kNone;
  return static_cast<std::size_t>(*number);
}

double number_or(const JsonValue& json, std::string_view key, double otherwise) {
  const JsonValue* member = json.find(key);
  const auto* number = member ? std::get_if<double>(&member->value) : nullptr;
  return number ? *number : otherwise;
}

std::optional<std::vector<double>> numbers(const JsonValue& json, std::string_view key, std::size_t count) {
  const JsonValue* member = json.find(key);
  const auto* list = member ? std::get_if<JsonValue::Array>(&member->value) : nullptr;
  if (!list || list->size() != count) return std::nullopt;
  std::vector<double> found;
  for (const JsonValue& value : *list) {
    const auto* number = std::get_if<double>(&value.value);
    if (!number) return std::nullopt;
    found.push_back(*number);
  }
  return found;
}

bool open_gltf(std::string&& bytes, Gltf& gltf, MeshReading& reading) {
  std::optional<std::string> own;
  std::string text;
  if (!bytes.starts_with("glTF"))
    text = std::move(bytes);
  else if (!split_glb(bytes, text, own, reading))
    return false;
  if (valid_prefix(text) != text.size()) return reading.refuse("its JSON is no UTF-8 text");
  Diagnostics diagnostics;
  auto root = parse_json(
      std::make_shared<const SourceText>(SourceText{reading.path.string(), std::move(text)}), diagnostics);
  if (!root) return reading.refuse("malformed JSON: " + diagnostics.all()[0].message);
  gltf.root = std::move(*root);
  const JsonValue* asset = gltf.root.find("asset");
  const JsonValue* version = asset ? asset->find("version") : nullptr;
  const auto* number = version ? std::get_if<std::string>(&version->value) : nullptr;
  if (!number || !number->starts_with("2.")) return reading.refuse("no glTF 2.0 asset");
  const JsonValue* list = gltf.root.find("buffers");
  const auto* buffers = list ? std::get_if<JsonValue::Array>(&list->value) : nullptr;
  return !buffers || std::all_of(buffers->begin(), buffers->end(), [&](const JsonValue& json) {
    return read_buffer(json, own, gltf, reading);
  });
}

std::optional<Accessor> Accessor::open(const Gltf& gltf, std::optional<std::size_t> index,
                                       std::string_view type, MeshReading& reading) {
  const auto refuse = [&](const std::string& what) {
    reading.fault = fmt::format("accessor {}: {}", index ? std::to_string(*index) : "?", what);
    return std::nullopt;
  };
  const JsonValue* json = element(gltf, "accessors", index);
  if (!json) return refuse("there is none");
  if (json->find("sparse")) return refuse("sparse accessors are not read");
  const JsonValue* named = json->find("type");
  const auto* name = named ? std::get_if<std::string>(&named->value) : nullptr;
  if (!name || *name != type) return refuse(fmt::format("wrong type (allowed {})", type));
  Accessor accessor;
  accessor.component_type_ = natural(*json, "componentType").value_or(kNone);
  const std::size_t width = width_of(accessor.component_type_) * (type == "VEC3" ? 3 : 1);
  if (width == 0) return refuse("unknown component type");
  const std::optional<View> view = view_of(gltf, *json);
  if (!view) return refuse("its view leaves the buffer, or there is none");
  const std::size_t offset = natural(*json, "byteOffset").value_or(0);
  accessor.count_ = natural(*json, "count").value_or(kNone);
  accessor.stride_ = view->stride == 0 ? width : view->stride;
  const std::size_t room = view->bytes.size();
  if (accessor.count_ == 0) return refuse("it is empty");
  if (offset > room || width > room - offset || accessor.stride_ < width ||
      accessor.count_ - 1 > (room - offset - width) / accessor.stride_)
    return refuse("it promises more than the buffer holds");
  accessor.bytes_ = view->bytes.substr(offset);
  return accessor;
}

bool Accessor::is_float() const {
  return component_type_ == kFloat;
}

float Accessor::real(std::size_t i, std::size_t component) const {
  float value = 0;
  std::memcpy(&value, bytes_.data() + i * stride_ + component * sizeof value, sizeof value);
  return value;
}

std::uint32_t Accessor::integer(std::size_t i) const {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes_.data() + i * stride_, width_of(component_type_));
  return value;
}

}  // namespace abbe
