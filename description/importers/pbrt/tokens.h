#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "description/importers/shared/scene_importer.h"

namespace abbe::importers::pbrt {

/// A word, number, bracket or quoted string.
struct Token {
  std::string text;  ///< Without quotes.
  bool quoted = false;
  SourcePosition where;

  [[nodiscard]] bool is(std::string_view word) const { return !quoted && text == word; }
  /// True at the end of an imported file.
  [[nodiscard]] bool ends_import() const { return is(""); }
};

/// The tokens of a file and of the files it includes.
class Tokens {
 public:
  /// Opens the file; reports an error if it cannot be read.
  Tokens(const std::filesystem::path& file, SceneImporter& importer);

  /// Reads the next token. Nothing at the end of all files, and after an error, which is reported.
  [[nodiscard]] std::optional<Token> next();
  /// The next token without consuming it.
  [[nodiscard]] const std::optional<Token>& peek();
  /// Continues with another file, and after its end with the current one. Reports unreadable files, endless
  /// inclusion and too many files.
  void include(const std::filesystem::path& file, const SourcePosition& where);
  /// Like `include`, with a token at the end of the file (`Token::ends_import`), so that nothing extends past
  /// it.
  void import_file(const std::filesystem::path& file, const SourcePosition& where);
  /// Position of the current token, or the end of the last file.
  [[nodiscard]] const SourcePosition& end() const { return end_; }
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
