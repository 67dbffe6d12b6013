#include "calibration/fit/response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <ceres/ceres.h>
#include <fmt/format.h>

#include "calibration/fit/response_model.h"
#include "io/error.h"

namespace abbe {
namespace {

constexpr std::size_t kCoefficients = ResponseModel<double>::kCoefficients;
constexpr double kFirstScale =
    0.01;  // Cauchy scale of the first pass: code errors beyond 1 % of full scale count ever less
constexpr double kScaleOfMedian = 4;  // of the second pass, in median residuals of the first
constexpr double kSmallestScale = 3e-4;
constexpr double kRoughness = 1e-3;  // weight of second differences of theta
constexpr double kSlopeDrift =
    1e-5;  // weight of first differences, which carries the slope on where no sample lies
constexpr std::size_t kMinSamples = 32;

struct Sample {
  std::size_t patch;
  double code;
  double log_time;
};

// Black and clipped codes say nothing of the exposure.
std::vector<Sample> usable_samples(const ExposureSeries& series) {
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < series.codes.size(); ++i)
    for (std::size_t j = 0; j < series.times_s.size(); ++j) {
      const double code = series.codes[i][j];
      if (code > 0 && code < 1) samples.push_back({i, code, std::log(series.times_s[j])});
    }
  return samples;
}

struct SampleResidual {
  Sample sample;
  double weight;

  template <typename T>
  bool operator()(const T* theta, const T* log_exposure, T* residual) const {
    residual[0] = weight * (ResponseModel<T>(theta)(sample.code) - log_exposure[0] - sample.log_time);
    return true;
  }
};

struct Smoothness {
  template <typename T>
  bool operator()(const T* theta, T* residual) const {
    for (std::size_t k = 0; k + 2 < kCoefficients; ++k)
      residual[k] = kRoughness * (theta[k] - 2.0 * theta[k + 1] + theta[k + 2]);
    for (std::size_t k = 0; k + 1 < kCoefficients; ++k)
      residual[kCoefficients - 2 + k] = kSlopeDrift * (theta[k + 1] - theta[k]);
    return true;
  }
};
constexpr int kSmoothnessTerms = static_cast<int>(2 * kCoefficients - 3);

struct Unknowns {
  std::array<double, kCoefficients> theta{};
  std::vector<double> log_exposure;  // one per patch
};

// A straight line in the curve's coordinate, and the patches where it puts them.
Unknowns start(const std::vector<Sample>& samples, std::size_t patches) {
  Unknowns unknowns;
  unknowns.log_exposure.assign(patches, 0.0);
  std::vector<int> counts(patches, 0);
  const ResponseModel<double> model(unknowns.theta.data());
  for (const Sample& s : samples) {
    unknowns.log_exposure[s.patch] += model(s.code) - s.log_time;
    ++counts[s.patch];
  }
  for (std::size_t i = 0; i < patches; ++i) unknowns.log_exposure[i] /= std::max(1, counts[i]);
  return unknowns;
}

void require(bool condition, const std::string& message) {
  if (!condition) throw Error(ErrorCode::input, "response fit", message);
}

ceres::Solver::Summary converge(const std::vector<Sample>& samples, double scale, Unknowns& unknowns) {
  ceres::Problem problem;
  for (const Sample& s : samples) {
    auto residual =
        std::make_unique<SampleResidual>(SampleResidual{s, ResponseModel<double>::sensitivity(s.code)});
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<SampleResidual, 1, kCoefficients, 1>(residual.release()),
        new ceres::CauchyLoss(scale), unknowns.theta.data(), &unknowns.log_exposure[s.patch]);
  }
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<Smoothness, kSmoothnessTerms, kCoefficients>(new Smoothness), nullptr,
      unknowns.theta.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 300;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-10;
  options.gradient_tolerance = 1e-14;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  require(summary.IsSolutionUsable() && summary.termination_type == ceres::CONVERGENCE &&
              std::isfinite(summary.final_cost),
          "the solver did not converge: " + summary.BriefReport());
  return summary;
}

// Absolute residuals, as code values.
std::vector<double> residuals(const std::vector<Sample>& samples, const Unknowns& unknowns) {
  const ResponseModel<double> model(unknowns.theta.data());
  std::vector<double> sizes;
  for (const Sample& s : samples) {
    const double r = model(s.code) - unknowns.log_exposure[s.patch] - s.log_time;
    sizes.push_back(std::abs(r) * ResponseModel<double>::sensitivity(s.code));
  }
  return sizes;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<double> tabulate(const Unknowns& unknowns, std::size_t size) {
  const ResponseModel<double> model(unknowns.theta.data());
  const double full_scale = model(1.0);
  std::vector<double> table(size, 0.0);
  for (std::size_t i = 1; i < size; ++i)
    table[i] = std::exp(model(static_cast<double>(i) / static_cast<double>(size - 1)) - full_scale);
  return table;
}

}  // namespace

ResponseFit recover_response(const ExposureSeries& series, std::size_t table_size) {
  require(series.times_s.size() >= 2,
          fmt::format("an exposure series needs two times or more (got {})", series.times_s.size()));
  require(std::all_of(series.times_s.begin(), series.times_s.end(),
                      [](double t) { return t > 0 && std::isfinite(t); }),
          "exposure times must be positive");
  const std::vector<Sample> samples = usable_samples(series);
  require(samples.size() >= kMinSamples,
          fmt::format("only {} code values are neither black nor clipped (needed {})", samples.size(),
                      kMinSamples));
  Unknowns unknowns = start(samples, series.codes.size());
  const ceres::Solver::Summary first = converge(samples, kFirstScale, unknowns);
  const double scale = kScaleOfMedian * median(residuals(samples, unknowns));
  const ceres::Solver::Summary second =
      converge(samples, std::clamp(scale, kSmallestScale, kFirstScale), unknowns);
  ResponseFit fit;
  fit.linear = tabulate(unknowns, table_size);
  fit.initial_cost = second.initial_cost;
  fit.final_cost = second.final_cost;
  fit.median_code = median(residuals(samples, unknowns));
  fit.samples = samples.size();
  fit.iterations = static_cast<int>(first.iterations.size() + second.iterations.size());
  require(std::is_sorted(fit.linear.begin(), fit.linear.end(), std::less_equal<>()) &&
              std::isfinite(fit.linear.back()),
          "the recovered curve does not rise strictly");
  return fit;
}

double linearise(const std::vector<double>& table, double code) {
  const double x = std::clamp(code, 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), table.size() - 2);
  return std::lerp(table[i], table[i + 1], x - static_cast<double>(i));
}

}  // namespace abbe
