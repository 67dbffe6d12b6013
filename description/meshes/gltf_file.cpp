#include "description/meshes/gltf_file.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>
#include <tiny_gltf.h>

namespace abbe {

namespace {

template <typename T>
T number_at(const GltfNumbers& numbers, std::size_t i, std::size_t component = 0) {
  T value;
  std::memcpy(&value, numbers.first + i * numbers.stride + component * sizeof value, sizeof value);
  return value;
}

}  // namespace

std::optional<GltfNumbers> numbers_of(const tinygltf::Model& model, int index, int type,
                                      MeshReading& reading) {
  const auto refuse = [&](const std::string& what) {
    reading.refuse(fmt::format("accessor {}: {}", index, what));
    return std::nullopt;
  };
  const auto* accessor = at(model.accessors, index);
  if (!accessor) return refuse("it does not exist");
  if (accessor->sparse.isSparse) return refuse("sparse accessors are not supported");
  if (accessor->type != type)
    return refuse(fmt::format("wrong type (allowed {})", type == TINYGLTF_TYPE_VEC3   ? "VEC3"
                                                         : type == TINYGLTF_TYPE_VEC2 ? "VEC2"
                                                                                      : "SCALAR"));
  const auto* view = at(model.bufferViews, accessor->bufferView);
  const auto* buffer = view ? at(model.buffers, view->buffer) : nullptr;
  if (!buffer || view->byteOffset > buffer->data.size() ||
      view->byteLength > buffer->data.size() - view->byteOffset)
    return refuse("its view exceeds the buffer or does not exist");
  const int stride = accessor->ByteStride(*view);
  const int width = tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor->componentType)) *
                    tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type));
  if (width <= 0) return refuse("unknown component type");
  if (accessor->count == 0) return refuse("it is empty");
  const std::size_t room = view->byteLength;
  const GltfNumbers numbers{buffer->data.data() + view->byteOffset + std::min(accessor->byteOffset, room),
                            accessor->count, static_cast<std::size_t>(std::max(stride, 0)),
                            accessor->componentType};
  if (stride < width || accessor->byteOffset > room ||
      static_cast<std::size_t>(width) > room - accessor->byteOffset ||
      numbers.count - 1 > (room - accessor->byteOffset - static_cast<std::size_t>(width)) / numbers.stride)
    return refuse("it needs more bytes than the buffer holds");
  return numbers;
}

std::uint32_t index_at(const GltfNumbers& numbers, std::size_t i) {
  if (numbers.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE)
    return number_at<std::uint8_t>(numbers, i);
  if (numbers.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
    return number_at<std::uint16_t>(numbers, i);
  return number_at<std::uint32_t>(numbers, i);
}

Imath::V3d vector_at(const GltfNumbers& numbers, std::size_t i) {
  return Imath::V3d(Imath::V3f(number_at<float>(numbers, i, 0), number_at<float>(numbers, i, 1),
                               number_at<float>(numbers, i, 2)));
}

Imath::V2f coordinates_at(const GltfNumbers& numbers, std::size_t i) {
  Imath::V2f uv;
  for (unsigned c = 0; c < 2; ++c) {
    if (numbers.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE)
      uv[static_cast<int>(c)] = static_cast<float>(number_at<std::uint8_t>(numbers, i, c)) / 255;
    else if (numbers.component_type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)
      uv[static_cast<int>(c)] = static_cast<float>(number_at<std::uint16_t>(numbers, i, c)) / 65535;
    else
      uv[static_cast<int>(c)] = number_at<float>(numbers, i, c);
  }
  return {uv.x, 1 - uv.y};
}

static std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + offset, sizeof word);
  return word;
}

// The library does not count the 8-byte header of the second chunk of a GLB, and would read 8 bytes past its
// end.
std::optional<std::string_view> gltf_json(std::string_view bytes) {
  constexpr std::size_t kHeaders = 20;  // Length of the headers of the file and its first chunk.
  constexpr std::size_t kHeader = 8;
  if (!bytes.starts_with("glTF")) return bytes;
  if (bytes.size() < kHeaders || word_at(bytes, 4) != 2 || word_at(bytes, kHeader) < kHeaders ||
      word_at(bytes, kHeader) > bytes.size())
    return std::nullopt;
  const std::string_view rest = bytes.substr(kHeaders, word_at(bytes, kHeader) - kHeaders);
  const std::size_t json = word_at(bytes, 12);
  if (json > rest.size()) return std::nullopt;
  if (rest.size() >= json + kHeader && word_at(rest, json) > rest.size() - json - kHeader)
    return std::nullopt;
  return rest.substr(0, json);
}

std::string unnamed_gltf_material(std::size_t number) {
  return fmt::format("material {}", number);
}

std::vector<std::string> distinct_names(std::vector<std::string> names) {
  std::set<std::string> taken;
  std::map<std::string, int> last;  // Last number appended to each name.
  for (std::string& name : names) {
    const std::string given = name;
    while (!taken.insert(name).second) {
      int& number = last.try_emplace(given, 1).first->second;
      name = fmt::format("{} {}", given, ++number);
    }
  }
  return names;
}

}  // namespace abbe
