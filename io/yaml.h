#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "io/json.h"

namespace abbe {

/// Largest number of values in a YAML document.
inline constexpr std::size_t kMaxYamlValues = 100000;

/// Parses a YAML document into the tree used for JSON. Scalars are strings, since in YAML their type depends
/// on the reader; empty values are null. Reports errors of the code `input` and returns nothing for text that
/// is not YAML, empty text, several documents, duplicate keys and keys that are not scalars. Anchors and
/// aliases are errors: a few lines can expand to billions of values. Nesting and pointers are limited as in
/// `parse_json`, and values to `kMaxYamlValues`.
[[nodiscard]] std::optional<JsonValue> parse_yaml(const std::shared_ptr<const SourceText>& source,
                                                  Diagnostics& diagnostics);

}  // namespace abbe
