#include "calibration/fit/resampling.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {
namespace {

constexpr double kTail = 0.025;  // on either side of a 95 % interval
// The patches left in are nearly all of them, so the least-squares start alone finds the minimum that many
// starts found for the whole chart.
constexpr int kStarts = 2;

// The patches of these numbers, in their order and as often.
PatchColors selection(const PatchColors& colors, const std::vector<std::size_t>& numbers) {
  PatchColors some{{}, {}, {}, colors.white};
  for (const std::size_t i : numbers) {
    some.names.push_back(colors.names[i]);
    some.raw.push_back(colors.raw[i]);
    some.xyz.push_back(colors.xyz[i]);
  }
  return some;
}

// As many as there are, drawn with replacement.
std::vector<std::size_t> drawn(std::size_t count, std::mt19937_64& random) {
  std::uniform_int_distribution<std::size_t> any(0, count - 1);
  std::vector<std::size_t> numbers(count);
  for (std::size_t& i : numbers) i = any(random);
  return numbers;
}

Interval percentiles(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(std::lround(share * static_cast<double>(values.size() - 1)))];
  };
  return {at(kTail), at(1 - kTail)};
}

}  // namespace

PatchErrors cross_validate(const PatchColors& colors, const CorrectionOptions& options, std::size_t folds) {
  const std::size_t count = colors.raw.size();
  if (folds < 2 || folds > count)
    throw Error(ErrorCode::usage, "--folds",
                fmt::format("got {}, allowed 2 to the {} patches", folds, count));
  CorrectionOptions how = options;
  how.starts = std::min(how.starts, kStarts);
  PatchErrors unseen;
  unseen.delta_e.resize(count);
  for (std::size_t fold = 0; fold < folds; ++fold) {
    std::vector<std::size_t> rest;
    std::vector<std::size_t> left_out;
    for (std::size_t i = 0; i < count; ++i) (i % folds == fold ? left_out : rest).push_back(i);
    const ColorCorrection correction = fit_correction(selection(colors, rest), how).correction;
    const PatchErrors errors = patch_errors(selection(colors, left_out), correction);
    for (std::size_t j = 0; j < left_out.size(); ++j) unseen.delta_e[left_out[j]] = errors.delta_e[j];
    const double share = static_cast<double>(errors.delta_e.size()) / static_cast<double>(count);
    unseen.mean += errors.mean * share;
    unseen.mean_76 += errors.mean_76 * share;
    unseen.max = std::max(unseen.max, errors.max);
  }
  return unseen;
}

Interval bootstrap_mean(std::span<const double> values, const BootstrapOptions& options) {
  std::mt19937_64 random(options.seed);
  std::vector<double> means(static_cast<std::size_t>(options.replicates));
  for (double& mean : means) {
    for (const std::size_t i : drawn(values.size(), random)) mean += values[i];
    mean /= static_cast<double>(values.size());
  }
  return percentiles(std::move(means));
}

std::vector<std::array<Interval, 3>> bootstrap_columns(const PatchColors& colors,
                                                       const CorrectionOptions& how,
                                                       const BootstrapOptions& options) {
  CorrectionOptions once = how;
  once.starts = std::min(how.starts, kStarts);
  const std::size_t terms = term_count(how.model);
  std::vector<std::array<std::vector<double>, 3>> values(terms);
  std::mt19937_64 random(options.seed);
  int failures = 0;
  for (int done = 0; done < options.replicates;) {
    try {
      const ColorCorrection fit =
          fit_correction(selection(colors, drawn(colors.raw.size(), random)), once).correction;
      for (std::size_t t = 0; t < terms; ++t)
        for (std::size_t i = 0; i < 3; ++i) values[t][i].push_back(fit.columns[t][i]);
      ++done;
    } catch (const Error&) {
      if (++failures > options.replicates) throw;
    }
  }
  std::vector<std::array<Interval, 3>> intervals(terms);
  for (std::size_t t = 0; t < terms; ++t)
    for (std::size_t i = 0; i < 3; ++i) intervals[t][i] = percentiles(std::move(values[t][i]));
  return intervals;
}

}  // namespace abbe
