#include "calibration/fit/response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

#include <ceres/ceres.h>
#include <fmt/format.h>
#include <glog/logging.h>

#include "calibration/fit/resampling.h"
#include "calibration/fit/response_problem.h"
#include "io/error.h"
#include "sensor/film/patch.h"

namespace abbe {
namespace {

constexpr std::size_t kCoefficients = ResponseModel<double>::kCoefficients;
constexpr double kFirstScale =
    0.01;  // of the first pass: code errors above 1 % of full scale have less and less weight
constexpr double kFirstRoughness = 1;
constexpr double kCauchy = 2.385;  // in standard deviations: 95 % efficient for Gaussian errors [Holland1977]
constexpr double kMinDeviation = 2e-5;  // of a code; a lower limit even for exact values
constexpr std::size_t kMinSamples = 32;
constexpr double kDeviationsOf95 = 1.96;  // half-width of a Gaussian 95 % interval
constexpr double kMadToDeviation = 1.4826;
constexpr std::size_t kGroups = 12;
constexpr std::size_t kMinGroupSize = 32;  // gives the deviation to about a seventh
constexpr double kMinSpan = 1.02;
constexpr std::size_t kTableSize = 4096;
constexpr double kMinFall = 0.01;                 // relative fall of a code
constexpr double kMaxUncertainty = 0.1;           // relative to the exposure of the highest code
constexpr double kMaxFullScaleUncertainty = 0.5;  // relative to full scale, outside the codes

double code_of_entry(std::size_t i) {
  return static_cast<double>(i) / static_cast<double>(kTableSize - 1);
}

void require_for_response(bool condition, const std::string& message) {
  if (!condition) throw Error(ErrorCode::input, "response fit", message);
}

// Ratios of the codes at two times, of the patches that are neither black nor clipped.
std::vector<double> ratios(const ExposureSeries& series, std::size_t from, std::size_t to) {
  const auto is_usable = [](double code) { return code > 0 && code < 1; };
  std::vector<double> all;
  for (const std::vector<double>& codes : series.codes)
    if (is_usable(codes[from]) && is_usable(codes[to])) all.push_back(codes[to] / codes[from]);
  return all;
}

void require_rise(const ExposureSeries& series, std::size_t from, std::size_t to) {
  constexpr std::size_t kMinPatches = 4;
  const std::vector<double> code_ratios = ratios(series, from, to);
  if (code_ratios.size() < kMinPatches) return;
  const auto falling = std::ranges::count_if(code_ratios, [](double ratio) { return ratio < 1; });
  const double fall = 1 - median(code_ratios);
  require_for_response(
      4 * falling < static_cast<std::ptrdiff_t>(3 * code_ratios.size()) || fall < kMinFall,
      fmt::format("the codes fall by {:.2g} % (median of {} patches) from the photograph of {:.6g} s to that "
                  "of {:.6g} s: are exposure times swapped, or did the light change?",
                  100 * fall, code_ratios.size(), series.times_s[from], series.times_s[to]));
}

// Throws Error{input} unless
// - the series has two times or more, all positive, and the longest is at least 1.02 times the shortest;
// - codes do not fall as time grows.
//
// Codes fall if three patches in four are darker at the next longer time and the median over the patches is
// lower by 1 % or more.
void require_usable_times(const ExposureSeries& series) {
  const std::vector<double>& times = series.times_s;
  require_for_response(times.size() >= 2,
                       fmt::format("an exposure series needs two times or more (got {})", times.size()));
  require_for_response(std::ranges::all_of(times, [](double t) { return t > 0 && std::isfinite(t); }),
                       "exposure times must be positive");
  std::vector<std::size_t> order(times.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return times[i]; });
  const double span = times[order.back()] / times[order.front()];
  require_for_response(span >= kMinSpan,
                       fmt::format("the exposure times do not determine the curve: the longest is {:.6g} "
                                   "times the shortest (allowed from {} on, 2 is better)",
                                   span, kMinSpan));
  for (std::size_t i = 0; i + 1 < order.size(); ++i)
    if (times[order[i]] < times[order[i + 1]]) require_rise(series, order[i], order[i + 1]);
}

// Half the width of the 95 % interval of the exposure of a code in [0, 1], as a fraction of full scale.
double half_width_95(const ResponseFit& fit, double code) {
  return kDeviationsOf95 * linearise(fit.log_deviation, code) * linearise(fit.linear, code);
}

// Throws Error{input} unless the samples of a fit, at least one, determine its curve. Between their lowest
// and highest code, the 95 % interval must extend less than a tenth of the highest code's exposure to either
// side. Outside, it must extend less than half of full scale.
void require_determined(const ResponseFit& fit, std::span<const ResponseSample> samples) {
  const auto [lowest, highest] = std::ranges::minmax_element(samples, {}, &ResponseSample::code);
  const double brightest = linearise(fit.linear, highest->code);
  double uncertainty = 0;
  double at = 0;
  constexpr int kSteps = 100;
  for (int i = 0; i <= kSteps; ++i) {
    const double code = std::lerp(lowest->code, highest->code, static_cast<double>(i) / kSteps);
    const double half_width = half_width_95(fit, code) / brightest;
    if (half_width > uncertainty) {
      uncertainty = half_width;
      at = code;
    }
  }
  require_for_response(
      uncertainty < kMaxUncertainty,
      fmt::format("these exposures do not determine the curve: of the codes {:.3g} to {:.3g} the exposure of "
                  "{:.3g} is known to {:.2g} % of the brightest (allowed {:.2g} %); add exposure times, some "
                  "of them in a ratio of two",
                  lowest->code, highest->code, at, 100 * uncertainty, 100 * kMaxUncertainty));
  const double unknown = largest_uncertainty(fit);
  require_for_response(
      unknown < kMaxFullScaleUncertainty,
      fmt::format("no exposure determines the curve above code {:.3g}, where it is known to {:.2g} % of full "
                  "scale (allowed {:.2g} %): add longer exposures, until the brightest patches clip",
                  highest->code, 100 * unknown, 100 * kMaxFullScaleUncertainty));
}

// Standard deviation of Gaussian errors with these absolute values, of which there must be at least one. It
// is estimated from their median, which a few outliers hardly change.
double deviation_of(std::vector<double> sizes) {
  return kMadToDeviation * median(std::move(sizes));
}

// Median code of a group of neighbouring codes, with the standard deviation of its errors.
struct NoiseLevel {
  double code;
  double deviation;
};

// Noise of up to 12 groups of codes from dark to full scale, estimated from the absolute `errors` of a fit.
// Photon noise makes the errors of single pixels many times larger at bright codes than at dark ones. A fit
// that assumed equal errors would be far too certain of the bright end.
std::vector<NoiseLevel> noise_levels(std::span<const ResponseSample> samples,
                                     std::span<const double> errors) {
  std::vector<NoiseLevel> levels;
  std::vector<std::size_t> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return samples[i].code; });
  const std::size_t groups = std::clamp(samples.size() / kMinGroupSize, std::size_t{1}, kGroups);
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<double> codes;
    std::vector<double> sizes;
    for (std::size_t i = g * order.size() / groups; i < (g + 1) * order.size() / groups; ++i) {
      codes.push_back(samples[order[i]].code);
      sizes.push_back(errors[order[i]]);
    }
    levels.push_back({median(std::move(codes)), deviation_of(std::move(sizes))});
  }
  return levels;
}

