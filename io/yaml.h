#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "io/json.h"

namespace abbe {

/// Largest number of values in a YAML document.
inline constexpr std::size_t kMaxYamlValues = 100000;

/// Parses a YAML document into the tree used for JSON: mappings are objects, sequences are arrays, empty
/// values are null. Scalars are strings, since in YAML their type depends on the reader. Reports errors of
/// the code `input` and returns nothing for:
/// - text that is not YAML, empty text, several documents;
/// - anchors and aliases, a few lines of which can expand to billions of values;
/// - keys that are not scalars, duplicate keys;
/// - nesting deeper than 256 levels, JSON pointers longer than 1024 bytes, more than `kMaxYamlValues` values.
[[nodiscard]] std::optional<JsonValue> parse_yaml(const std::shared_ptr<const SourceText>& source,
                                                  Diagnostics& diagnostics);

}  // namespace abbe
