#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "io/json.h"

namespace abbe {

/// Builds a `JsonValue` from the events of a parser of any text format. Rejects duplicate keys, nesting
/// deeper than `kMaxDepth` and JSON pointers longer than `kMaxPointer` bytes. Offsets are bytes from the
/// start of the source.
class ValueTree {
 public:
  static constexpr std::size_t kMaxDepth = 256;
  static constexpr std::size_t kMaxPointer =
      // Limits memory: every value stores its pointer, so long keys would multiply.
      1024;

  /// `pointer` is the JSON pointer of the root; errors have the code `code`. `memory`, if not nullptr,
  /// reserves the memory of the values; then `add` and `open` throw Error{resource} above its limit.
  /// `diagnostics` and `memory` must outlive the tree.
  ValueTree(std::shared_ptr<const SourceText> source, std::string pointer, ErrorCode code,
            Diagnostics& diagnostics, MemoryReservation* memory = nullptr);

  /// Sets the key of the next value, which must be called before each value in an object.
  void key(std::string name, std::size_t offset);
  /// Adds a null, boolean, number or string to the innermost open container, or as the root. False, with a
  /// report, if it is rejected; parsing must end then.
  bool add(decltype(JsonValue::value) value, std::size_t offset);
  /// Adds an empty array or object; the following values are added to it until `close`. False, with a report,
  /// if it is rejected.
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