// Standard deviation of a code in [0, 1]: linear between the groups, constant outside them.
double deviation_at(const std::vector<NoiseLevel>& levels, double code) {
  const auto above = std::ranges::upper_bound(levels, code, {}, &NoiseLevel::code);
  if (above == levels.begin()) return levels.front().deviation;
  if (above == levels.end()) return levels.back().deviation;
  const NoiseLevel& below = *(above - 1);
  return std::lerp(below.deviation, above->deviation, (code - below.code) / (above->code - below.code));
}

// Start of the fit: a straight line in the curve's coordinate, and the exposures of the patches that follow
// from it.
ResponseUnknowns start(const std::vector<ResponseSample>& samples, std::size_t patches) {
  ResponseUnknowns unknowns;
  unknowns.log_exposure.assign(patches, 0.0);
  std::vector<int> counts(patches, 0);
  const ResponseModel<double> model = unknowns.model();
  for (const ResponseSample& s : samples) {
    unknowns.log_exposure[s.patch] += model(s.code) - s.log_time;
    ++counts[s.patch];
  }
  for (std::size_t i = 0; i < patches; ++i) unknowns.log_exposure[i] /= std::max(1, counts[i]);
  return unknowns;
}

// Silences Ceres, because the thrown errors contain its messages.
struct QuietLibrary {
  int before = std::exchange(FLAGS_minloglevel, google::GLOG_FATAL);

  QuietLibrary() = default;
  QuietLibrary(const QuietLibrary&) = delete;
  QuietLibrary& operator=(const QuietLibrary&) = delete;
  ~QuietLibrary() { FLAGS_minloglevel = before; }
};

