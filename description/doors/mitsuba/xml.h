#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/doors/shared/door.h"

namespace abbe::doors::mitsuba {

/// An element of a scene, with what it holds.
struct Element {
  std::string tag;
  std::vector<std::pair<std::string, std::string>> attributes{};
  std::vector<Element> children{};
  SourcePosition where{};
  std::size_t first = 0;  ///< Its number among all elements, in the order in which they begin.
  std::size_t last = 0;   ///< That of the last one within it.
  mutable bool used = false;

  /// The attribute of that name, empty without it.
  [[nodiscard]] const std::string& operator[](std::string_view name) const;
};

/// Reads a file, and those that it includes, whose elements stand in place of what includes them; `$name` in
/// attributes is replaced by what `<default>` says. Reports what is no XML, no scene, nested too deep, an
/// unknown `$name`, and files that are not there.
[[nodiscard]] std::optional<Element> read_xml(const std::filesystem::path& file, Door& door);

}  // namespace abbe::doors::mitsuba
