#include "calibration/metrics/color_rendering.h"

#include <cmath>

#include "calibration/metrics/appearance.h"
#include "calibration/metrics/reference_light.h"
#include "spectral/chart.h"
#include "spectral/color_temperature.h"

namespace abbe {
namespace {

constexpr std::size_t kGeneralSamples = 8;

const Chart& test_colors() {
  static const Chart chart = shipped_chart("cri_tcs01-14");
  return chart;
}

// Terms of the adaptation, c = (4 - u - 10 v)/v and d = (1.708 v + 0.404 - 1.481 u)/v.
struct VonKries {
  double c;
  double d;
  explicit VonKries(const Uv1960& uv)
      : c((4 - uv[0] - 10 * uv[1]) / uv[1]), d((1.708 * uv[1] + 0.404 - 1.481 * uv[0]) / uv[1]) {}
};

// Chromaticity of a sample under the test light, adapted to the reference light.
Uv1960 adapted(const Uv1960& uv, const VonKries& test, const VonKries& reference) {
  const VonKries terms(uv);
  const double c = reference.c / test.c * terms.c;
  const double d = reference.d / test.d * terms.d;
  const double denominator = 16.518 + 1.481 * c - d;
  return {(10.872 + 0.404 * c - 4 * d) / denominator, 5.520 / denominator};
}

// CIE 1964 U*, V*, W* relative to the reference light.
std::array<double, 3> uvw(double luminance, const Uv1960& uv, const Uv1960& reference) {
  const double w = 25 * std::cbrt(luminance) - 17;
  return {13 * w * (uv[0] - reference[0]), 13 * w * (uv[1] - reference[1]), w};
}

}  // namespace

// R_i = 100 - 4.6 d_i, with the distance d_i in U*V*W* between a sample under both lights.
std::optional<ColorRendering> color_rendering(const Curve& light, SumRange range) {
  const auto summed = [range](const Curve& illuminant, const Curve& reflectance) {
    return tristimulus(illuminant, reflectance, Observer::cie1931, range);
  };
  const auto temperature = color_temperature(summed(light, Curve(1)));
  if (!temperature || temperature->kelvin > kHottestDaylight) return std::nullopt;
  const Curve reference = rendering_reference(temperature->kelvin);
  const Uv1960 test_white = uv_1960(summed(light, Curve(1)));
  const Uv1960 reference_white = uv_1960(summed(reference, Curve(1)));
  ColorRendering result;
  for (std::size_t i = 0; i < result.special.size(); ++i) {
    const Curve& sample = test_colors().patches.at(i).reflectance;
    const XYZ test = summed(light, sample);
    const XYZ ideal = summed(reference, sample);
    const Uv1960 uv = adapted(uv_1960(test), VonKries(test_white), VonKries(reference_white));
    result.special[i] = 100 - 4.6 * distance_between(uvw(test[1], uv, reference_white),
                                                     uvw(ideal[1], uv_1960(ideal), reference_white));
    if (i < kGeneralSamples) result.general += result.special[i] / kGeneralSamples;
  }
  return result;
}

}  // namespace abbe
