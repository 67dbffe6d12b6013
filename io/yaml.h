#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "io/json.h"

namespace abbe {

/// Values a YAML document may hold.
inline constexpr std::size_t kMaxYamlValues = 100000;

/// Parses a YAML document into the same tree as JSON: a mapping is an object, a sequence an array, and every
/// scalar the string it is written as, since YAML leaves its type to the reader; nothing at all is null.
/// Reports as input errors (and gives nothing for) text that is not YAML, empty text, several documents,
/// anchors and aliases (a few lines of them stand for billions of values), keys that are no scalars,
/// duplicate keys, nesting deeper than 256, JSON pointers beyond 1024 bytes, and more than `kMaxYamlValues`
/// values.
[[nodiscard]] std::optional<JsonValue> parse_yaml(const std::shared_ptr<const SourceText>& source,
                                                  Diagnostics& diagnostics);

}  // namespace abbe
