#include "sensor/film/recorded_attributes.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "io/spectral_exr.h"
#include "io/text.h"

namespace abbe {
namespace {

// Edges of the bands, or nothing for a single band, whose width is unknown.
std::vector<double> edges_of_bands(const Image& film) {
  std::vector<SpectralBand> bands;
  for (const ImageChannel& channel : film.channels)
    if (const auto name = parse_spectral_channel(channel.name, "film"); name && name->kind == '0')
      bands.push_back({name->center_nm, {}});
  if (bands.size() < 2) return {};
  std::ranges::sort(bands, {}, &SpectralBand::center_nm);
  return band_edges(bands);
}

}  // namespace

std::optional<std::string> attribute_of(const std::map<std::string, std::string>& attributes,
                                        const std::string& key) {
  const auto found = attributes.find(key);
  return found == attributes.end() ? std::nullopt : std::optional(found->second);
}

std::optional<double> number_of(const std::map<std::string, std::string>& attributes,
                                const std::string& key) {
  const auto text = attribute_of(attributes, key);
  return text ? parse_number(*text) : std::nullopt;
}

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

const char* photometric_unit(Observer observer) {
  return observer == Observer::cie1931 ? "photometric, lx s"
                                       : "photometric of CIE 1964, 683.002 lm/W times J per m^2";
}

FilmObserver recorded_film_observer(const Image& film) {
  const auto unit = film.metadata.find("channel.X");
  if (unit != film.metadata.end() && unit->second == photometric_unit(Observer::cie1964))
    return {Observer::cie1964};
  return {Observer::cie1931, is_spectral(film) ? edges_of_bands(film) : std::vector<double>{}};
}

std::optional<RecordedMosaic> recorded_mosaic(const std::map<std::string, std::string>& attributes) {
  const auto pattern = attributes.find("mosaic");
  const auto names = attributes.find("mosaic_channels");
  if (pattern == attributes.end() || names == attributes.end()) return std::nullopt;
  std::vector<std::string> channels = split(names->second, ',');
  auto mosaic = parse_mosaic(pattern->second, channels);
  if (!mosaic) return std::nullopt;
  return RecordedMosaic{*std::move(mosaic), std::move(channels)};
}

}  // namespace abbe
