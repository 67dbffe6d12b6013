#include "description/meshes/gltf_names.h"

#include <map>
#include <set>

#include <fmt/format.h>

namespace abbe {

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
