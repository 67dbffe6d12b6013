#include "spectral/film_observer.h"

#include <cmath>
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
  const Chromaticity own = chromaticity(light, film_observer.observer);
  if (film_observer.band_edges_nm.empty()) return own;
  const Chromaticity shown =
      chromaticity(in_bands(light, film_observer.band_edges_nm), film_observer.observer);
  return std::isfinite(shown[0]) ? shown : own;
}

}  // namespace abbe
