#include "calibration/fit/response_problem.h"

#include <limits>
#include <map>
#include <utility>

namespace abbe {
namespace {

// standard deviations from black; below that the curve would follow the noise
constexpr double kDarkMargin = 8;
constexpr double kBrightMargin = 4;  // standard deviations from full scale

// Residual w (g(z) - ln E - ln t) of a code z with weight w, curve g, exposure E and time t.
struct SampleResidual {
  ResponseSample sample;
  double weight;

  template <typename T>
  bool operator()(const T* theta, const T* log_exposure, T* residual) const {
    residual[0] = weight * (ResponseModel<T>(theta)(sample.code) - log_exposure[0] - sample.log_time);
    return true;
  }
};

// First differences have a small weight, which only continues the slope where there are no samples.
struct ResponseSmoothness {
  static constexpr std::size_t kCoefficients = ResponseModel<double>::kCoefficients;
  static constexpr int kTerms = static_cast<int>(2 * kCoefficients - 3);  // Number of residuals.
  static constexpr double kSlopeDrift = 0.01;                             // Weight of the first differences.

  double roughness;

  template <typename T>
  bool operator()(const T* theta, T* residual) const {
    for (std::size_t k = 0; k + 2 < kCoefficients; ++k)
      residual[k] = roughness * (theta[k] - 2.0 * theta[k + 1] + theta[k + 2]);
    for (std::size_t k = 0; k + 1 < kCoefficients; ++k)
      residual[kCoefficients - 2 + k] = kSlopeDrift * (theta[k + 1] - theta[k]);
    return true;
  }
};
using SmoothnessCost = ceres::AutoDiffCostFunction<ResponseSmoothness, ResponseSmoothness::kTerms,
                                                   static_cast<int>(ResponseSmoothness::kCoefficients)>;

// Least-squares problem of the samples' residuals, which refers to `unknowns`.
std::unique_ptr<ceres::Problem> data_terms(const WeightedSamples& data, ResponseUnknowns& unknowns) {
  auto problem = std::make_unique<ceres::Problem>();
  for (std::size_t i = 0; i < data.samples.size(); ++i) {
    auto residual = std::make_unique<SampleResidual>(SampleResidual{data.samples[i], data.weights[i]});
    problem->AddResidualBlock(
        new ceres::AutoDiffCostFunction<SampleResidual, 1, ResponseSmoothness::kCoefficients, 1>(
            residual.release()),
        new ceres::CauchyLoss(data.loss), unknowns.theta.data(),
        &unknowns.log_exposure[data.samples[i].patch]);
  }
  return problem;
}

// The problem linearised at the unknowns, with the exposures of the patches eliminated: residuals and their
// derivatives by the curve, at the best exposure of each patch. With h = `hat_factor`, the hat matrix of the
// exposures alone is h h' between samples of one patch and 0 between others.
struct ReducedProblem {
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residuals;
  Eigen::VectorXd hat_factor;       // square root of a sample's leverage on the exposure of its patch
  std::vector<Eigen::Index> patch;  // patch of each sample
};
ReducedProblem eliminate_exposures(const WeightedSamples& data, ResponseUnknowns& unknowns) {
  const auto problem = data_terms(data, unknowns);
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = {unknowns.theta.data()};
  for (double& e : unknowns.log_exposure)
    if (problem->HasParameterBlock(&e)) options.parameter_blocks.push_back(&e);
  std::vector<double> residuals;
  ceres::CRSMatrix sparse;
  problem->Evaluate(options, nullptr, &residuals, nullptr, &sparse);
  constexpr auto kCurve = static_cast<Eigen::Index>(ResponseSmoothness::kCoefficients);
  // Columns are the curve's, then the residual. Each row has one more derivative, by its patch's exposure.
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(sparse.num_rows, kCurve + 1);
  Eigen::VectorXd by_exposure = Eigen::VectorXd::Zero(sparse.num_rows);
  std::vector<Eigen::Index> patch(static_cast<std::size_t>(sparse.num_rows));
  for (Eigen::Index row = 0; row < sparse.num_rows; ++row) {
    const auto i = static_cast<std::size_t>(row);
    rows(row, kCurve) = residuals[i];
    for (auto k = static_cast<std::size_t>(sparse.rows[i]); k < static_cast<std::size_t>(sparse.rows[i + 1]);
         ++k) {
      if (sparse.cols[k] < kCurve) {
        rows(row, sparse.cols[k]) = sparse.values[k];
      } else {
        by_exposure[row] = sparse.values[k];
        patch[i] = sparse.cols[k] - kCurve;
      }
    }
  }
  const Eigen::Index patches = sparse.num_cols - kCurve;
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(patches);
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(patches, kCurve + 1);
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    weights[patch[static_cast<std::size_t>(row)]] += by_exposure[row] * by_exposure[row];
    sums.row(patch[static_cast<std::size_t>(row)]) += by_exposure[row] * rows.row(row);
  }
  Eigen::VectorXd hat_factor(rows.rows());
  for (Eigen::Index row = 0; row < rows.rows(); ++row) {
    const Eigen::Index at = patch[static_cast<std::size_t>(row)];
    hat_factor[row] = by_exposure[row] / std::sqrt(weights[at]);
    rows.row(row) -= by_exposure[row] / weights[at] * sums.row(at);
  }
  return {rows.leftCols(kCurve), rows.col(kCurve), std::move(hat_factor), std::move(patch)};
}

// J'J and J'r of the smoothness term at the unknowns.
struct NormalEquations {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
};
NormalEquations smoothness_normal(double roughness, const ResponseUnknowns& unknowns) {
  const SmoothnessCost cost(new ResponseSmoothness{roughness});
  Eigen::Matrix<double, ResponseSmoothness::kTerms, static_cast<int>(ResponseSmoothness::kCoefficients),
                Eigen::RowMajor>
      jacobian;
  Eigen::Matrix<double, ResponseSmoothness::kTerms, 1> residuals;
  const double* parameters = unknowns.theta.data();
  double* jacobians = jacobian.data();
  cost.Evaluate(&parameters, residuals.data(), &jacobians);
  return {jacobian.transpose() * jacobian, jacobian.transpose() * residuals};
}

// Rows of the samples by exposure time.
using Exposures = std::map<double, std::vector<Eigen::Index>>;

// Sum of the squared residuals of each exposure under the fit to all others. The fit is linear, so leaving
// out is exact and needs no other fit: residuals r with the block H of the hat matrix become (I - H)^-1 r.
double left_out_score(const Exposures& exposures, const ReducedProblem& problem,
                      const Eigen::LDLT<Eigen::MatrixXd>& solver, const Eigen::VectorXd& residuals) {
  constexpr double kAlone = 1e-6;  // for a patch without any other exposure
  const auto of_one_patch = [&problem](Eigen::Index a, Eigen::Index b) {
    return problem.patch[static_cast<std::size_t>(a)] == problem.patch[static_cast<std::size_t>(b)];
  };
  double score = 0;
  for (const auto& [time, rows] : exposures) {
    const Eigen::MatrixXd jacobian = problem.jacobian(rows, Eigen::all);
    Eigen::MatrixXd rest = -jacobian * solver.solve(jacobian.transpose());
    rest.diagonal().array() += 1 + kAlone;
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < rows.size(); ++j)
        if (of_one_patch(rows[i], rows[j]))
          rest(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) -=
              problem.hat_factor[rows[i]] * problem.hat_factor[rows[j]];
    score += rest.ldlt().solve(Eigen::VectorXd(residuals(rows))).squaredNorm();
  }
  return score;
}

}  // namespace

