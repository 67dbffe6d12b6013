#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/json.h"
#include "scene/shapes/mesh_formats.h"

namespace abbe {

/// A glTF asset: its JSON, and the bytes of its buffers.
struct Gltf {
  JsonValue root;
  std::vector<std::string> buffers;
};

/// Takes a .gltf or .glb apart and reads the buffers it names: within the file, as base64, or beside it.
[[nodiscard]] bool open_gltf(std::string&& bytes, Gltf& gltf, MeshReading& reading);

/// The `index`-th of a top-level array; nullptr when there is none.
[[nodiscard]] const JsonValue* element(const Gltf& gltf, std::string_view array,
                                       std::optional<std::size_t> index);
/// A member that is an integer >= 0; nothing when absent. What is there and is none counts as the largest.
[[nodiscard]] std::optional<std::size_t> natural(const JsonValue& json, std::string_view key);
/// A member that is a finite number, else `otherwise`.
[[nodiscard]] double number_or(const JsonValue& json, std::string_view key, double otherwise);
/// A member that is an array of `count` numbers; nothing otherwise.
[[nodiscard]] std::optional<std::vector<double>> numbers(const JsonValue& json, std::string_view key,
                                                         std::size_t count);

/// Numbers stored in a buffer, checked to lie within it.
class Accessor {
 public:
  /// Accessor `index` of the asset if its type ("SCALAR", "VEC3") is the one asked for, else a fault.
  static std::optional<Accessor> open(const Gltf& gltf, std::optional<std::size_t> index,
                                      std::string_view type, MeshReading& reading);
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] bool is_float() const;
  [[nodiscard]] float real(std::size_t i, std::size_t component) const;
  /// An unsigned integer.
  [[nodiscard]] std::uint32_t integer(std::size_t i) const;

 private:
  std::string_view bytes_;  // from the first element
  std::size_t count_ = 0;
  std::size_t stride_ = 0;
  std::size_t component_type_ = 0;
};

}  // namespace abbe
