#include "io/diagnostics.h"

#include <algorithm>
#include <cctype>
#include <numeric>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {

namespace {

constexpr std::size_t kExcerptBefore = 72;
constexpr std::size_t kExcerptAfter = 36;
constexpr std::size_t kShortList = 12;

bool continues_code_point(char c) {
  return (static_cast<unsigned char>(c) & 0xC0) == 0x80;
}

std::size_t code_points(std::string_view text) {
  return text.size() -
         static_cast<std::size_t>(std::count_if(text.begin(), text.end(), continues_code_point));
}

/// Replaces control characters: a hostile input must not send control sequences to the user's terminal.
std::string printable(std::string_view text) {
  std::string shown;
  for (const char c : valid_utf8(text, "?")) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80 && byte < 0xA0 && shown.ends_with('\xC2'))  // U+0080 to U+009F
      shown.back() = '?';
    else
      shown += (byte < 0x20 && c != '\t') || byte == 0x7F ? '?' : c;
  }
  return shown;
}

std::string_view line_at(std::string_view text, std::size_t offset) {
  const std::size_t newline = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
  const std::size_t begin = newline == std::string_view::npos ? 0 : newline + 1;
  std::string_view line = text.substr(begin, text.find('\n', offset) - begin);
  if (line.ends_with('\r') && begin + line.size() > offset) line.remove_suffix(1);
  return line;
}

/// The part of the line around byte `at`, and a caret below that byte.
std::string excerpt(std::string_view line, std::size_t at) {
  std::size_t begin = at > kExcerptBefore ? at - kExcerptBefore : 0;
  while (begin < at && continues_code_point(line[begin])) ++begin;
  std::size_t end = std::min(line.size(), at + kExcerptAfter);
  while (end < line.size() && continues_code_point(line[end])) ++end;
  std::string margin;
  for (const char c : line.substr(begin, at - begin))
    if (!continues_code_point(c)) margin += c == '\t' ? '\t' : ' ';
  return fmt::format("\n{}\n{}^", printable(line.substr(begin, end - begin)), margin);
}

/// Levenshtein distance, ignoring the case of ASCII letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (lower(a[i]) == lower(b[j]) ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, diagonal + 1, row[j] + 1});
    }
  }
  return row.back();
}

}  // namespace

void Diagnostics::error(const SourcePosition& where, std::string message, ErrorCode code) {
  diagnostics_.push_back({Diagnostic::Severity::error, code, where, std::move(message)});
  ++errors_;
}

void Diagnostics::warning(const SourcePosition& where, std::string message) {
  diagnostics_.push_back({Diagnostic::Severity::warning, ErrorCode::scene, where, std::move(message)});
}

void Diagnostics::error_if_strict(const SourcePosition& where, std::string message) {
  if (strictness_ == Strictness::strict)
    error(where, std::move(message));
  else
    warning(where, std::move(message));
}

ErrorCode Diagnostics::code() const {
  for (const Diagnostic& diagnostic : diagnostics_)
    if (diagnostic.severity == Diagnostic::Severity::error) return diagnostic.code;
  return ErrorCode::internal;
}

std::string Diagnostics::text(std::size_t limit) const {
  std::string all;
  std::size_t errors = 0;
  for (const Diagnostic& diagnostic : diagnostics_) {
    if (diagnostic.severity == Diagnostic::Severity::error && ++errors > limit) continue;
    all += format(diagnostic) + '\n';
  }
  if (errors > limit) all += fmt::format("further errors: {}\n", errors - limit);
  return all;
}

std::string format(const Diagnostic& diagnostic) {
  const SourcePosition& where = diagnostic.where;
  std::string head;
  std::string tail;
  if (where.source) {
    head = printable(where.source->file) + ':';
    if (where.offset != SourcePosition::kWholeFile) {
      const std::string_view text = where.source->text;
      const std::size_t offset = std::min(where.offset, text.size());
      const std::string_view line = line_at(text, offset);
      const std::size_t at = static_cast<std::size_t>(text.data() + offset - line.data());
      head += fmt::format("{}:{}:", 1 + std::count(text.begin(), text.end() - (text.size() - offset), '\n'),
                          1 + code_points(line.substr(0, at)));
      tail = excerpt(line, at);
    }
    head += ' ';
  }
  if (!where.pointer.empty()) head += printable(where.pointer) + ": ";
  const bool error = diagnostic.severity == Diagnostic::Severity::error;
  return head + (error ? "error: " : "warning: ") + printable(diagnostic.message) + tail;
}

std::optional<std::string> nearest_name(std::string_view name, std::span<const std::string> candidates) {
  std::size_t best =
      // Close enough is one typing error, and another one for every four letters.
      2 + name.size() / 4;
  std::optional<std::string> nearest;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance >= best || distance >= std::max(name.size(), candidate.size())) continue;
    best = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string unknown_name(std::string_view kind, std::string_view name,
                         std::span<const std::string> candidates) {
  if (const auto nearest = nearest_name(name, candidates))
    return fmt::format("unknown {} \"{}\"; did you mean \"{}\"?", kind, name, *nearest);
  if (candidates.empty() || candidates.size() > kShortList)
    return fmt::format("unknown {} \"{}\"", kind, name);
  // Each once: two forms of a struct may have the same key.
  std::vector<std::string> known;
  for (const std::string& candidate : candidates)
    if (std::find(known.begin(), known.end(), candidate) == known.end()) known.push_back(candidate);
  return fmt::format("unknown {} \"{}\"; known: {}", kind, name, fmt::join(known, ", "));
}

void require_no_errors(const Diagnostics& diagnostics) {
  if (!diagnostics.has_errors()) return;
  std::string all = diagnostics.text();
  if (all.ends_with('\n')) all.pop_back();
  const auto first =
      std::find_if(diagnostics.all().begin(), diagnostics.all().end(),
                   [](const Diagnostic& d) { return d.severity == Diagnostic::Severity::error; });
  const bool placed = first->where.source != nullptr;
  const ErrorCode code =
      !placed && diagnostics.code() == ErrorCode::scene ? ErrorCode::input : diagnostics.code();
  // Each diagnostic with a position begins a line, since editors parse it.
  throw InvalidInput(code, placed ? "invalid input\n" + all : all,
                     {diagnostics.all().begin(), diagnostics.all().end()});
}

}  // namespace abbe
