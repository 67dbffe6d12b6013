#include "sensor/response/filter.h"

#include <algorithm>
#include <limits>

namespace abbe {
namespace {

// Largest value on the open interval (low, high), where the curve is linear between its knots.
double largest_between(const Curve& curve, double low, double high) {
  const auto knots = curve.knots();
  const auto after = [](double nm, const Knot& knot) { return nm < knot.wavelength_nm; };
  auto knot = std::upper_bound(knots.begin(), knots.end(), low, after);
  double largest = curve(low);  // value to the right of a jump at low
  for (; knot != knots.end() && knot->wavelength_nm < high; ++knot) largest = std::max(largest, knot->value);
  return std::max(largest, curve(std::nextafter(high, low)));
}

}  // namespace

Curve envelope(const InterferenceFilter& filter, double min_cosine) {
  const double shift = blue_shift(min_cosine, filter.effective_index);
  std::vector<double> edges;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) edges.push_back(nm);
  for (const Knot& knot : filter.transmittance.knots())
    for (const double nm : {knot.wavelength_nm, knot.wavelength_nm * shift})
      if (nm > kMinWavelengthNm && nm < kMaxWavelengthNm) edges.push_back(nm);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Knot> steps;
  steps.reserve(2 * edges.size());
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double value = largest_between(filter.transmittance, edges[i], edges[i + 1] / shift);
    steps.push_back({edges[i], value});
    steps.push_back({edges[i + 1], value});
  }
  return Curve(std::move(steps));
}

}  // namespace abbe
