#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/diagnostics.h"

namespace abbe::description::lenses {

/// A line of words with their places.
struct Line {
  struct Word {
    std::string text;
    std::size_t offset;
  };
  std::shared_ptr<const SourceText> source;
  std::vector<Word> words;
  bool indented;

  [[nodiscard]] const std::string& keyword() const { return words.front().text; }
  [[nodiscard]] SourcePosition where(std::size_t word = 0) const;
  /// A word behind the keyword, which is word 0; nothing where the line is shorter.
  [[nodiscard]] std::optional<std::string> text(std::size_t word) const;
  /// A word as a number. Reports one that is none or is missing.
  [[nodiscard]] std::optional<double> number(std::size_t word, Diagnostics& diagnostics) const;
  /// The same of a number above 0, and at most 1e9.
  [[nodiscard]] std::optional<double> positive(std::size_t word, Diagnostics& diagnostics) const;
  /// All words from `first` on as numbers, up to the first that is none.
  [[nodiscard]] std::vector<double> numbers(std::size_t first) const;
};

/// The lines of a text that have words.
[[nodiscard]] std::vector<Line> lines_of(const std::shared_ptr<const SourceText>& source);

}  // namespace abbe::description::lenses
