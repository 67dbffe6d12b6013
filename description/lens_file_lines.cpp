#include "description/lens_file_lines.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe::description::lenses {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr double kMaxPositive = 1e9;

}  // namespace

SourcePosition Line::where(std::size_t word) const {
  return {source, words[std::min(word, words.size() - 1)].offset, ""};
}

std::optional<std::string> Line::text(std::size_t word) const {
  return word < words.size() ? std::optional(words[word].text) : std::nullopt;
}

std::optional<double> Line::number(std::size_t word, Diagnostics& diagnostics) const {
  const auto word_text = text(word);
  const auto value = word_text ? parse_number(*word_text) : std::nullopt;
  if (!value)
    diagnostics.error(where(word),
                      fmt::format("{} needs a number here (got {})", keyword(),
                                  word_text ? fmt::format("\"{}\"", *word_text) : "the end of the line"),
                      ErrorCode::input);
  return value;
}

std::optional<double> Line::positive(std::size_t word, Diagnostics& diagnostics) const {
  const auto value = number(word, diagnostics);
  if (!value || (*value > 0 && *value <= kMaxPositive)) return value;
  diagnostics.error(where(word),
                    fmt::format("{} needs a number above 0 here (got {:g}, allowed (0, {:g}])", keyword(),
                                *value, kMaxPositive),
                    ErrorCode::input);
  return std::nullopt;
}

std::vector<double> Line::numbers(std::size_t first) const {
  std::vector<double> values;
  for (std::size_t i = first; i < words.size(); ++i) {
    const auto value = parse_number(words[i].text);
    if (!value) break;
    values.push_back(*value);
  }
  return values;
}

std::vector<Line> lines_of(const std::shared_ptr<const SourceText>& source) {
  const std::string& text = source->text;
  std::vector<Line> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    Line line{source, {}, kBlanks.find(text[begin]) != std::string_view::npos};
    for (std::size_t at = begin;;) {
      at = std::min(text.find_first_not_of(kBlanks, at), end);
      if (at >= end) break;
      const std::size_t stop = std::min(text.find_first_of(kBlanks, at), end);
      line.words.push_back({text.substr(at, stop - at), at});
      at = stop;
    }
    if (!line.words.empty()) lines.push_back(std::move(line));
    begin = end + 1;
  }
  return lines;
}

}  // namespace abbe::description::lenses
