#include "calibration/fit/correction.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>

#include <ceres/ceres.h>
#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "io/error.h"

namespace abbe {
namespace {

constexpr double kLossScale = 0.05;  // colour difference below which the loss turns quadratic
constexpr std::size_t kPatchesPerTerm = 4;
constexpr double kJitter = 0.1;  // standard deviation of a start's coefficients, in XYZ with Y = 1 for white
// Minimum difference of channels, relative to their largest value. A correction with coefficients above its
// inverse would amplify smaller differences, which are the rounding of float films (6e-8). Measured filters
// differ by 8e-4 and more, bands of 10 nm at a distance of 1 nm by 8e-5. In monochromatic light all channels
// and colours differ by almost nothing.
constexpr double kMinDifference = 1e-6;

// Columns of all terms but the last, whose column is the white minus their sum.
using Parameters = std::vector<double>;

ColorCorrection correction_of(CorrectionModel model, const Parameters& p, const XYZ& white) {
  ColorCorrection correction{model, std::vector<XYZ>(term_count(model))};
  XYZ rest = white;
  for (std::size_t t = 0; t + 1 < correction.columns.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      correction.columns[t][i] = p[3 * t + i];
      rest[i] -= p[3 * t + i];
    }
  correction.columns.back() = rest;
  return correction;
}

// Inverse of `correction_of`.
Parameters parameters_of(const ColorCorrection& correction) {
  Parameters p;
  for (std::size_t t = 0; t + 1 < correction.columns.size(); ++t)
    p.insert(p.end(), correction.columns[t].begin(), correction.columns[t].end());
  return p;
}

// Difference between the corrected L*a*b* of a patch and its true colour.
template <std::size_t kTerms>
struct PatchResidual {
  std::vector<double> terms;
  XYZ white;
  Lab target;
  Objective objective;

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    const double last = terms.back();
    std::array<T, 3> xyz{T(white[0] * last), T(white[1] * last), T(white[2] * last)};
    for (std::size_t t = 0; t + 1 < kTerms; ++t)
      for (std::size_t i = 0; i < 3; ++i) xyz[i] += p[3 * t + i] * (terms[t] - last);
    const std::array<T, 3> lab = xyz_to_lab(xyz, white);
    const std::array<T, 3> truth{T(target[0]), T(target[1]), T(target[2])};
    if (objective == Objective::delta_e_2000) {
      const std::array<T, 3> d = delta_e_2000_vector(truth, lab);
      std::copy(d.begin(), d.end(), residual);
    } else {
      for (std::size_t i = 0; i < 3; ++i) residual[i] = lab[i] - truth[i];
    }
    return true;
  }
};

struct Attempt {
  Parameters parameters;
  ceres::Solver::Summary summary;
};

template <std::size_t kTerms>
Attempt solve_with(const PatchColors& colors, const Parameters& start, const CorrectionOptions& how) {
  using Residual = PatchResidual<kTerms>;
  Attempt attempt{start, {}};
  ceres::Problem problem;
  for (std::size_t i = 0; i < colors.raw.size(); ++i) {
    auto residual =
        std::make_unique<Residual>(Residual{correction_terms(how.model, colors.raw[i]), colors.white,
                                            xyz_to_lab(colors.xyz[i], colors.white), how.objective});
    ceres::LossFunction* loss = new ceres::SoftLOneLoss(kLossScale);
    if (!colors.weights.empty()) loss = new ceres::ScaledLoss(loss, colors.weights[i], ceres::TAKE_OWNERSHIP);
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Residual, 3, 3 * (kTerms - 1)>(residual.release()), loss,
        attempt.parameters.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = how.max_iterations;
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-10;
  options.gradient_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solve(options, &problem, &attempt.summary);
  return attempt;
}

Attempt solve(const PatchColors& colors, const Parameters& start, const CorrectionOptions& how) {
  switch (how.model) {
    case CorrectionModel::linear:
      return solve_with<term_count(CorrectionModel::linear)>(colors, start, how);
    case CorrectionModel::root_polynomial_2:
      return solve_with<term_count(CorrectionModel::root_polynomial_2)>(colors, start, how);
    case CorrectionModel::root_polynomial_3:
      break;
  }
  return solve_with<term_count(CorrectionModel::root_polynomial_3)>(colors, start, how);
}

// True if an attempt converged to a finite solution. Ceres counts an exhausted iteration budget as usable and
// may call an infinite cost converged, so both are tested here.
bool usable(const Attempt& attempt) {
  return attempt.summary.IsSolutionUsable() && attempt.summary.termination_type == ceres::CONVERGENCE &&
         std::isfinite(attempt.summary.final_cost) &&
         std::ranges::all_of(attempt.parameters, [](double p) { return std::isfinite(p); });
}

double objective_of(const PatchErrors& errors, const PatchColors& colors, Objective objective) {
  const bool is_76 = objective == Objective::delta_e_76;
  if (colors.weights.empty()) return is_76 ? errors.mean_76 : errors.mean;
  const std::vector<double>& values = is_76 ? errors.delta_e_76 : errors.delta_e;
  return std::inner_product(values.begin(), values.end(), colors.weights.begin(), 0.0);
}

void require_determined(const Eigen::MatrixXd& a, Eigen::Index rank) {
  if (rank == a.cols() && a.allFinite()) return;
  throw Error(ErrorCode::input, "colour correction",
              fmt::format("these {} patches do not determine the correction: they show {} independent "
                          "colours (needed {})",
                          a.rows(), rank, a.cols()));
}

// Least-squares solution of a x = b, column by column. The matrix a consists of `channels`, or of their
// differences; `largest` is their largest value. If the solution is so large that it amplifies rounding,
// nearly equal channels count as dependent.
Eigen::MatrixXd solve_least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b,
                                    const Eigen::MatrixXd& channels, double largest) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  Eigen::MatrixXd solution = qr.solve(b);
  const bool is_large = !(solution.lpNorm<Eigen::Infinity>() < 1 / kMinDifference);
  if (qr.rank() == a.cols() && a.allFinite() && !is_large) return solution;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> colours(channels);
  colours.setThreshold(kMinDifference * largest / colours.maxPivot());
  require_determined(channels, colours.rank());
  require_determined(a, qr.rank());
  return solution;
}

