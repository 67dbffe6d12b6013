#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "importers/shared/scene_importer.h"

namespace abbe::importers::mitsuba {

/// An XML element with its children.
struct Element {
  std::string tag;                                                ///< Name of the element, such as "shape".
  std::vector<std::pair<std::string, std::string>> attributes{};  ///< Names and values, in file order.
  std::vector<Element> children{};                                ///< Elements inside it, in file order.
  SourcePosition where{};
  /// Index among all elements, in the order of their start tags, counted from 1; 0 for the root.
  std::size_t first_index = 0;
  /// `first_index` of the last element inside it, or its own if it has none; 0 for the root.
  std::size_t last_index = 0;
  mutable bool used = false;  ///< True once the importer has used it; it notes the others as dropped.

  /// Value of the attribute called `name`; empty if absent.
  [[nodiscard]] const std::string& operator[](std::string_view name) const;
};

/// Reads a file and returns its root. Included files replace their <include>; `$name` in attributes is
/// replaced by the value of an earlier <default>. Neither of them remains as an element. Reports:
/// - missing or unreadable files, malformed XML and a root other than <scene>;
/// - elements or files nested deeper than 64 levels, and more than 10000 included files;
/// - a `$name` without a <default>, and a value longer than 1 MiB after the replacement.
/// Returns nothing after an error. Throws Error{resource} if the memory limit of `importer.inputs` is
/// exceeded.
[[nodiscard]] std::optional<Element> read_xml(const std::filesystem::path& file, SceneImporter& importer);

}  // namespace abbe::importers::mitsuba