// Minimises the cost from `unknowns`, which receive the solution.
ceres::Solver::Summary converge(const WeightedSamples& data, double roughness, int max_iterations,
                                ResponseUnknowns& unknowns) {
  const auto problem = all_terms(data, roughness, unknowns);
  const QuietLibrary quiet;
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-12;
  options.parameter_tolerance = 1e-10;
  options.gradient_tolerance = 1e-14;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem.get(), &summary);
  require_for_response(summary.IsSolutionUsable() && summary.termination_type == ceres::CONVERGENCE &&
                           std::isfinite(summary.final_cost),
                       fmt::format("no curve fits these codes (gave up after {} iterations): do the exposure "
                                   "times belong to the photographs, and did nothing move between them?",
                                   summary.iterations.size()));
  return summary;
}

std::vector<double> code_errors(const std::vector<ResponseSample>& samples,
                                const ResponseUnknowns& unknowns) {
  const ResponseModel<double> model = unknowns.model();
  std::vector<double> sizes;
  for (const ResponseSample& s : samples)
    sizes.push_back(std::abs(model(s.code) - unknowns.log_exposure[s.patch] - s.log_time) /
                    model.slope(s.code));
  return sizes;
}

// Code that the curve predicts for a sample, by bisection.
double predicted_code(const ResponseUnknowns& unknowns, const ResponseSample& s) {
  const ResponseModel<double> model = unknowns.model();
  const double target = unknowns.log_exposure[s.patch] + s.log_time;
  double low = 0;
  double high = 1;
  for (int i = 0; i < 40; ++i) {
    const double center = (low + high) / 2;
    (model(center) < target ? low : high) = center;
  }
  return target > model(1) ? 1 : (low + high) / 2;
}

// Ratio of the errors to their stated deviations, estimated robustly against a few outliers.
double noise_scale(const std::vector<ResponseSample>& samples, const ResponseUnknowns& unknowns,
                   std::size_t unknown_count) {
  std::vector<double> sizes = code_errors(samples, unknowns);
  for (std::size_t i = 0; i < sizes.size(); ++i) sizes[i] /= samples[i].deviation;
  const double count = static_cast<double>(samples.size());
  return deviation_of(std::move(sizes)) *
         std::sqrt(count / std::max(1.0, count - static_cast<double>(unknown_count)));
}

// Sets the unknown deviations of samples to those of the residuals at similar codes.
void estimate_deviations(std::vector<ResponseSample>& samples, WeightedSamples& fitted,
                         const ResponseUnknowns& unknowns) {
  const std::vector<NoiseLevel> noise = noise_levels(fitted.samples, code_errors(fitted.samples, unknowns));
  for (std::vector<ResponseSample>* const list : {&samples, &fitted.samples})
    for (ResponseSample& s : *list)
      s.deviation = std::max(kMinDeviation, deviation_at(noise, predicted_code(unknowns, s)));
}

// Samples that noise cannot have clipped, with weights 1/(s g') for a code deviation s and the slope g' of
// the curve.
WeightedSamples weigh(const std::vector<ResponseSample>& all, const ResponseUnknowns& unknowns,
                      double scale) {
  WeightedSamples data{{}, {}, kCauchy};
  const ResponseModel<double> model = unknowns.model();
  for (const ResponseSample& s : all) {
    const double deviation = std::max(kMinDeviation, scale * s.deviation);
    // Select by the predicted code: a selection by the noisy code itself would be biased.
    const double expected = predicted_code(unknowns, s);
    if (!within_margins(expected, deviation)) continue;
    data.samples.push_back(s);
    data.weights.push_back(1 / (deviation * model.slope(std::clamp(expected, 1e-9, 1.0))));
  }
  return data;
}

// Standard deviation of ln exposure relative to mid-scale, from the covariance of the coefficients.
std::vector<double> log_deviations(const WeightedSamples& data, double roughness,
                                   ResponseUnknowns& unknowns) {
  const auto problem = all_terms(data, roughness, unknowns);
  const QuietLibrary quiet;
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  // without samples, only the smoothness determines the curve
  options.min_reciprocal_condition_number = 1e-20;
  ceres::Covariance covariance(options);
  const double* theta = unknowns.theta.data();
  const std::vector<std::pair<const double*, const double*>> blocks{{theta, theta}};
  require_for_response(
      covariance.Compute(blocks, problem.get()),
      "the codes do not determine the curve: more exposures, or patches of other brightness, are needed");
  constexpr auto kSize = static_cast<int>(kCoefficients);
  Eigen::Matrix<double, kSize, kSize, Eigen::RowMajor> c;
  covariance.GetCovarianceBlock(theta, theta, c.data());
  using Jet = ceres::Jet<double, kSize>;
  std::array<Jet, kCoefficients> dual;
  for (int k = 0; k < kSize; ++k) dual[static_cast<std::size_t>(k)] = Jet(theta[k], k);
  const ResponseModel<Jet> model(dual.data());
  std::vector<double> deviations(kTableSize, 0.0);
  for (std::size_t i = 1; i < kTableSize; ++i) {
    const auto gradient = model(code_of_entry(i)).v;
    deviations[i] = std::sqrt(std::max(0.0, gradient.dot(c * gradient)));
  }
  return deviations;
}

