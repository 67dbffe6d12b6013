#pragma once

#include <cstdint>
#include <string>

#include "mesh_files.h"

namespace abbe::test {

inline std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : bytes) {
    bits = bits << 8 | static_cast<unsigned char>(c);
    for (held += 8; held >= 6; held -= 6) text += digits[bits >> (held - 6) & 63];
  }
  if (held > 0) text += digits[bits << (6 - held) & 63];
  return text;
}

// Three vertices of a triangle of area 1/2 in the xy plane and its indices as shorts, padded to 44 bytes.
inline std::string triangle_bytes() {
  return raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}) + raw<std::uint16_t>({0, 1, 2, 0});
}

inline std::string glb(const std::string& json, const std::string& binary) {
  std::string padded = json + std::string((4 - json.size() % 4) % 4, ' ');
  const auto chunk = [](const std::string& body, std::uint32_t type) {
    return raw<std::uint32_t>({static_cast<std::uint32_t>(body.size()), type}) + body;
  };
  const std::string chunks = chunk(padded, 0x4E4F534A) + (binary.empty() ? "" : chunk(binary, 0x004E4942));
  return "glTF" + raw<std::uint32_t>({2, static_cast<std::uint32_t>(chunks.size() + 12)}) + chunks;
}

/// The parts of a glTF asset, for tests to change.
struct Asset {
  std::string nodes = R"([{"mesh": 0}])";
  std::string roots = "[0]";
  std::string primitive = R"("attributes": {"POSITION": 0}, "indices": 1)";
  std::string accessors = R"([{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
                              {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}])";
  std::string views =
      R"([{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 8}])";
  std::string buffer = R"({"byteLength": 44, "uri": "data:application/octet-stream;base64,)" +
                       base64(triangle_bytes()) + "\"}";
  std::string more;

  [[nodiscard]] std::string text() const {
    return R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": )" + roots + R"(}], "nodes": )" + nodes +
           R"(, "meshes": [{"primitives": [{)" + primitive + R"(}]}], "accessors": )" + accessors +
           R"(, "bufferViews": )" + views + R"(, "buffers": [)" + buffer + "]" + more + "}";
  }
};

/// The asset as one binary file.
inline std::string whole_glb(Asset asset = {}) {
  asset.buffer = R"({"byteLength": 44})";
  return glb(asset.text(), triangle_bytes());
}

}  // namespace abbe::test
