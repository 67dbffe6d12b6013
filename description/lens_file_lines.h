#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/diagnostics.h"

namespace abbe::description::lenses {

/// A line of a lens file, split into words.
struct Line {
  struct Word {
    std::string text;
    std::size_t offset;  ///< Byte offset in the text.
  };
  std::shared_ptr<const SourceText> source;
  std::vector<Word> words;
  bool indented;  ///< True if the line starts with a blank.

  [[nodiscard]] const std::string& keyword() const { return words.front().text; }
  /// Position of a word in the text; of the last word if the line has fewer words.
  [[nodiscard]] SourcePosition where(std::size_t word = 0) const;
  /// A word of the line, where the keyword is word 0. Nothing if the line has fewer words.
  [[nodiscard]] std::optional<std::string> text(std::size_t word) const;
  /// A word as a number. Reports a word that is not a number or is missing.
  [[nodiscard]] std::optional<double> number(std::size_t word, Diagnostics& diagnostics) const;
  /// A word as a number in (0, 1e9]. Reports any other word.
  [[nodiscard]] std::optional<double> positive(std::size_t word, Diagnostics& diagnostics) const;
  /// All words from `first` as numbers, up to the first that is not a number.
  [[nodiscard]] std::vector<double> numbers(std::size_t first) const;
};

/// The lines of a text, without empty ones.
[[nodiscard]] std::vector<Line> lines_of(const std::shared_ptr<const SourceText>& source);

}  // namespace abbe::description::lenses
