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

/// A text and the file name under which it was read. Source positions share ownership of it.
struct SourceText {
  std::string file;
  std::string text;
};

/// A position in a text. `offset` is in bytes, or kWholeFile for the file as a whole. `pointer` is the JSON
/// pointer of the value there, or "" for the root and for tables.
struct SourcePosition {
  static constexpr std::size_t kWholeFile = static_cast<std::size_t>(-1);

  std::shared_ptr<const SourceText> source;
  std::size_t offset = 0;
  std::string pointer;
};

/// One error or warning about an input.
struct Diagnostic {
  enum class Severity { warning, error };
  Severity severity = Severity::error;
  ErrorCode code = ErrorCode::scene;
  SourcePosition where;
  std::string message;
};

/// `strict` treats doubtful inputs as errors: inputs that can be used, but probably do not mean what the user
/// intended.
enum class Strictness { lenient, strict };

/// Collects all errors and warnings about the inputs of one command, so that a user sees them at once.
class Diagnostics {
 public:
  Diagnostics() = default;
  explicit Diagnostics(Strictness strictness) : strictness_(strictness) {}

  void error(const SourcePosition& where, std::string message, ErrorCode code = ErrorCode::scene);
  void warning(const SourcePosition& where, std::string message);
  /// Reports an input that can be used but probably gives a wrong result: an error if strict, otherwise a
  /// warning.
  void error_if_strict(const SourcePosition& where, std::string message);

  [[nodiscard]] bool has_errors() const { return errors_ > 0; }
  [[nodiscard]] std::span<const Diagnostic> all() const { return diagnostics_; }

  /// Code of the first error, or `ErrorCode::internal` if there is none.
  [[nodiscard]] ErrorCode code() const;

  /// All diagnostics as text, each formatted by `format` and ended by a newline. Errors beyond the first
  /// `limit` are counted in a final line.
  [[nodiscard]] std::string text(std::size_t limit = 20) const;

 private:
  std::vector<Diagnostic> diagnostics_;
  std::size_t errors_ = 0;
  Strictness strictness_ = Strictness::lenient;
};

/// `file:line:col: /pointer: error: message`, followed by the source line and a caret below the column. Lines
/// and columns start at 1; a column is a code point. Control characters are replaced by "?", and long lines
/// are cut around the column. Without a source it is the message alone. It has no trailing newline.
[[nodiscard]] std::string format(const Diagnostic& diagnostic);

/// The candidate with the smallest edit distance to `name`; nothing if all differ by more than a few letters.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view name,
                                                      std::span<const std::string> candidates);

/// `unknown <kind> "<name>"`, followed by the nearest candidate or, if none is near and the list is short, by
/// all candidates.
[[nodiscard]] std::string unknown_name(std::string_view kind, std::string_view name,
                                       std::span<const std::string> candidates);

}  // namespace abbe
