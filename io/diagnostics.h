#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/error.h"

namespace abbe {

/// A text with the name it was read under, kept alive by whatever points into it.
struct SourceText {
  std::string file;
  std::string text;
};

/// A place in a text: byte offset (kWholeFile for a file as such), and the JSON pointer of the value there
/// ("" for the root and for tables).
struct SourcePosition {
  static constexpr std::size_t kWholeFile = static_cast<std::size_t>(-1);

  std::shared_ptr<const SourceText> source;
  std::size_t offset = 0;
  std::string pointer;
};

/// One complaint about an input.
struct Diagnostic {
  enum class Severity { warning, error };
  Severity severity = Severity::error;
  ErrorCode code = ErrorCode::scene;
  SourcePosition where;
  std::string message;
};

/// Whether an input that can be used, but hardly gives what was meant, is used all the same.
enum class Strictness { lenient, strict };

/// Collects every complaint about the inputs of one command, so that a user sees all of them at once.
class Diagnostics {
 public:
  Diagnostics() = default;
  explicit Diagnostics(Strictness strictness) : strictness_(strictness) {}

  void error(const SourcePosition& where, std::string message, ErrorCode code = ErrorCode::scene);
  void warning(const SourcePosition& where, std::string message);
  /// A complaint about what would make the result wrong without stopping it: an error of the scene when
  /// strict, else a warning.
  void error_if_strict(const SourcePosition& where, std::string message);

  [[nodiscard]] bool has_errors() const { return errors_ > 0; }
  [[nodiscard]] std::span<const Diagnostic> all() const { return diagnostics_; }

  /// Code of the first error; `ErrorCode::internal` when there is none.
  [[nodiscard]] ErrorCode code() const;

  /// All complaints as text, the first `limit` errors with their excerpts, ending in a newline unless empty.
  [[nodiscard]] std::string text(std::size_t limit = 20) const;

 private:
  std::vector<Diagnostic> diagnostics_;
  std::size_t errors_ = 0;
  Strictness strictness_ = Strictness::lenient;
};

/// `file:line:col: /pointer: error: what is wrong` followed by the line concerned and a caret under the
/// column. Lines and columns count from 1; a column counts code points. Control characters are shown as "?";
/// long lines are cut around the column. A position without a source gives the message alone. No newline at
/// the end.
[[nodiscard]] std::string format(const Diagnostic& diagnostic);

/// The candidate closest to `name` by edit distance, if it is close enough to be what was meant.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view name,
                                                      std::span<const std::string> candidates);

/// `unknown <kind> "<name>"` followed by the nearest candidate, or by the list of candidates when that is
/// short.
[[nodiscard]] std::string unknown_name(std::string_view kind, std::string_view name,
                                       std::span<const std::string> candidates);

}  // namespace abbe
