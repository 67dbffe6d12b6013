#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/importers/shared/scene_importer.h"

namespace abbe::importers::mitsuba {

/// An XML element with its children.
struct Element {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes{};
  std::vector<Element> children{};
  SourcePosition where{};
  std::size_t first_index = 0;  ///< Index among all elements, in the order of their start tags.
  std::size_t last_index = 0;   ///< `first_index` of the last element inside it.
  mutable bool used = false;

  /// Value of the attribute called `name`; empty if absent.
  [[nodiscard]] const std::string& operator[](std::string_view name) const;
};

/// Reads a file. Included files replace their <include>, and `$name` in attributes is replaced by the value
/// of its <default>. Reports malformed XML, a root other than <scene>, excessive nesting, unknown `$name` and
/// missing files. Nothing after an error.
[[nodiscard]] std::optional<Element> read_xml(const std::filesystem::path& file, SceneImporter& importer);

}  // namespace abbe::importers::mitsuba
