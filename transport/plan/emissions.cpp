#include "transport/plan/emissions.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

namespace abbe {
namespace {

// Integral of |emission x response|; a response may be negative.
double sensor_integral(const Curve& emission, const Curve& response) {
  const Curve both = product(emission, response);
  std::vector<Knot> knots(both.knots().begin(), both.knots().end());
  for (Knot& knot : knots) knot.value = std::abs(knot.value);
  return Curve(std::move(knots)).integral();
}

bool is_before(const ScaledCurve& a, const ScaledCurve& b) {
  if (&a.base() == &b.base()) return false;
  const auto first = a.base().knots();
  const auto second = b.base().knots();
  return std::lexicographical_compare(
      first.begin(), first.end(), second.begin(), second.end(), [](const Knot& x, const Knot& y) {
        return std::tie(x.wavelength_nm, x.value) < std::tie(y.wavelength_nm, y.value);
      });
}

}  // namespace

Emissions emissions_of(const Scene& scene) {
  Emissions emissions;
  std::map<ScaledCurve, double, decltype(&is_before)> known(is_before);  // integral for a factor of 1
  for (const Light& light : scene.lights) {
    const ScaledCurve emission = mean_emission(light);
    const auto [at, is_new] = known.emplace(emission, 0);
    if (is_new) {
      for (const Channel& channel : scene.channels)
        at->second = std::max(at->second, sensor_integral(emission.base(), envelope(channel)));
      emissions.distinct.push_back(emission.base());
    }
    emissions.sensor_emissions.push_back(at->second * emission.factor());
  }
  return emissions;
}

}  // namespace abbe
