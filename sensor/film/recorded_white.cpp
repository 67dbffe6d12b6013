#include "sensor/film/recorded_white.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/error.h"
#include "io/text.h"

namespace abbe {

void record_white(const std::string& name, const Chromaticity& xy, bool asked,
                  std::map<std::string, std::string>& metadata) {
  std::string& told = metadata[kWhiteKey] = name;
  std::replace(told.begin(), told.end(), '\n', '?');  // headers have a line per entry
  metadata[kWhiteXyKey] = fmt::format("{} {}", xy[0], xy[1]);
  if (asked)
    metadata[kWhiteAskedKey] = "yes";
  else
    metadata.erase(kWhiteAskedKey);
}

std::optional<Chromaticity> recorded_white(const Image& film) {
  const auto found = film.metadata.find(kWhiteXyKey);
  if (found == film.metadata.end() || !film.metadata.contains(kWhiteKey)) return std::nullopt;
  const std::vector<std::string> words = split(found->second, ' ');
  const auto x = parse_number(words.front());
  const auto y = parse_number(words.back());
  if (words.size() == 2 && x && y && *x > 0 && *y > 0) return Chromaticity{*x, *y};
  throw Error(ErrorCode::input, "film",
              fmt::format("attribute \"{}\" makes no sense (got \"{}\")", kWhiteXyKey, found->second));
}

}  // namespace abbe
