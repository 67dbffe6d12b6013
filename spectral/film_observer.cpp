#include "spectral/film_observer.h"

#include <cstddef>
#include <utility>

namespace abbe {

Curve in_bands(const Curve& light, std::span<const double> edges_nm) {
  std::vector<Knot> knots{{edges_nm.front(), 0}};
  for (std::size_t i = 0; i + 1 < edges_nm.size(); ++i) {
    const double from = edges_nm[i];
    const double to = edges_nm[i + 1];
    const double mean = light.integral(from, to) / (to - from);
    knots.push_back({from, mean});
    knots.push_back({to, mean});
  }
  knots.push_back({edges_nm.back(), 0});
  return Curve(std::move(knots));
}

Chromaticity chromaticity(const Curve& light, const FilmObserver& film_observer) {
  if (!film_observer.band_edges_nm.empty())
    return chromaticity(in_bands(light, film_observer.band_edges_nm), FilmObserver{film_observer.observer});
  return chromaticity(tristimulus(light, Curve(1.0), film_observer.observer));
}

}  // namespace abbe
