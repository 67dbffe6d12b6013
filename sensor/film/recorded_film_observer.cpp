#include "sensor/film/recorded_film_observer.h"

#include <algorithm>
#include <vector>

#include "io/spectral_exr.h"

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

}  // namespace abbe