Eigen::MatrixXd rows_of(const std::vector<std::array<double, 3>>& values) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(values.size()), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    rows.row(i) = Eigen::Map<const Eigen::RowVector3d>(values[static_cast<std::size_t>(i)].data());
  return rows;
}

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

std::vector<double> correction_terms(CorrectionModel model, const Raw& raw) {
  std::vector<double> terms(raw.begin(), raw.end());
  const auto [r, g, b] = raw;
  const auto add = [&terms](double product, auto root) { terms.push_back(product > 0 ? root(product) : 0); };
  if (model != CorrectionModel::linear)
    for (const double product : {r * g, g * b, r * b}) add(product, [](double x) { return std::sqrt(x); });
  if (model == CorrectionModel::root_polynomial_3)
    for (const double product : {r * g * g, g * b * b, r * b * b, g * r * r, b * g * g, b * r * r, r * g * b})
      add(product, [](double x) { return std::cbrt(x); });
  return terms;
}

XYZ ColorCorrection::operator()(const Raw& raw) const {
  const std::vector<double> terms = correction_terms(model, raw);
  XYZ xyz{};
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) xyz[i] += columns[t][i] * terms[t];
  return xyz;
}

ColorCorrection linear_correction(const Matrix3& m) {
  ColorCorrection correction;
  for (int j = 0; j < 3; ++j) correction.columns.push_back({m[0][j], m[1][j], m[2][j]});
  return correction;
}

Matrix3 linear_part(const ColorCorrection& correction) {
  const auto& c = correction.columns;
  return {c[0][0], c[1][0], c[2][0], c[0][1], c[1][1], c[2][1], c[0][2], c[1][2], c[2][2]};
}

Matrix3 least_squares_matrix(const PatchColors& colors) {
  const Eigen::MatrixXd raw = rows_of(colors.raw);
  const Eigen::MatrixXd x = solve_least_squares(raw, rows_of(colors.xyz), raw, raw.lpNorm<Eigen::Infinity>());
  return {x(0, 0), x(1, 0), x(2, 0), x(0, 1), x(1, 1), x(2, 1), x(0, 2), x(1, 2), x(2, 2)};
}

