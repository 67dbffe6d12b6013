#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "description/meshes/mesh_formats.h"

namespace tinygltf {
class Model;
}

namespace abbe {

/// Numbers stored in a buffer, checked to lie within it: the library checks none.
struct GltfNumbers {
  const unsigned char* first;
  std::size_t count;
  std::size_t stride;
  int component_type;
};

/// The numbers of an accessor of `type`; nothing, after a fault, for one that does not exist, is of another
/// type or leaves its buffer.
[[nodiscard]] std::optional<GltfNumbers> numbers_of(const tinygltf::Model& model, int accessor, int type,
                                                    MeshReading& reading);

/// Number `i` of bytes, shorts or integers.
[[nodiscard]] std::uint32_t index_at(const GltfNumbers& numbers, std::size_t i);
/// Three floats.
[[nodiscard]] Imath::V3d vector_at(const GltfNumbers& numbers, std::size_t i);
/// Texture coordinates, as floats or as shares of the largest integer; v runs downwards in the format,
/// upwards here.
[[nodiscard]] Imath::V2f coordinates_at(const GltfNumbers& numbers, std::size_t i);

/// The element of a list that the file names by its number, or nullptr.
template <typename T>
[[nodiscard]] const T* at(const std::vector<T>& list, int index) {
  return index >= 0 && static_cast<std::size_t>(index) < list.size() ? &list[static_cast<std::size_t>(index)]
                                                                     : nullptr;
}

}  // namespace abbe
