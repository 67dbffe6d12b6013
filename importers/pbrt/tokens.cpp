#include "importers/pbrt/tokens.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe::importers::pbrt {

namespace {

constexpr std::string_view kBlanks = " \t\r\n\f\v";
constexpr std::size_t kMaxFiles = 64;  // Largest depth of inclusion.

}  // namespace

Tokens::Tokens(const std::filesystem::path& file, SceneImporter& importer) : importer_(importer) {
  open(file);
}

void Tokens::open(const std::filesystem::path& file) {
  auto source = importer_.read(file);
  if (!source) {
    failed_ = true;
    return;
  }
  files_.push_back({std::move(source)});
}

void Tokens::include(const std::filesystem::path& file, const SourcePosition& where) {
  if (files_.size() == kMaxFiles) {
    importer_.diagnostics.error(where, fmt::format("files are included more than {} levels deep", kMaxFiles));
    failed_ = true;
  } else if (!importer_.count_include(where) || !is_file(file, where, importer_.diagnostics)) {
    failed_ = true;
  } else {
    open(file);
  }
}

void Tokens::import_file(const std::filesystem::path& file, const SourcePosition& where) {
  include(file, where);
  if (!failed_) files_.back().imported = true;
}

std::optional<Token> Tokens::next() {
  if (!peeked_) return read();
  return std::exchange(peeked_, std::nullopt);
}

const std::optional<Token>& Tokens::peek() {
  if (!peeked_) peeked_ = read();
  return peeked_;
}

std::optional<Token> Tokens::read() {
  while (!failed_ && !files_.empty()) {
    OpenFile& file = files_.back();
    const std::string& text = file.source->text;
    file.at = std::min(text.find_first_not_of(kBlanks, file.at), text.size());
    end_ = {file.source, file.at, ""};
    if (file.at == text.size()) {
      const bool imported = file.imported;
      files_.pop_back();
      if (imported) return Token{"", false, end_};
    } else if (text[file.at] == '#') {
      file.at = std::min(text.find('\n', file.at), text.size());
    } else if (text[file.at] == '"') {
      return read_quoted(file);
    } else if (text[file.at] == '[' || text[file.at] == ']') {
      ++file.at;
      return Token{text.substr(file.at - 1, 1), false, end_};
    } else {
      const std::size_t end = std::min(text.find_first_of(" \t\r\n\f\v\"[]#", file.at), text.size());
      const std::size_t from = std::exchange(file.at, end);
      return Token{text.substr(from, end - from), false, end_};
    }
  }
  return std::nullopt;
}

std::optional<Token> Tokens::read_quoted(OpenFile& file) {
  const std::string& text = file.source->text;
  std::string word;
  for (std::size_t i = file.at + 1; i < text.size() && text[i] != '\n'; ++i) {
    if (text[i] == '"') {
      file.at = i + 1;
      return Token{word, true, end_};
    }
    if (text[i] == '\\' && i + 1 < text.size()) ++i;
    word += text[i];
  }
  importer_.diagnostics.error(end_, "a quoted text without its closing quote");
  failed_ = true;
  return std::nullopt;
}

}  // namespace abbe::importers::pbrt
