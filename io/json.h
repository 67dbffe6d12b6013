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
/// returns nothing for text that is not JSON, duplicate keys, and strings with NUL or half a surrogate pair.
/// NaN, infinities and numbers outside the range of double are errors, too. Nesting is limited to 256 levels,
/// and JSON pointers to 1024 bytes. Reserves the memory of the values and of a copy of the text in `memory`,
/// if not nullptr. Throws Error{resource} if that exceeds the limit.
[[nodiscard]] std::optional<JsonValue> parse_json(const std::shared_ptr<const SourceText>& source,
                                                  Diagnostics& diagnostics,
                                                  MemoryReservation* memory = nullptr);

/// Largest number of values in a YAML document.
inline constexpr std::size_t kMaxYamlValues = 100000;

/// Parses a YAML document into the tree used for JSON. Scalars are strings, since in YAML their type depends
/// on the reader; empty values are null. Reports errors of the code `input` and returns nothing for text that
/// is not YAML, empty text, several documents, duplicate keys and keys that are not scalars. Anchors and
/// aliases are errors: a few lines can expand to billions of values. Nesting and pointers are limited as in
/// `parse_json`, and values to `kMaxYamlValues`.
[[nodiscard]] std::optional<JsonValue> parse_yaml(const std::shared_ptr<const SourceText>& source,
                                                  Diagnostics& diagnostics);

/// The value as JSON in one line without blanks. Numbers have the fewest digits that read back to the same
/// double; they must be finite.
[[nodiscard]] std::string to_text(const JsonValue& value);

/// The value as JSON, indented by two blanks per level and ending with a line feed. An array or object takes
/// one line if it fits into `width` bytes with its indentation and a comma.
[[nodiscard]] std::string to_lines(const JsonValue& value, std::size_t width);

/// A key escaped for a JSON pointer: "~0" for "~", "~1" for "/" [RFC6901].
[[nodiscard]] std::string escaped_key(std::string_view key);

/// Sets the value at a JSON pointer (RFC 6901), such as "/render/samples", in `root`; the empty pointer
/// replaces `root`. `text` is JSON. Text that is not JSON, such as a bare word or path, is taken as a string.
/// Missing objects on the path are created. The index after the last element of an array, or "-", appends.
/// Reports errors of the code `usage`, which name the text `option_name`, for an invalid pointer and invalid
/// UTF-8. Text that begins with "[", "{" or a double quote must be JSON.
/// After an error the value is not set, but objects on its path may have been created.
void set_json(JsonValue& root, std::string_view pointer, std::string_view text, Diagnostics& diagnostics,
              std::string_view option_name = "--set");

/// Arguments of `set_json`, such as from one `--set /pointer=value`.
struct Override {
  std::string pointer;
  std::string value;
  std::string option_name = "--set";  ///< Name of the command-line option or Python keyword, for errors.
};

/// Builds a `JsonValue` from the events of a parser. Rejects duplicate keys, nesting deeper than `kMaxDepth`
/// and JSON pointers longer than `kMaxPointer` bytes. Offsets are bytes from the start of the source.
class ValueTree {
 public:
  static constexpr std::size_t kMaxDepth = 256;
  static constexpr std::size_t kMaxPointer = 1024;  ///< Every value stores its pointer.

  /// `pointer` is the JSON pointer of the root; errors have the code `code`. `memory`, if not nullptr,
  /// reserves the memory of the values; then `add` and `open` throw Error{resource} above its limit.
  /// `diagnostics` and `memory` must outlive the tree.
  ValueTree(std::shared_ptr<const SourceText> source, std::string pointer, ErrorCode code,
            Diagnostics& diagnostics, MemoryReservation* memory = nullptr);

  /// Sets the key of the next value, which must be called before each value in an object.
  void key(std::string name, std::size_t offset) {
    key_ = std::move(name);
    key_offset_ = offset;
  }
  /// Adds a null, boolean, number or string to the innermost open container, or as the root. False, with a
  /// report, if it is rejected; parsing must end then.
  bool add(decltype(JsonValue::value) value, std::size_t offset);
  /// Adds an empty array or object, to which values are added until `close`. The result is that of `add`.
  bool open(decltype(JsonValue::value) container, std::size_t offset);
  /// Closes the innermost open container, and reports duplicate keys of an object.
  void close();

  /// Reports an error at `pointer` and returns false. The tree is unusable from then on (`refused`).
  bool refuse(std::size_t offset, std::string message, std::string pointer);
  /// Reports an error at the pointer of the next value and returns false.
  bool refuse(std::size_t offset, std::string message);

  /// JSON pointer of the innermost open container; that of the root if all are closed.
  [[nodiscard]] std::string pointer() const;
  /// True if an error has been reported.
  [[nodiscard]] bool refused() const { return refused_; }
  /// The innermost open array or object, nullptr when all are closed.
  [[nodiscard]] const JsonValue* innermost() const { return open_.empty() ? nullptr : open_.back(); }
  /// Moves the finished tree out. Call it once, after all containers are closed and unless `refused`.
  [[nodiscard]] JsonValue take() { return std::move(root_); }

 private:
  [[nodiscard]] std::string next_pointer() const;
  JsonValue* insert(JsonValue value);
  void count(const decltype(JsonValue::value)& value, const std::string& pointer);
  void report_duplicates(const JsonValue::Object& object);

  std::shared_ptr<const SourceText> source_;
  std::string pointer_;
  ErrorCode code_;
  Diagnostics& diagnostics_;
  MemoryReservation* memory_;
  JsonValue root_;
  std::vector<JsonValue*> open_;
  JsonValue* last_ = nullptr;
  std::string key_;
  std::size_t key_offset_ = 0;
  bool refused_ = false;
};

}  // namespace abbe
