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

/// A JSON value with its position in the source text. Objects keep the order of their members. All numbers
/// are doubles.
struct JsonValue {
  struct Member;
  using Array = std::vector<JsonValue>;
  using Object = std::vector<Member>;

  std::variant<std::nullptr_t, bool, double, std::string, Array, Object> value;
  SourcePosition where;
  /// Byte offset of the value's key in the source text; meaningful for members of objects only.
  std::size_t key_offset = 0;

  /// "null", "a boolean", "a number", "a string", "an array" or "an object".
  [[nodiscard]] std::string_view type_name() const;
  /// The member called `key`, case-sensitive; nullptr if there is none or if this is not an object.
  [[nodiscard]] const JsonValue* find(std::string_view key) const;
  [[nodiscard]] JsonValue* find(std::string_view key);
  /// Position of the value's key, for diagnostics about the key.
  [[nodiscard]] SourcePosition key_position() const { return {where.source, key_offset, where.pointer}; }
};

/// One key (`first`) and its value (`second`).
struct JsonValue::Member {
  std::string first;
  JsonValue second;
};

/// Parses JSON with `//` and `/* */` comments and trailing commas. Reports an error of the code `scene` and
/// returns nothing for:
/// - truncated or empty text, or text after the value;
/// - duplicate keys;
/// - NaN, infinities and numbers outside the range of double;
/// - strings with NUL or half a surrogate pair;
/// - nesting deeper than 256 levels and JSON pointers longer than 1024 bytes.
/// Reserves the memory of the values and of a copy of the text in `memory`, if not nullptr. Throws
/// Error{resource} if that exceeds the limit.
[[nodiscard]] std::optional<JsonValue> parse_json(const std::shared_ptr<const SourceText>& source,
                                                  Diagnostics& diagnostics,
                                                  MemoryReservation* memory = nullptr);

/// The value as JSON in one line without blanks. Numbers have the fewest digits that read back to the same
/// double; they must be finite.
[[nodiscard]] std::string to_text(const JsonValue& value);

/// The value as JSON, indented by two blanks per level and ending with a line feed. An array or object takes
/// one line if it fits into `width` bytes with its indentation and a comma.
[[nodiscard]] std::string to_lines(const JsonValue& value, std::size_t width);

/// Sets the value at a JSON pointer (RFC 6901), such as "/render/samples", in `root`; the empty pointer
/// replaces `root`. `text` is JSON. Text that is not JSON, such as a bare word or path, is taken as a string.
/// Missing objects on the path are created. The index after the last element of an array, or "-", appends.
/// Reports errors of the code `usage`, which name the text `option_name`:
/// - a pointer that is neither empty nor begins with "/";
/// - a pointer through a value that is neither an object nor an array;
/// - a pointer with an invalid index of an array, such as one that would leave a gap;
/// - text that begins with "[", "{" or a double quote but is not JSON;
/// - a pointer or text that is not UTF-8.
/// After an error the value is not set, but objects on its path may have been created.
void set_json(JsonValue& root, std::string_view pointer, std::string_view text, Diagnostics& diagnostics,
              std::string_view option_name = "--set");

/// Arguments of `set_json`, such as from one `--set /pointer=value`.
struct Override {
  std::string pointer;
  std::string value;
  std::string option_name = "--set";  ///< Name of the command-line option or Python keyword, for errors.
};

}  // namespace abbe
