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

/// A JSON value with its position in the source text. Objects keep the order of their members.
struct JsonValue {
  struct Member;
  using Array = std::vector<JsonValue>;
  using Object = std::vector<Member>;

  std::variant<std::nullptr_t, bool, double, std::string, Array, Object> value;
  SourcePosition where;
  std::size_t key_offset = 0;  ///< Byte offset of the value's key, if it is a member of an object.

  /// "null", "a boolean", "a number", "a string", "an array" or "an object".
  [[nodiscard]] std::string_view type_name() const;
  /// The member called `key`; nullptr if there is none or if this is not an object.
  [[nodiscard]] const JsonValue* find(std::string_view key) const;
  [[nodiscard]] JsonValue* find(std::string_view key);
  /// Position of the value's key, for diagnostics about the key.
  [[nodiscard]] SourcePosition key_position() const { return {where.source, key_offset, where.pointer}; }
};

/// One key and its value.
struct JsonValue::Member {
  std::string first;
  JsonValue second;
};

/// Parses JSON with `//` and `/* */` comments and trailing commas. Reports an error and returns nothing for:
/// - truncated or empty text, or text after the value;
/// - duplicate keys;
/// - NaN, infinities and numbers outside the range of double;
/// - strings with NUL or half a surrogate pair;
/// - nesting deeper than 256 levels and JSON pointers longer than 1024 bytes.
/// Reserves the memory of the values in `memory`, if given, which may throw Error{resource}.
[[nodiscard]] std::optional<JsonValue> parse_json(const std::shared_ptr<const SourceText>& source,
                                                  Diagnostics& diagnostics,
                                                  MemoryReservation* memory = nullptr);

/// The value as JSON in one line. Numbers have the fewest digits that read back to the same double.
[[nodiscard]] std::string to_text(const JsonValue& value);

/// The value as indented JSON. A value that fits into a line of `width` columns takes one line.
[[nodiscard]] std::string to_lines(const JsonValue& value, std::size_t width);

/// Sets the value at a JSON pointer ("/render/samples"). `text` is JSON, or a bare word or path that is taken
/// as a string. Missing objects on the path are created. The index after the last element of an array, or
/// "-", appends. Reports usage errors, which name the text `option_name`:
/// - a pointer through a value that is neither an object nor an array;
/// - text that begins like a JSON array, object or string but is malformed.
void set_json(JsonValue& root, std::string_view pointer, std::string_view text, Diagnostics& diagnostics,
              std::string_view option_name = "--set");

/// Arguments of `set_json`, such as from one `--set /pointer=value`.
struct Override {
  std::string pointer;
  std::string value;
  std::string option_name = "--set";  ///< Name of the command-line option or Python keyword, for errors.
};

}  // namespace abbe
