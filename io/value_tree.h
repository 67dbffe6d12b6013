#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "io/json.h"

namespace abbe {

/// Grows a `JsonValue` from the events of a parser, in their order, whatever the text's format. Refuses
/// duplicate keys, nesting deeper than `kMaxDepth`, and JSON pointers beyond `kMaxPointer` bytes.
class ValueTree {
 public:
  static constexpr std::size_t kMaxDepth = 256;
  static constexpr std::size_t kMaxPointer =
      1024;  // every value stores its pointer: long keys would multiply

  /// `pointer` is that of the root; complaints carry `code`. `memory`, if any, counts the values.
  ValueTree(std::shared_ptr<const SourceText> source, std::string pointer, ErrorCode code,
            Diagnostics& diagnostics, HeldMemory* memory = nullptr);

  /// The key of the next value.
  void key(std::string name, std::size_t offset);
  /// One value that holds no others. False when it is refused.
  bool add(decltype(JsonValue::value) value, std::size_t offset);
  /// An array or object that takes what follows until `close`. False when it is refused.
  bool open(decltype(JsonValue::value) container, std::size_t offset);
  void close();

  /// Complains; gives false.
  bool refuse(std::size_t offset, std::string message, std::string pointer);
  /// Refuses the document at the next value, as the other does at `pointer`.
  bool refuse(std::size_t offset, std::string message);

  /// Where the parser stands, as a JSON pointer.
  [[nodiscard]] std::string pointer() const;
  [[nodiscard]] bool refused() const { return refused_; }
  /// The innermost open array or object, nullptr when all are closed.
  [[nodiscard]] const JsonValue* innermost() const { return open_.empty() ? nullptr : open_.back(); }
  [[nodiscard]] JsonValue take() { return std::move(root_); }

 private:
  [[nodiscard]] std::string next_pointer() const;
  JsonValue* place(JsonValue value);
  void count(const decltype(JsonValue::value)& value, const std::string& pointer);
  void report_duplicates(const JsonValue::Object& object);

  std::shared_ptr<const SourceText> source_;
  std::string pointer_;
  ErrorCode code_;
  Diagnostics& diagnostics_;
  HeldMemory* memory_;
  JsonValue root_;
  std::vector<JsonValue*> open_;
  JsonValue* last_ = nullptr;
  std::string key_;
  std::size_t key_offset_ = 0;
  bool refused_ = false;
};

}  // namespace abbe
