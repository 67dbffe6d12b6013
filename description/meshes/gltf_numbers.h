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

/// A strided view of numbers in a buffer. All of them lie within the buffer, which the library does not
/// check.
struct GltfNumbers {
  const unsigned char* first;
  std::size_t count;
  std::size_t stride;
  int component_type;
};

/// The numbers of an accessor of `type`. Returns nothing, after a fault, for an accessor that does not exist,
/// has another type or exceeds its buffer.
[[nodiscard]] std::optional<GltfNumbers> numbers_of(const tinygltf::Model& model, int accessor, int type,
                                                    MeshReading& reading);

/// Element `i`, of bytes, shorts or integers.
[[nodiscard]] std::uint32_t index_at(const GltfNumbers& numbers, std::size_t i);
/// Element `i`, of three floats.
[[nodiscard]] Imath::V3d vector_at(const GltfNumbers& numbers, std::size_t i);
/// Texture coordinates of element `i`, stored as floats or as integers divided by their maximum. v increases
/// downwards in glTF and upwards in the result.
[[nodiscard]] Imath::V2f coordinates_at(const GltfNumbers& numbers, std::size_t i);

/// Element of a list that the file refers to by its index, or nullptr.
template <typename T>
[[nodiscard]] const T* at(const std::vector<T>& list, int index) {
  return index >= 0 && static_cast<std::size_t>(index) < list.size() ? &list[static_cast<std::size_t>(index)]
                                                                     : nullptr;
}

}  // namespace abbe
