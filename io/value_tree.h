#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "io/json.h"

namespace abbe {

/// Builds a `JsonValue` from the events of a parser of any text format. Rejects duplicate keys, nesting
/// deeper than `kMaxDepth` and JSON pointers longer than `kMaxPointer` bytes.
class ValueTree {
 public:
  static constexpr std::size_t kMaxDepth = 256;
  static constexpr std::size_t kMaxPointer =
      // Limits memory: every value stores its pointer, so long keys would multiply.
      1024;

  /// `pointer` is the JSON pointer of the root; errors have the code `code`. `memory`, if given, reserves the
  /// memory of the values.
  ValueTree(std::shared_ptr<const SourceText> source, std::string pointer, ErrorCode code,
            Diagnostics& diagnostics, MemoryReservation* memory = nullptr);

  /// Sets the key of the next value.
  void key(std::string name, std::size_t offset);
  /// Adds a null, boolean, number or string. False if it is rejected.
  bool add(decltype(JsonValue::value) value, std::size_t offset);
  /// Adds an array or object; the following values are added to it until `close`. False if it is rejected.
  bool open(decltype(JsonValue::value) container, std::size_t offset);
  void close();

  /// Reports an error at `pointer` and returns false.
  bool refuse(std::size_t offset, std::string message, std::string pointer);
  /// Reports an error at the pointer of the next value and returns false.
  bool refuse(std::size_t offset, std::string message);

  /// JSON pointer of the innermost open container.
  [[nodiscard]] std::string pointer() const;
  [[nodiscard]] bool refused() const { return refused_; }
  /// The innermost open array or object, nullptr when all are closed.
  [[nodiscard]] const JsonValue* innermost() const { return open_.empty() ? nullptr : open_.back(); }
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
