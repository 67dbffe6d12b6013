#include <cmath>
#include <limits>
#include <numbers>

#include "calibration/metrics/appearance.h"
#include "calibration/metrics/color_rendering.h"
#include "calibration/metrics/reference_light.h"
#include "spectral/chart.h"
#include "spectral/color_temperature.h"

namespace abbe {
namespace {

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
