#include "sensor/response/analyser.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace abbe {
namespace {

// Applies a function to the values of a curve: exact at its knots and at every nanometre.
template <typename Function>
Curve of_each(const Curve& curve, Function function) {
  std::vector<Knot> knots;
  for (const Knot& knot : curve.knots()) {
    if (!knots.empty())
      for (double nm = std::floor(knots.back().wavelength_nm) + 1; nm < knot.wavelength_nm; ++nm)
        knots.push_back({nm, curve(nm)});
    knots.push_back(knot);
  }
  for (Knot& knot : knots) knot.value = function(knot.value);
  return Curve(std::move(knots));
}

}  // namespace

StokesSpectrum row_of(const Analyser& analyser, const SampledSpectrum& wavelengths_nm) {
  const SampledSpectrum contrast = analyser.contrast(wavelengths_nm);
  return {SampledSpectrum(analyser.i), contrast * analyser.q, contrast * analyser.u, contrast * analyser.v};
}

Curve mean_transmittance(const Polariser& polariser) {
  if (!polariser.extinction_ratio) return scaled(polariser.transmittance, 0.5);
  return product(polariser.transmittance,
                 of_each(*polariser.extinction_ratio, [](double ratio) { return (1 + 1 / ratio) / 2; }));
}

Analyser analyser_of(const Polariser& polariser) {
  const double twice = polariser.angle_deg * std::numbers::pi / 90;
  Analyser analyser{1, static_cast<float>(std::cos(twice)), static_cast<float>(std::sin(twice)), 0};
  if (polariser.extinction_ratio)
    analyser.contrast =
        of_each(*polariser.extinction_ratio, [](double ratio) { return (ratio - 1) / (ratio + 1); });
  return analyser;
}

}  // namespace abbe
