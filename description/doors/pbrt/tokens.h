#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "description/doors/shared/door.h"

namespace abbe::doors::pbrt {

/// A word, a number, a bracket or a quoted text of a file.
struct Token {
  std::string text;  ///< Without its quotes.
  bool quoted = false;
  SourcePosition where;

  [[nodiscard]] bool is(std::string_view word) const { return !quoted && text == word; }
  /// Whether an imported file ends here.
  [[nodiscard]] bool ends_import() const { return is(""); }
};

/// The tokens of a file, and, where it includes others, of these.
class Tokens {
 public:
  /// Of the file; one that cannot be read is reported.
  Tokens(const std::filesystem::path& file, Door& door);

  /// The next token, nothing at the end of all files or after an error, which is reported.
  [[nodiscard]] std::optional<Token> next();
  /// The same, which stays the next.
  [[nodiscard]] const std::optional<Token>& peek();
  /// Goes on with another file, and then where it was. Reports one that cannot be read, and files that
  /// include one another without end, or are too many.
  void include(const std::filesystem::path& file, const SourcePosition& where);
  /// The same with a token of its own at the end of the file, so that nothing goes on beyond it.
  void import_file(const std::filesystem::path& file, const SourcePosition& where);
  /// Where the last file ended.
  [[nodiscard]] const SourcePosition& end() const { return end_; }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  struct Reading {
    std::shared_ptr<const SourceText> source;
    std::size_t at = 0;
    bool imported = false;
  };
  std::optional<Token> read();
  std::optional<Token> read_quoted(Reading& reading);
  void open(const std::filesystem::path& file);

  Door& door_;
  std::vector<Reading> files_{};
  std::optional<Token> peeked_{};
  SourcePosition end_{};
  bool failed_ = false;
};

}  // namespace abbe::doors::pbrt
