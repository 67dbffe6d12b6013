#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "description/meshes/mesh_formats.h"

namespace tinygltf {
class Model;
}

namespace abbe {

/// A strided view of elements in a buffer of a tinygltf::Model, which must outlive it. `numbers_of` ensures
/// that all elements lie within the buffer, which the library does not check.
struct GltfNumbers {
  const unsigned char* first;  ///< First byte of the first element; need not be aligned.
  std::size_t count;           ///< Number of elements, at least 1.
  std::size_t stride;          ///< Distance between elements [bytes].
  int component_type;          ///< Type of the components of an element, a TINYGLTF_COMPONENT_TYPE.
};

/// The elements of the accessor with the index `accessor`. Its type must be `type`: TINYGLTF_TYPE_SCALAR,
/// VEC2 or VEC3. Components may be of any type; the functions below do not check them either. Returns
/// nothing, after setting `reading.fault`, for an accessor that does not exist, has another type, is sparse
/// or empty, or exceeds its buffer.
[[nodiscard]] std::optional<GltfNumbers> numbers_of(const tinygltf::Model& model, int accessor, int type,
                                                    MeshReading& reading);

/// Element `i` < count of a SCALAR accessor of unsigned bytes, shorts or integers.
[[nodiscard]] std::uint32_t index_at(const GltfNumbers& numbers, std::size_t i);
/// Element `i` < count of a VEC3 accessor of floats.
[[nodiscard]] Imath::V3d vector_at(const GltfNumbers& numbers, std::size_t i);
/// Texture coordinates of element `i` < count of a VEC2 accessor. Floats are taken as they are, unsigned
/// bytes and shorts are divided by 255 and 65535. v increases downwards in glTF and upwards in the result: it
/// is 1 - v.
[[nodiscard]] Imath::V2f coordinates_at(const GltfNumbers& numbers, std::size_t i);

/// Element of a list that the file refers to by its index, counted from 0; nullptr if `index` is out of
/// range.
template <typename T>
[[nodiscard]] const T* at(const std::vector<T>& list, int index) {
  return index >= 0 && static_cast<std::size_t>(index) < list.size() ? &list[static_cast<std::size_t>(index)]
                                                                     : nullptr;
}

/// Error message for bytes from which `gltf_json` returns nothing.
inline constexpr const char* kBadGlb = "malformed or truncated GLB, or one not of version 2";

/// The JSON text in the bytes of a .gltf or .glb file, as a view of `bytes`. Bytes that do not begin with
/// "glTF" are returned whole; their syntax is not checked. Nothing for a GLB that is malformed, truncated or
/// not of version 2.
[[nodiscard]] std::optional<std::string_view> gltf_json(std::string_view bytes);

/// Name of a material of a glTF file that gives it none: "material N" for its index N, counted from 0.
[[nodiscard]] std::string unnamed_gltf_material(std::size_t number);
/// Name of the material of primitives without a material.
inline constexpr const char* kDefaultGltfMaterial = "default";

/// Makes names distinct, in the same order. The first of several equal names stays; the others become "NAME
/// 2", "NAME 3" and so on. Materials of glTF files are identified by their index, and several may have the
/// same name.
[[nodiscard]] std::vector<std::string> distinct_names(std::vector<std::string> names);

}  // namespace abbe
