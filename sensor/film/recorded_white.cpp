#include "sensor/film/recorded_white.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/error.h"
#include "io/text.h"

namespace abbe {

void record_white(const std::string& name, const Chromaticity& xy, bool requested,
                  std::map<std::string, std::string>& metadata) {
  std::string& recorded = metadata[kWhiteKey] = name;
  std::replace(recorded.begin(), recorded.end(), '\n', '?');  // file headers have one line per entry
  metadata[kWhiteXyKey] = fmt::format("{} {}", xy[0], xy[1]);
  if (requested)
    metadata[kWhiteRequestedKey] = "yes";
  else
    metadata.erase(kWhiteRequestedKey);
}

std::optional<Chromaticity> recorded_white(const Image& film) {
  const auto entry = film.metadata.find(kWhiteXyKey);
  if (entry == film.metadata.end() || !film.metadata.contains(kWhiteKey)) return std::nullopt;
  const std::vector<std::string> words = split(entry->second, ' ');
  const auto x = parse_number(words.front());
  const auto y = parse_number(words.back());
  if (words.size() == 2 && x && y && *x > 0 && *y > 0) return Chromaticity{*x, *y};
  throw Error(ErrorCode::input, "film",
              fmt::format("attribute \"{}\" is malformed (got \"{}\", allowed two positive numbers)",
                          kWhiteXyKey, entry->second));
}

}  // namespace abbe
