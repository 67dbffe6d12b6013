#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/error.h"

namespace abbe {

/// A text in UTF-8 and the file name under which it was read. Source positions share ownership of it.
struct SourceText {
  std::string file;
  std::string text;
};

/// A position in a text.
struct SourcePosition {
  static constexpr std::size_t kWholeFile = static_cast<std::size_t>(-1);

  /// nullptr for an input without a text, such as a command-line option.
  std::shared_ptr<const SourceText> source;
  std::size_t offset = 0;  ///< Bytes from the start of the text, or kWholeFile for the file as a whole.
  std::string pointer;     ///< JSON pointer of the value there; "" for the root and for tables.
};

/// One error or warning about an input.
struct Diagnostic {
  enum class Severity { warning, error };
  Severity severity = Severity::error;
  ErrorCode code = ErrorCode::scene;  ///< Class of an error; unused for a warning.
  SourcePosition where;
  std::string message;
};

/// `strict` treats doubtful inputs as errors: inputs that can be used, but probably do not mean what the user
/// intended.
enum class Strictness { lenient, strict };

/// Collects all errors and warnings about the inputs of one command, so that a user sees them at once. Not
/// thread-safe.
class Diagnostics {
 public:
  Diagnostics() = default;
  explicit Diagnostics(Strictness strictness) : strictness_(strictness) {}

  /// Adds an error or a warning. Nothing is thrown: callers continue with the rest of the input, then check
  /// `has_errors`.
  void error(const SourcePosition& where, std::string message, ErrorCode code = ErrorCode::scene);
  void warning(const SourcePosition& where, std::string message);
  /// Adds an error and returns nothing, for functions with an optional result.
  std::nullopt_t refuse(const SourcePosition& where, std::string message, ErrorCode code = ErrorCode::scene) {
    error(where, std::move(message), code);
    return std::nullopt;
  }
  /// Reports an input that can be used but probably gives a wrong result: an error if strict.
  void error_if_strict(const SourcePosition& where, std::string message);

  [[nodiscard]] bool has_errors() const { return errors_ > 0; }
  /// Errors and warnings in the order in which they were reported. The next report invalidates the span.
  [[nodiscard]] std::span<const Diagnostic> all() const { return diagnostics_; }

  /// Code of the error reported first, or `ErrorCode::internal` if there is none.
  [[nodiscard]] ErrorCode code() const;

  /// All warnings and the first `limit` errors, in order, as lines of `format`. A final line counts the
  /// further errors.
  [[nodiscard]] std::string text(std::size_t limit = 20) const;

 private:
  std::vector<Diagnostic> diagnostics_;
  std::size_t errors_ = 0;
  Strictness strictness_ = Strictness::lenient;
};

/// `file:line:col: /pointer: error: message`, followed by the source line and a caret below the column. Lines
/// and columns start at 1; a column is a code point. Control characters and invalid UTF-8 are replaced by
/// "?", and long lines are cut around the column. The whole file as position omits line, column and excerpt.
[[nodiscard]] std::string format(const Diagnostic& diagnostic);

/// The candidate with the smallest edit distance to `name`, the first of equals; ASCII case is ignored.
/// Nothing if all differ by more than one letter plus one for every four letters of `name`, or in every
/// letter.
[[nodiscard]] std::optional<std::string> nearest_name(std::string_view name,
                                                      std::span<const std::string> candidates);

/// `unknown <kind> "<name>"`, followed by the nearest candidate (`nearest_name`). If none is near and there
/// are at most 12 candidates, all of them follow instead.
[[nodiscard]] std::string unknown_name(std::string_view kind, std::string_view name,
                                       std::span<const std::string> candidates);

/// Thrown if the inputs of a command contain errors. Its text is `Diagnostics::text`, with or without a first
/// line "invalid input".
struct InvalidInput : Error {
  InvalidInput(ErrorCode code, const std::string& message, std::vector<Diagnostic> all)
      : Error(code, "", message), diagnostics(std::move(all)) {}

  std::vector<Diagnostic> diagnostics;  ///< Errors and warnings, in the order in which they were found.
};

/// Throws InvalidInput with all diagnostics if there is an error among them. Its code is that of the first
/// error. A first error of the code `scene` without a source, such as an unknown name from the command line,
/// becomes `input`.
void require_no_errors(const Diagnostics& diagnostics);

}  // namespace abbe
