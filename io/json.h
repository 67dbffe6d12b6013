#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "io/diagnostics.h"
#include "io/inputs.h"

namespace abbe {

/// A JSON value that remembers where it stood in its text. Objects keep the order of their members.
struct JsonValue {
  struct Member;
  using Array = std::vector<JsonValue>;
  using Object = std::vector<Member>;

  std::variant<std::nullptr_t, bool, double, std::string, Array, Object> value;
  SourcePosition where;
  std::size_t key_offset = 0;  ///< Byte offset of the key of an object's member.

  /// "null", "a boolean", "a number", "a string", "an array" or "an object".
  [[nodiscard]] std::string_view kind() const;
  /// The member of that name, or nullptr; nullptr too when this is no object.
  [[nodiscard]] const JsonValue* find(std::string_view key) const;
  [[nodiscard]] JsonValue* find(std::string_view key);
  /// Place of the key of an object's member, for complaints about the key.
  [[nodiscard]] SourcePosition key_position() const { return {where.source, key_offset, where.pointer}; }
};

/// One key and its value.
struct JsonValue::Member {
  std::string first;
  JsonValue second;
};

/// Parses JSON with `//` and `/* */` comments and trailing commas. Reports (and gives nothing for) truncated
/// or empty text, bytes after the value, duplicate keys, NaN and infinities, numbers beyond double, strings
/// holding NUL or half a surrogate pair, nesting deeper than 256, and JSON pointers beyond 1024 bytes.
/// `memory`, if any, counts what the values take, and throws when it is too much.
[[nodiscard]] std::optional<JsonValue> parse_json(const std::shared_ptr<const SourceText>& source,
                                                  Diagnostics& diagnostics, HeldMemory* memory = nullptr);

/// The value as JSON in one line, numbers with the fewest digits that read back as the same.
[[nodiscard]] std::string to_text(const JsonValue& value);

/// The value as JSON for people: what fits into a line of `width` columns stands in one.
[[nodiscard]] std::string to_lines(const JsonValue& value, std::size_t width);

/// Replaces or creates the value at a JSON pointer ("/render/samples") by `text`, which is JSON, or a bare
/// word or path taken as a string. Objects on the way are created; the index after an array's last, or "-",
/// appends. Reports, as usage errors, a pointer that passes through something that is no object or array, and
/// text that opens like a JSON array, object or string but is none; `said_by` is what they call the text.
void set_json(JsonValue& root, std::string_view pointer, std::string_view text, Diagnostics& diagnostics,
              std::string_view said_by = "--set");

/// One `--set /pointer=value` of the command line: what `set_json` takes.
struct Override {
  std::string pointer;
  std::string value;
  std::string said_by = "--set";  ///< Of another option, or of a keyword of Python, its name.
};

}  // namespace abbe
