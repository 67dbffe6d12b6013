#include "description/meshes/gltf_file.h"

#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

namespace abbe {

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
