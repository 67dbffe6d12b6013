#include "scene/white.h"

#include <utility>

namespace abbe {

White white_of(const Light& light, const FilmObserver& film_observer, std::string reason) {
  Curve spectrum = mean_emission(light).curve();
  const Chromaticity xy = chromaticity(spectrum, film_observer);
  return {light.name, std::move(reason), xy, std::move(spectrum)};
}

}  // namespace abbe
