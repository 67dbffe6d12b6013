#pragma once

#include <string>

#include "io/schema/fields.h"

namespace abbe::schema {

/// What a key of a file means, in lines for a terminal: its text, type, range and default, and of objects the
/// keys in them. `key` is a path from the root, through lists and names ("lights/sun/towards"), or a key that
/// may stand in several places, each of which is told; the keys of the root when it is empty. Throws
/// Error{usage} with the nearest known key.
[[nodiscard]] std::string help(const Fields& root, const std::string& key);

/// Every key of the file, each once, in alphabetical order.
[[nodiscard]] std::vector<std::string> all_keys(const Fields& root);

}  // namespace abbe::schema
