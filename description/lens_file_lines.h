#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/diagnostics.h"

namespace abbe::description::lenses {

/// A line of a lens file, split into words. It has at least one word.
struct Line {
  struct Word {
    std::string text;
    std::size_t offset;  ///< Byte offset in `source->text`.
  };
  std::shared_ptr<const SourceText> source;
  std::vector<Word> words;
  bool indented;  ///< True if the line starts with a blank.

  /// The first word.
  [[nodiscard]] const std::string& keyword() const { return words.front().text; }
  /// Position of word number `word`, counted from 0; of the last word if the line has fewer words.
  [[nodiscard]] SourcePosition where(std::size_t word = 0) const;
  /// A word of the line, where the keyword is word 0. Nothing if the line has fewer words.
  [[nodiscard]] std::optional<std::string> text(std::size_t word) const;
  /// A word as a number. Reports a word that is not a number or is missing, with ErrorCode::input, and
  /// returns nothing.
  [[nodiscard]] std::optional<double> number(std::size_t word, Diagnostics& diagnostics) const;
  /// A word as a number in (0, 1e9]. Reports any other or a missing word, with ErrorCode::input, and returns
  /// nothing.
  [[nodiscard]] std::optional<double> positive(std::size_t word, Diagnostics& diagnostics) const;
  /// All words from number `first` on as numbers, up to the first that is not a number. Reports nothing.
  [[nodiscard]] std::vector<double> numbers(std::size_t first) const;
};

/// The lines of a text in order, without those that are empty or have only blanks.
[[nodiscard]] std::vector<Line> lines_of(const std::shared_ptr<const SourceText>& source);

}  // namespace abbe::description::lenses
