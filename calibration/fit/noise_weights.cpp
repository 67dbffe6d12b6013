#include "calibration/fit/noise_weights.h"

#include <numeric>

#include "calibration/chart/delta_e.h"
#include "calibration/fit/correction_fit.h"

namespace abbe {
namespace {

// Mean of values with the given weights; the plain mean if there are none.
double weighted_mean(const std::vector<double>& values, const std::vector<double>& weights) {
  if (weights.empty())
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0) /
         std::accumulate(weights.begin(), weights.end(), 0.0);
}

// Weights t^2/(t^2 + s^2) under the least-squares matrix of the present weights. The variance s^2 adds up
// the squared colour shifts of one deviation in each channel.
std::vector<double> weights_under(const PatchColors& colors, std::span<const Raw> deviations) {
  const ColorCorrection correction = white_preserving_least_squares(colors);
  const double typical = weighted_mean(patch_errors(colors, correction).delta_e, colors.weights);
  std::vector<double> weights;
  for (std::size_t i = 0; i < colors.raw.size(); ++i) {
    const auto lab = [&](const Raw& raw) { return xyz_to_lab(correction(raw), colors.white); };
    const Lab lab_of_patch = lab(colors.raw[i]);
    double variance = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      Raw moved = colors.raw[i];
      moved[k] += deviations[i][k];
      const double shift = delta_e_2000(lab_of_patch, lab(moved));
      variance += shift * shift;
    }
    weights.push_back(typical > 0 ? typical * typical / (typical * typical + variance) : 1);
  }
  return weights;
}

}  // namespace

std::vector<double> noise_weights(const PatchColors& colors, std::span<const Raw> deviations) {
  // The first matrix may follow the noise, so the weights are refined by fitting again with them.
  constexpr int kPasses = 3;
  PatchColors weighted = colors;
  for (int pass = 0; pass < kPasses; ++pass) weighted.weights = weights_under(weighted, deviations);
  return weighted.weights;
}

}  // namespace abbe
