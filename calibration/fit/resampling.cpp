#include "calibration/fit/resampling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {
namespace {

constexpr double kTail = 0.025;  // probability on either side of a 95 % interval
// Nearly all patches remain, so the least-squares start alone finds the minimum that many starts find for the
// whole chart.
constexpr int kStarts = 2;
constexpr std::uint64_t kSeed = 1;  // of the draws

PatchColors selection(const PatchColors& colors, const std::vector<std::size_t>& indices) {
  PatchColors some;
  some.white = colors.white;
  for (const std::size_t i : indices) {
    some.names.push_back(colors.names[i]);
    some.raw.push_back(colors.raw[i]);
    some.xyz.push_back(colors.xyz[i]);
    if (!colors.weights.empty()) some.weights.push_back(colors.weights[i]);
  }
  return some;
}

// Draws as many indices with replacement.
std::vector<std::size_t> draw_indices(std::size_t count, std::mt19937_64& random) {
  std::uniform_int_distribution<std::size_t> any(0, count - 1);
  std::vector<std::size_t> indices(count);
  for (std::size_t& i : indices) i = any(random);
  return indices;
}

Interval percentiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double fraction) {
    return values[static_cast<std::size_t>(std::lround(fraction * static_cast<double>(values.size() - 1)))];
  };
  return {at(kTail), at(1 - kTail)};
}

}  // namespace

double median(std::vector<double> values) {
  const auto center = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), center, values.end());
  if (values.size() % 2 == 1) return *center;
  return (*std::max_element(values.begin(), center) + *center) / 2;
}

std::vector<ModelCandidate> cross_validate_models(const PatchColors& colors, const CorrectionOptions& options,
                                                  std::size_t folds) {
  constexpr std::size_t kMaxFolds = 24;
  const std::size_t groups = folds > 0 ? folds : std::min(colors.raw.size(), kMaxFolds);
  std::vector<ModelCandidate> candidates;
  for (const CorrectionModel model :
       {CorrectionModel::linear, CorrectionModel::root_polynomial_2, CorrectionModel::root_polynomial_3}) {
    if (!are_enough_patches(model, colors.raw.size())) continue;
    CorrectionOptions how = options;
    how.model = model;
    candidates.push_back({model, cross_validate(colors, how, groups).mean});
  }
  // A simpler model is preferred if the difference is invisible.
  constexpr double kInvisible = 0.01;
  const double limit =
      std::ranges::min(candidates, {}, &ModelCandidate::unseen_mean).unseen_mean + kInvisible;
  const auto chosen =
      std::ranges::find_if(candidates, [&](const ModelCandidate& c) { return c.unseen_mean <= limit; });
  std::rotate(candidates.begin(), chosen, chosen + 1);
  std::ranges::sort(candidates.begin() + 1, candidates.end(), {}, &ModelCandidate::unseen_mean);
  return candidates;
}

PatchErrors cross_validate(const PatchColors& colors, const CorrectionOptions& options, std::size_t folds) {
  const std::size_t count = colors.raw.size();
  if (folds < 2 || folds > count)
    throw Error(ErrorCode::usage, "--folds",
                fmt::format("got {}, allowed 2 to the {} patches", folds, count));
  CorrectionOptions how = options;
  how.starts = std::min(how.starts, kStarts);
  PatchErrors unseen;
  unseen.delta_e.resize(count);
  unseen.delta_e_76.resize(count);
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<std::size_t> rest;
    std::vector<std::size_t> left_out;
    for (std::size_t i = 0; i < count; ++i) (i % folds == fold ? left_out : rest).push_back(i);
    const ColorCorrection correction = fit_correction(selection(colors, rest), how).correction;
    const PatchErrors errors = patch_errors(selection(colors, left_out), correction);
    for (std::size_t j = 0; j < left_out.size(); ++j) {
      unseen.delta_e[left_out[j]] = errors.delta_e[j];
      unseen.delta_e_76[left_out[j]] = errors.delta_e_76[j];
    }
    const double fraction = static_cast<double>(errors.delta_e.size()) / static_cast<double>(count);
    unseen.mean += errors.mean * fraction;
    unseen.mean_76 += errors.mean_76 * fraction;
    unseen.max = std::max(unseen.max, errors.max);
  }
  return unseen;
}

Interval bootstrap_mean(std::span<const double> values, int draws) {
  std::mt19937_64 random(kSeed);
  std::vector<double> means(static_cast<std::size_t>(draws));
  for (double& mean : means) {
    for (const std::size_t i : draw_indices(values.size(), random)) mean += values[i];
    mean /= static_cast<double>(values.size());
  }
  return percentiles(std::move(means));
}

std::vector<std::array<Interval, 3>> bootstrap_columns(const PatchColors& colors,
                                                       const CorrectionOptions& how, int draws) {
  CorrectionOptions once = how;
  once.starts = std::min(how.starts, kStarts);
  const std::size_t terms = term_count(how.model);
  std::vector<std::array<std::vector<double>, 3>> values(terms);
  std::mt19937_64 random(kSeed);
  int failures = 0;
  for (int done = 0; done < draws;) {
    try {
      const ColorCorrection fit =
          fit_correction(selection(colors, draw_indices(colors.raw.size(), random)), once).correction;
      for (std::size_t t = 0; t < terms; ++t)
        for (std::size_t i = 0; i < 3; ++i) values[t][i].push_back(fit.columns[t][i]);
      ++done;
    } catch (const Error&) {
      if (++failures > draws) throw;
    }
  }
  std::vector<std::array<Interval, 3>> intervals(terms);
  for (std::size_t t = 0; t < terms; ++t)
    for (std::size_t i = 0; i < 3; ++i) intervals[t][i] = percentiles(std::move(values[t][i]));
  return intervals;
}

}  // namespace abbe