std::vector<double> tabulate(const ResponseUnknowns& unknowns) {
  const ResponseModel<double> model = unknowns.model();
  const double full_scale = model(1.0);
  std::vector<double> table(kTableSize, 0.0);
  for (std::size_t i = 1; i < kTableSize; ++i) table[i] = std::exp(model(code_of_entry(i)) - full_scale);
  return table;
}

struct SampleError {
  double code;          // predicted by the curve, since outliers move from dense codes to sparse ones
  double deviations;    // error of the code in standard deviations
  double log_exposure;  // absolute
  double exposure;      // as a fraction of full scale
};

std::vector<SampleError> sample_errors(const std::vector<ResponseSample>& samples,
                                       const ResponseUnknowns& unknowns, double scale) {
  const std::vector<double> errors = code_errors(samples, unknowns);
  const ResponseModel<double> model = unknowns.model();
  const double full_scale = model(1.0);
  std::vector<SampleError> all;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double code = predicted_code(unknowns, samples[i]);
    const double log_exposure = errors[i] * model.slope(samples[i].code);
    all.push_back({code, errors[i] / std::max(kMinDeviation, scale * samples[i].deviation), log_exposure,
                   log_exposure * std::exp(model(code) - full_scale)});
  }
  std::ranges::sort(all, {}, &SampleError::code);
  return all;
}

constexpr double kOff = 6;          // minimum error, in standard deviations, of a code off the curve
constexpr std::size_t kWindow = 9;  // number of neighbouring codes
constexpr std::size_t kMinOff = 3;  // minimum number of these off the curve

// True if outliers as frequent as elsewhere would hardly ever put `off` codes off the curve in any of
// `windows` windows. The probability follows the binomial law. Its rate is that of the other codes by
// Laplace's rule of succession.
bool is_cluster(std::size_t off, std::size_t off_elsewhere, std::size_t elsewhere, std::size_t windows) {
  constexpr double kSignificance = 0.01;  // over all windows
  const double rate = (static_cast<double>(off_elsewhere) + 1) / (static_cast<double>(elsewhere) + 2);
  double term = std::pow(1 - rate, static_cast<double>(kWindow));  // probability of k codes off
  double fewer = 0;
  for (std::size_t k = 0; k < off; ++k) {
    fewer += term;
    term *= static_cast<double>(kWindow - k) / static_cast<double>(k + 1) * rate / (1 - rate);
  }
  return off >= kMinOff && (1 - fewer) * static_cast<double>(windows) < kSignificance;
}

// Range of neighbouring samples of which significantly more are off the curve than elsewhere, so that they
// are not outliers. If the curve is too smooth for the codes, the loss treats some of them as outliers.
std::optional<ResponseMisfit> misfit_of(const std::vector<SampleError>& errors) {
  constexpr double kNegligible = 0.002;  // of full scale
  const auto all_off = static_cast<std::size_t>(
      std::ranges::count_if(errors, [](const SampleError& e) { return e.deviations > kOff; }));
  std::optional<ResponseMisfit> misfit;
  for (std::size_t first = 0; first + kWindow <= errors.size(); ++first) {
    std::vector<double> off;
    std::vector<double> log_off;
    for (std::size_t i = first; i < first + kWindow; ++i) {
      if (errors[i].deviations <= kOff) continue;
      off.push_back(errors[i].exposure);
      log_off.push_back(errors[i].log_exposure);
    }
    if (!is_cluster(off.size(), all_off - off.size(), errors.size() - kWindow, errors.size() - kWindow + 1))
      continue;
    const double exposure = median(std::move(off));
    if (exposure < kNegligible) continue;
    if (!misfit) misfit = {errors[first].code, 0, 0, 0};
    const bool is_last = first + kWindow == errors.size();  // no code determines the curve above
    misfit->high_code = is_last ? 1 : errors[first + kWindow - 1].code;
    misfit->exposure = std::max(misfit->exposure, exposure);
    misfit->log_exposure = std::max(misfit->log_exposure, median(std::move(log_off)));
  }
  return misfit;
}

