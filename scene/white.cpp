#include "scene/white.h"

#include <utility>

#include "scene/scene.h"
#include "sensor/response/polarised_channels.h"

namespace abbe {

White white_of(const Light& light, const FilmObserver& film_observer, std::string reason) {
  Curve spectrum = mean_emission(light).curve();
  const Chromaticity xy = chromaticity(spectrum, film_observer);
  return {light.name, std::move(reason), xy, std::move(spectrum)};
}

bool has_colors(const Scene& scene) {
  return scene.spectral || count_intensities(scene.channels) == 3;
}

FilmObserver film_observer_of(const Scene& scene) {
  return {standard_observer(intensities(scene.channels)).value_or(Observer::cie1931),
          scene.spectral ? edges_nm(*scene.spectral) : scene.image_band_edges_nm};
}

}  // namespace abbe
