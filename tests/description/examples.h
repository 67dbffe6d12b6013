#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/data_directory.h"
#include "io/json.h"

namespace abbe::test {

namespace fs = std::filesystem;

inline std::string file_text(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The scene files in a folder of the data directory and in the folders below it, sorted.
inline std::vector<fs::path> scene_files(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(data_directory() / folder))
    if (entry.path().extension() == ".json") paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

inline std::string scene_guide_text() {
  return file_text(data_directory().parent_path() / "docs" / "reference" / "scene.md");
}

/// The examples of the guide to scene files. Most of them show only a part of a scene.
inline std::vector<std::string> guide_examples() {
  const std::string guide = scene_guide_text();
  const std::regex fence("```jsonc\n([^`]*)```");
  std::vector<std::string> examples;
  for (std::sregex_iterator i(guide.begin(), guide.end(), fence), end; i != end; ++i)
    examples.push_back((*i)[1]);
  return examples;
}

/// A part of a scene, completed by the keys that a scene needs. Text that is not JSON is returned unchanged.
inline std::string completed(const std::string& fragment) {
  Diagnostics ignored;
  const auto source = std::make_shared<const SourceText>(SourceText{"fragment", fragment});
  const std::optional<JsonValue> parsed = parse_json(source, ignored);
  if (!parsed) return fragment;
  std::string text = "{";
  for (const auto& [key, value] :
       {std::pair{"abbe", "1"},
        std::pair{"camera",
                  R"({"pinhole": {"fov_deg": 40}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]})"},
        std::pair{"sensor", R"({"resolution": [4, 3], "channels": {"all": 1}})"}})
    if (!parsed->find(key)) text += fmt::format("\"{}\": {},\n", key, value);
  return text + fragment.substr(fragment.find('{') + 1);
}

}  // namespace abbe::test