void widen(std::vector<double>& log_deviation, const ResponseMisfit& misfit) {
  for (std::size_t i = 0; i < kTableSize; ++i)
    if (code_of_entry(i) >= misfit.low_code && code_of_entry(i) <= misfit.high_code)
      log_deviation[i] = std::hypot(log_deviation[i], misfit.log_exposure);
}

void require_samples(const std::vector<ResponseSample>& samples) {
  require_for_response(
      samples.size() >= kMinSamples,
      fmt::format(
          "only {} code values are neither black nor clipped (needed {}): a region counts as black or "
          "clipped if more than {:g} % of its pixels are, such as one defective pixel in fewer than {:.0f}",
          samples.size(), kMinSamples, 100 * kMaxDefectiveFraction, 1 / kMaxDefectiveFraction));
}

// Weights of the first pass, in which neither slopes nor error sizes are known.
WeightedSamples first_weights(const std::vector<ResponseSample>& samples) {
  WeightedSamples data{samples, {}, 1};
  for (const ResponseSample& s : samples)
    data.weights.push_back(ResponseModel<double>::sensitivity(s.code) / kFirstScale);
  return data;
}

}  // namespace

ResponseFit recover_response(const ExposureSeries& series, int max_iterations) {
  require_usable_times(series);
  std::vector<ResponseSample> samples = usable_samples(series, false);
  WeightedSamples data = first_weights(usable_samples(series, true));
  require_samples(data.samples);
  ResponseUnknowns unknowns = start(data.samples, series.codes.size());
  ceres::Solver::Summary summary = converge(data, kFirstRoughness, max_iterations, unknowns);
  ResponseFit fit;
  fit.iterations = static_cast<int>(summary.iterations.size());
  const std::size_t unknown_count = kCoefficients + series.codes.size();
  for (int pass = 0; pass < 2; ++pass) {
    if (series.deviations.empty()) estimate_deviations(samples, data, unknowns);
    fit.noise_scale = noise_scale(data.samples, unknowns, unknown_count);
    data = weigh(samples, unknowns, fit.noise_scale);
    require_samples(data.samples);
    fit.roughness = choose_roughness(data, unknowns);

    summary = converge(data, fit.roughness, max_iterations, unknowns);
    fit.iterations += static_cast<int>(summary.iterations.size());
  }
  fit.linear = tabulate(unknowns);
  fit.log_deviation = log_deviations(data, fit.roughness, unknowns);
  fit.initial_cost = summary.initial_cost;
  fit.final_cost = summary.final_cost;
  fit.median_code = median(code_errors(data.samples, unknowns));
  fit.samples = data.samples.size();
  if (!series.deviations.empty())
    fit.misfit = misfit_of(sample_errors(data.samples, unknowns, fit.noise_scale));
  if (fit.misfit) widen(fit.log_deviation, *fit.misfit);
  require_for_response(std::is_sorted(fit.linear.begin(), fit.linear.end(), std::less_equal<>()) &&
                           std::isfinite(fit.linear.back()),
                       "the curve that fits these codes does not rise everywhere: do the exposure times "
                       "belong to the photographs, and are there enough of them?");
  require_determined(fit, data.samples);
  return fit;
}

std::pair<double, double> bounds_95(const ResponseFit& fit, std::size_t i) {
  const double factor = std::exp(kDeviationsOf95 * fit.log_deviation[i]);
  return {fit.linear[i] / factor, fit.linear[i] * factor};
}

double largest_uncertainty(const ResponseFit& fit) {
  double largest = 0;
  for (int percent = 1; percent < 100; ++percent)
    largest = std::max(largest, half_width_95(fit, percent / 100.0));
  return largest;
}

double linearise(const std::vector<double>& table, double code) {
  const double x = std::clamp(code, 0.0, 1.0) * static_cast<double>(table.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(x), table.size() - 2);
  return std::lerp(table[i], table[i + 1], x - static_cast<double>(i));
}

double linearise_deviation(const std::vector<double>& table, double code, double deviation) {
  const double low = std::clamp(code - deviation, 0.0, 1.0);
  const double high = std::clamp(code + deviation, 0.0, 1.0);
  return high > low ? deviation * (linearise(table, high) - linearise(table, low)) / (high - low) : 0;
}

}  // namespace abbe
