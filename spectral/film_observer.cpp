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
  const Chromaticity own = chromaticity(light, film_observer.observer);
  if (film_observer.band_edges_nm.empty()) return own;
  // The observer tables end at 830 nm. In near infrared they give the colour of deep red at a millionth of
  // its luminance, which is unusable for display.
  const Curve banded = in_bands(light, film_observer.band_edges_nm);
  const bool is_visible = banded.integral(kVisibleRange.low_nm, kVisibleRange.high_nm) > 0;
  return is_visible ? chromaticity(banded, film_observer.observer) : own;
}

}  // namespace abbe
