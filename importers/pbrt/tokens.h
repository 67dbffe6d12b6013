#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "importers/shared/scene_importer.h"

namespace abbe::importers::pbrt {

/// A word, number, bracket or quoted string.
struct Token {
  std::string text;  ///< Without quotes.
  bool quoted = false;
  SourcePosition where;

  /// True if the token is `word`, not quoted.
  [[nodiscard]] bool is(std::string_view word) const { return !quoted && text == word; }
  /// True at the end of an imported file.
  [[nodiscard]] bool ends_import() const { return is(""); }
};

/// The tokens of a file and of the files it includes, without comments. Errors go to the importer's
/// diagnostics. The importer must outlive it. Functions throw Error{resource} if the memory limit of its
/// inputs is exceeded.
class Tokens {
 public:
  /// Opens the file. Reports an error if it cannot be read; then `failed()` is true.
  Tokens(const std::filesystem::path& file, SceneImporter& importer);

  /// Reads the next token. Nothing at the end of all files, and after an error; `failed()` distinguishes
  /// them. Reports a quoted text without its closing quote.
  [[nodiscard]] std::optional<Token> next();
  /// The token that `next` will return, without consuming it. The reference is valid until the next call.
  [[nodiscard]] const std::optional<Token>& peek();
  /// Continues with another file, and after its end with the current one. No token may have been peeked.
  /// `where` is the position of the directive. Reports an unreadable file, inclusion more than 64 levels deep
  /// and more than 10000 included files; then `failed()` is true.
  void include(const std::filesystem::path& file, const SourcePosition& where);
  /// Like `include`, with a further token at the end of the file (`Token::ends_import`), so that no directive
  /// extends past it.
  void import_file(const std::filesystem::path& file, const SourcePosition& where);
  /// Position of the last token that was read or peeked; at the end of all files, the end of the last one.
  [[nodiscard]] const SourcePosition& end() const { return end_; }
  /// True after an error of this object. No further tokens are read then.
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  struct OpenFile {
    std::shared_ptr<const SourceText> source;
    std::size_t at = 0;
    bool imported = false;
  };
  std::optional<Token> read();
  std::optional<Token> read_quoted(OpenFile& file);
  void open(const std::filesystem::path& file);

  SceneImporter& importer_;
  std::vector<OpenFile> files_{};
  std::optional<Token> peeked_{};
  SourcePosition end_{};
  bool failed_ = false;
};

}  // namespace abbe::importers::pbrt