// The constraint sum_t c_t = w eliminates the last column: sum_t c_t (f_t - f_last) = xyz - w f_last, with
// the terms f_t, their columns c_t and the white w.
ColorCorrection white_preserving_least_squares(const PatchColors& colors, CorrectionModel model) {
  const Eigen::MatrixXd raw = rows_of(colors.raw);
  const Eigen::Index n = raw.rows();
  const auto free_terms = static_cast<Eigen::Index>(term_count(model)) - 1;
  Eigen::MatrixXd a(n, free_terms);
  Eigen::MatrixXd b(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::vector<double> terms = correction_terms(model, colors.raw[static_cast<std::size_t>(i)]);
    const XYZ& xyz = colors.xyz[static_cast<std::size_t>(i)];
    for (Eigen::Index t = 0; t < free_terms; ++t) a(i, t) = terms[static_cast<std::size_t>(t)] - terms.back();
    for (Eigen::Index j = 0; j < 3; ++j)
      b(i, j) = xyz[static_cast<std::size_t>(j)] - colors.white[static_cast<std::size_t>(j)] * terms.back();
    if (colors.weights.empty()) continue;
    const double weight = std::sqrt(colors.weights[static_cast<std::size_t>(i)]);
    a.row(i) *= weight;
    b.row(i) *= weight;
  }
  const Eigen::MatrixXd columns =
      solve_least_squares(a, b, raw.leftCols(2).colwise() - raw.col(2), raw.lpNorm<Eigen::Infinity>())
          .transpose();
  return correction_of(model, {columns.data(), columns.data() + columns.size()}, colors.white);
}

PatchErrors patch_errors(const PatchColors& colors, const ColorCorrection& correction) {
  PatchErrors errors;
  for (std::size_t i = 0; i < colors.raw.size(); ++i) {
    const Lab lab = xyz_to_lab(correction(colors.raw[i]), colors.white);
    const Lab truth = xyz_to_lab(colors.xyz[i], colors.white);
    errors.delta_e.push_back(delta_e_2000(truth, lab));
    errors.max = std::max(errors.max, errors.delta_e.back());
    errors.delta_e_76.push_back(delta_e_76(truth, lab));
    errors.mean_76 += errors.delta_e_76.back();
  }
  const double count = std::max(1.0, static_cast<double>(errors.delta_e.size()));
  errors.mean = std::accumulate(errors.delta_e.begin(), errors.delta_e.end(), 0.0) / count;
  errors.mean_76 /= count;
  return errors;
}

bool are_enough_patches(CorrectionModel model, std::size_t patches) {
  return model == CorrectionModel::linear || patches >= kPatchesPerTerm * term_count(model);
}

void require_enough_patches(CorrectionModel model, std::size_t patches) {
  if (are_enough_patches(model, patches)) return;
  const std::size_t needed = kPatchesPerTerm * term_count(model);
  throw Error(ErrorCode::usage, "--correction",
              fmt::format("{} terms on {} patches would follow the patches and not the camera: a matrix "
                          "would predict other patches better (allowed from {} patches on)",
                          term_count(model), patches, needed));
}

CorrectionFit fit_correction(const PatchColors& colors, const CorrectionOptions& options) {
  CorrectionFit fit{white_preserving_least_squares(colors, options.model), {}, {}, 0, 0, options.starts, 0};
  fit.errors = fit.start = patch_errors(colors, fit.correction);
  if (options.objective == Objective::xyz) {
    fit.starts = fit.usable = 1;
    return fit;
  }
  const Parameters least_squares = parameters_of(fit.correction);
  const auto objective = [&](const PatchErrors& errors) {
    return objective_of(errors, colors, options.objective);
  };
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> jitter(0, kJitter);
  for (int k = 0; k < options.starts; ++k) {
    Parameters parameters = least_squares;
    if (k > 0)
      for (double& p : parameters) p += jitter(random);
    const Attempt attempt = solve(colors, parameters, options);
    if (k == 0) fit.initial_cost = fit.final_cost = attempt.summary.initial_cost;
    if (!usable(attempt)) continue;
    ++fit.usable;
    ColorCorrection candidate = correction_of(options.model, attempt.parameters, colors.white);
    PatchErrors errors = patch_errors(colors, candidate);
    if (!(objective(errors) < objective(fit.errors))) continue;
    fit.correction = std::move(candidate);
    fit.errors = std::move(errors);
    fit.final_cost = attempt.summary.final_cost;
  }
  if (fit.usable == 0)
    throw Error(
        ErrorCode::input, "colour correction",
        fmt::format(
            "no correction can be found for these {} patches: their values do not match their colours (tried "
            "{} starts; are chart, light and the order of the patches those of the photograph?)",
            colors.raw.size(), options.starts));
  return fit;
}

std::vector<double> noise_weights(const PatchColors& colors, std::span<const Raw> deviations) {
  // The first matrix may follow the noise, so the weights are refined by fitting again with them.
  constexpr int kPasses = 3;
  PatchColors weighted = colors;
  for (int pass = 0; pass < kPasses; ++pass) weighted.weights = weights_under(weighted, deviations);
  return weighted.weights;
}

}  // namespace abbe
