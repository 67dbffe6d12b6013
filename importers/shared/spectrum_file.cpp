#include "importers/shared/spectrum_file.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe::importers {

namespace {

std::vector<std::string> words_of(std::string line) {
  line.resize(std::min(line.find('#'), line.size()));
  std::ranges::replace_if(
      line, [](char c) { return c == '\t' || c == '\r' || c == ','; }, ' ');
  std::vector<std::string> words;
  for (std::string& word : split(line, ' '))
    if (!word.empty()) words.push_back(std::move(word));
  return words;
}

}  // namespace

std::optional<Samples> read_spectrum_file(const std::filesystem::path& file, const SourcePosition& where,
                                          SceneImporter& importer) {
  if (!importer.check_file(file, where)) return std::nullopt;
  const auto source = importer.read(file);
  if (!source) return std::nullopt;
  Samples samples;
  for (std::size_t from = 0; from < source->text.size();) {
    const std::size_t end = std::min(source->text.find('\n', from), source->text.size());
    const std::vector<std::string> words = words_of(source->text.substr(from, end - from));
    const auto nm = words.size() == 2 ? parse_number(words[0]) : std::nullopt;
    const auto value = nm ? parse_number(words[1]) : std::nullopt;
    if (value) {
      samples.nm.push_back(*nm);
      samples.values.push_back(*value);
    } else if (!words.empty()) {
      importer.diagnostics.error({source, from, ""}, "expected a wavelength and a value", ErrorCode::input);
      return std::nullopt;
    }
    from = end + 1;
  }
  if (!check_samples(samples, {source, 0, ""}, importer)) return std::nullopt;
  return samples;
}

}  // namespace abbe::importers
