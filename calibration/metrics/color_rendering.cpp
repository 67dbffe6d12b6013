#include "calibration/metrics/color_rendering.h"

#include <limits>
#include <numbers>

#include "calibration/chart/delta_e.h"
#include "calibration/metrics/appearance.h"
#include "io/error.h"
#include "spectral/chart.h"
#include "spectral/color_temperature.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

// Highest colour temperature of a CIE daylight [K].
constexpr double kHottestDaylight = 25000;

// Reference light of colour rendering for a colour temperature [K] up to `kHottestDaylight`: a black body
// below 5000 K, daylight from there on [CIE13, sec. 5.2]. The two kinds have different scales, since only
// relative spectra count.
Curve rendering_reference(double kelvin) {
  return kelvin < 5000 ? planck(kelvin) : daylight(kelvin);
}

// Reference light of colour fidelity, on any scale, for a colour temperature [K] up to `kHottestDaylight`: a
// black body up to 4000 K, daylight from 5000 K on. Between them it is a mixture whose fractions of
// luminance (CIE 1964), summed over `range`, are linear in the temperature [CIE224, sec. 4.3].
Curve fidelity_reference(double kelvin, SumRange range) {
  if (kelvin <= 4000) return planck(kelvin);
  if (kelvin >= 5000) return daylight(kelvin);
  const auto part = [range](const Curve& light, double fraction) {
    return scaled(light, fraction / sum_product(light, color_matching(Observer::cie1964).y, range));
  };
  const double fraction = (kelvin - 4000) / 1000;
  return sum(part(planck(kelvin), 1 - fraction), part(daylight(kelvin), fraction));
}

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

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kAdaptingLuminance = 100;
constexpr double kBackground = 20;

const Chart& evaluation_samples() {
  static const Chart chart = shipped_chart("cie224_ces01-99_1nm");
  return chart;
}

using Colors = std::vector<std::array<double, 3>>;

// J', a', b' of the samples under a light.
Colors colors_under(const Curve& light, SumRange range) {
  const std::vector<XYZ> weights = tristimulus_weights(light, Observer::cie1964, range);
  const auto sum = [&](const Curve& reflectance) {
    XYZ xyz{};
    int nm = range.low_nm;
    for (const XYZ& weight : weights) {
      const double reflected = reflectance(nm++);
      for (std::size_t k = 0; k < 3; ++k) xyz[k] += weight[k] * reflected;
    }
    return xyz;
  };
  const Appearance appearance(AppearanceModel::ciecam02,
                              {sum(Curve(1)), kAdaptingLuminance, kBackground, true});
  Colors colors;
  for (const Patch& patch : evaluation_samples().patches)
    colors.push_back(appearance.uniform(sum(patch.reflectance)));
  return colors;
}

// Colour fidelity of a colour difference, on a scale where 100 means no difference.
double fidelity_of(double difference) {
  return 10 * std::log1p(std::exp((100 - 6.73 * difference) / 10));
}

std::size_t bin_of(const std::array<double, 3>& color) {
  const double hue = std::atan2(color[2], color[1]) / kTurn;
  return static_cast<std::size_t>((hue < 0 ? hue + 1 : hue) * ColorFidelity::kBins) % ColorFidelity::kBins;
}

// Twice the area of the polygon of the bins' means; NaN where one has no samples.
double area(const std::array<HueBin, ColorFidelity::kBins>& bins, std::array<double, 2> HueBin::*of) {
  double total = 0;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const auto& [a0, b0] = bins[i].*of;
    const auto& [a1, b1] = bins[(i + 1) % bins.size()].*of;
    total += a0 * b1 - a1 * b0;
  }
  return total;
}

// Means of the k-th bin, from the sums over its `count` samples.
HueBin mean_of(HueBin bin, double count, double difference, std::size_t k) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  if (count == 0) return {{kNone, kNone}, {kNone, kNone}, kNone, kNone, kNone};
  for (std::size_t j = 0; j < 2; ++j) {
    bin.test[j] /= count;
    bin.reference[j] /= count;
  }
  // Mean shift along the central hue of the bin and across it, as fractions of the chroma [TM30, sec. 4.6].
  const double center = (static_cast<double>(k) + 0.5) * kTurn / ColorFidelity::kBins;
  const double chroma = std::hypot(bin.reference[0], bin.reference[1]);
  const double da = (bin.test[0] - bin.reference[0]) / chroma;
  const double db = (bin.test[1] - bin.reference[1]) / chroma;
  bin.chroma_shift = da * std::cos(center) + db * std::sin(center);
  bin.hue_shift = -da * std::sin(center) + db * std::cos(center);
  bin.fidelity = fidelity_of(difference / count);
  return bin;
}

std::array<HueBin, ColorFidelity::kBins> binned(const Colors& test, const Colors& reference) {
  std::array<HueBin, ColorFidelity::kBins> bins{};
  std::array<double, ColorFidelity::kBins> counts{};
  std::array<double, ColorFidelity::kBins> differences{};
  for (std::size_t i = 0; i < test.size(); ++i) {
    const std::size_t k = bin_of(reference[i]);
    counts[k] += 1;
    differences[k] += distance_between(test[i], reference[i]);
    for (std::size_t j = 0; j < 2; ++j) {
      bins[k].test[j] += test[i][j + 1];
      bins[k].reference[j] += reference[i][j + 1];
    }
  }
  for (std::size_t k = 0; k < bins.size(); ++k) bins[k] = mean_of(bins[k], counts[k], differences[k], k);
  return bins;
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

// X, Y, Z of the second under the test light are multiplied by first/second under the reference light.
Metamerism metamerism(const Curve& first, const Curve& second, const Curve& reference, const Curve& test,
                      SumRange range) {
  const auto xyz_of = [range](const Curve& light, const Curve& reflectance) {
    return tristimulus(light, reflectance, Observer::cie1931, range);
  };
  const auto lab = [&](const XYZ& xyz, const Curve& light) {
    return xyz_to_lab(xyz, xyz_of(light, Curve(1)));
  };
  const XYZ first_xyz = xyz_of(reference, first);
  const XYZ second_xyz = xyz_of(reference, second);
  XYZ corrected = xyz_of(test, second);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(second_xyz[i] > 0))
      throw Error(ErrorCode::input, "metamerism", "a reflectance is black in the reference light");
    corrected[i] *= first_xyz[i] / second_xyz[i];
  }
  const Lab here = lab(xyz_of(test, first), test);
  const Lab there = lab(corrected, test);
  return {delta_e_76(lab(first_xyz, reference), lab(second_xyz, reference)), delta_e_76(here, there),
          delta_e_2000(here, there)};
}

std::optional<ColorFidelity> color_fidelity(const Curve& light, SumRange range) {
  const auto temperature = color_temperature(tristimulus(light, Curve(1), Observer::cie1931, range));
  if (!temperature || temperature->kelvin > kHottestDaylight) return std::nullopt;
  const Colors test = colors_under(light, range);
  const Colors reference = colors_under(fidelity_reference(temperature->kelvin, range), range);
  ColorFidelity result;
  double total = 0;
  for (std::size_t i = 0; i < test.size(); ++i) {
    const double difference = distance_between(test[i], reference[i]);
    result.samples.push_back(fidelity_of(difference));
    total += difference;
  }
  result.fidelity = fidelity_of(total / static_cast<double>(test.size()));
  result.bins = binned(test, reference);
  result.gamut = 100 * area(result.bins, &HueBin::test) / area(result.bins, &HueBin::reference);
  return result;
}

}  // namespace abbe
