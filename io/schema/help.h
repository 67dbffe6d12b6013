#pragma once

#include <string>

#include "io/schema/fields.h"

namespace abbe::schema {

/// Help for a key, as lines for a terminal: its meaning, type, range and default, and the keys of objects in
/// it. `key` is one of:
/// - a path from the root with '/', through lists and names ("lights/sun/towards"). Numbers of elements and
///   names that the user chose may be included, as in a JSON pointer.
/// - a key, which is described at every position where it occurs;
/// - empty, for the keys of the root.
/// Throws Error{usage}, with the nearest known key, if a key is unknown.
[[nodiscard]] std::string help(const Fields& root, const std::string& key);

/// Every key of the file and its structs, without paths, each once, in byte order.
[[nodiscard]] std::vector<std::string> all_keys(const Fields& root);

}  // namespace abbe::schema