bool within_margins(double code, double deviation) {
  return code > kDarkMargin * deviation && code < 1 - kBrightMargin * deviation;
}

std::vector<ResponseSample> usable_samples(const ExposureSeries& series, bool with_margins) {
  std::vector<ResponseSample> samples;
  for (std::size_t i = 0; i < series.codes.size(); ++i) {
    double black_s = 0;
    double clipped_s = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < series.times_s.size(); ++j) {
      if (series.codes[i][j] <= 0) black_s = std::max(black_s, series.times_s[j]);
      if (series.codes[i][j] >= 1) clipped_s = std::min(clipped_s, series.times_s[j]);
    }
    for (std::size_t j = 0; j < series.times_s.size(); ++j) {
      const double code = series.codes[i][j];
      const double time = series.times_s[j];
      const double known = series.deviations.empty() ? 0 : series.deviations[i][j];
      if (!(time > black_s && time < clipped_s && code > 0 && code < 1)) continue;
      if (with_margins && !within_margins(code, known)) continue;
      samples.push_back({i, code, series.deviations.empty() ? 1 : known, std::log(time)});
    }
  }
  return samples;
}

std::unique_ptr<ceres::Problem> all_terms(const WeightedSamples& data, double roughness,
                                          ResponseUnknowns& unknowns) {
  auto problem = data_terms(data, unknowns);
  problem->AddResidualBlock(new SmoothnessCost(new ResponseSmoothness{roughness}), nullptr,
                            unknowns.theta.data());
  return problem;
}

double choose_roughness(const WeightedSamples& data, ResponseUnknowns& unknowns) {
  const ReducedProblem problem = eliminate_exposures(data, unknowns);
  const Eigen::MatrixXd data_matrix = problem.jacobian.transpose() * problem.jacobian;
  const Eigen::VectorXd data_gradient = problem.jacobian.transpose() * problem.residuals;
  Exposures exposures;
  for (std::size_t i = 0; i < data.samples.size(); ++i)
    exposures[data.samples[i].log_time].push_back(static_cast<Eigen::Index>(i));
  double best = 1;
  double best_score = std::numeric_limits<double>::infinity();
  for (double roughness = 1; roughness < 5000; roughness *= 2) {
    const NormalEquations smooth = smoothness_normal(roughness, unknowns);
    const Eigen::LDLT<Eigen::MatrixXd> solver(data_matrix + smooth.matrix);
    const Eigen::VectorXd fitted_residuals =
        problem.residuals - problem.jacobian * solver.solve(data_gradient + smooth.gradient);
    const double score = left_out_score(exposures, problem, solver, fitted_residuals);
    if (score < best_score) {
      best_score = score;
      best = roughness;
    }
  }
  return best;
}

}  // namespace abbe
