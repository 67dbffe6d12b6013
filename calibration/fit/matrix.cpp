#include "calibration/fit/matrix.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include <ceres/ceres.h>
#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "io/error.h"

namespace abbe {
namespace {

constexpr double kLossScale = 0.05;  // dE2000 below which the loss turns quadratic

// The first two columns row by row; the third follows from the white.
using Parameters = std::array<double, 6>;

template <typename T>
std::array<T, 3> corrected(const T* p, const XYZ& white, const Raw& raw) {
  std::array<T, 3> xyz;
  for (std::size_t i = 0; i < 3; ++i)
    xyz[i] = p[2 * i] * (raw[0] - raw[2]) + p[2 * i + 1] * (raw[1] - raw[2]) + white[i] * raw[2];
  return xyz;
}

Matrix3 matrix_of(const Parameters& p, const XYZ& w) {
  return {p[0], p[1], w[0] - p[0] - p[1], p[2], p[3], w[1] - p[2] - p[3], p[4], p[5], w[2] - p[4] - p[5]};
}

Parameters parameters_of(const Matrix3& m) {
  return {m[0][0], m[0][1], m[1][0], m[1][1], m[2][0], m[2][1]};
}

struct PatchResidual {
  Raw raw;
  XYZ white;
  Lab target;

  template <typename T>
  bool operator()(const T* parameters, T* residual) const {
    const std::array<T, 3> lab = xyz_to_lab(corrected(parameters, white, raw), white);
    const std::array<T, 3> truth{T(target[0]), T(target[1]), T(target[2])};
    const std::array<T, 3> d = delta_e_2000_vector(truth, lab);
    std::copy(d.begin(), d.end(), residual);
    return true;
  }
};

struct Attempt {
  Parameters parameters;
  ceres::Solver::Summary summary;
};

Attempt solve(const PatchColors& colors, const Parameters& start, int max_iterations) {
  Attempt attempt{start, {}};
  ceres::Problem problem;
  for (std::size_t i = 0; i < colors.raw.size(); ++i) {
    auto residual = std::make_unique<PatchResidual>(
        PatchResidual{colors.raw[i], colors.white, xyz_to_lab(colors.xyz[i], colors.white)});
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PatchResidual, 3, 6>(residual.release()),
                             new ceres::SoftLOneLoss(kLossScale), attempt.parameters.data());
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = 1e-10;
  options.parameter_tolerance = 1e-10;
  options.gradient_tolerance = 1e-12;
  options.num_threads = 1;
  options.logging_type = ceres::SILENT;
  ceres::Solve(options, &problem, &attempt.summary);
  return attempt;
}

// Ceres counts an exhausted iteration budget as usable and may call an infinite cost converged, so both are
// looked at here.
bool usable(const Attempt& attempt) {
  return attempt.summary.IsSolutionUsable() && attempt.summary.termination_type == ceres::CONVERGENCE &&
         std::isfinite(attempt.summary.final_cost) &&
         std::all_of(attempt.parameters.begin(), attempt.parameters.end(),
                     [](double p) { return std::isfinite(p); });
}

void require_three_dimensions(const Eigen::MatrixXd& a, Eigen::Index rank) {
  if (rank == a.cols() && a.allFinite()) return;
  throw Error(
      ErrorCode::input, "matrix fit",
      fmt::format("{} patches do not determine the matrix (rank {}, needed {})", a.rows(), rank, a.cols()));
}

// Least squares solution of a x = b, column by column.
Eigen::MatrixXd solve_least_squares(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(a);
  require_three_dimensions(a, qr.rank());
  return qr.solve(b);
}

}  // namespace

Matrix3 least_squares_matrix(const PatchColors& colors) {
  const auto n = static_cast<Eigen::Index>(colors.raw.size());
  Eigen::MatrixXd a(n, 3);
  Eigen::MatrixXd b(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    a.row(i) = Eigen::Map<const Eigen::RowVector3d>(colors.raw[static_cast<std::size_t>(i)].data());
    b.row(i) = Eigen::Map<const Eigen::RowVector3d>(colors.xyz[static_cast<std::size_t>(i)].data());
  }
  const Eigen::MatrixXd x = solve_least_squares(a, b);
  return {x(0, 0), x(1, 0), x(2, 0), x(0, 1), x(1, 1), x(2, 1), x(0, 2), x(1, 2), x(2, 2)};
}

Matrix3 white_preserving_least_squares(const PatchColors& colors) {
  const auto n = static_cast<Eigen::Index>(colors.raw.size());
  Eigen::MatrixXd a(n, 2);
  Eigen::MatrixXd b(n, 3);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Raw& raw = colors.raw[static_cast<std::size_t>(i)];
    const XYZ& xyz = colors.xyz[static_cast<std::size_t>(i)];
    a.row(i) << raw[0] - raw[2], raw[1] - raw[2];
    for (Eigen::Index j = 0; j < 3; ++j)
      b(i, j) = xyz[static_cast<std::size_t>(j)] - colors.white[static_cast<std::size_t>(j)] * raw[2];
  }
  const Eigen::MatrixXd x = solve_least_squares(a, b);
  return matrix_of({x(0, 0), x(1, 0), x(0, 1), x(1, 1), x(0, 2), x(1, 2)}, colors.white);
}

PatchErrors patch_errors(const PatchColors& colors, const Matrix3& raw_to_xyz) {
  PatchErrors errors;
  for (std::size_t i = 0; i < colors.raw.size(); ++i) {
    const Lab lab = xyz_to_lab(multiply(raw_to_xyz, colors.raw[i]), colors.white);
    errors.delta_e.push_back(delta_e_2000(xyz_to_lab(colors.xyz[i], colors.white), lab));
    errors.max = std::max(errors.max, errors.delta_e.back());
  }
  errors.mean = std::accumulate(errors.delta_e.begin(), errors.delta_e.end(), 0.0) /
                std::max(1.0, static_cast<double>(errors.delta_e.size()));
  return errors;
}

MatrixFit fit_matrix(const PatchColors& colors, const MatrixFitOptions& options) {
  const Matrix3 least_squares = white_preserving_least_squares(colors);
  const PatchErrors start = patch_errors(colors, least_squares);
  MatrixFit fit{least_squares, start, start, 0, 0, options.starts, 0};
  std::mt19937_64 random(options.seed);
  std::normal_distribution<double> jitter(0, options.jitter);
  std::string report;
  for (int k = 0; k < options.starts; ++k) {
    Parameters parameters = parameters_of(least_squares);
    if (k > 0)
      for (double& p : parameters) p += jitter(random);
    const Attempt attempt = solve(colors, parameters, options.max_iterations);
    if (k == 0) {
      fit.initial_cost = attempt.summary.initial_cost;
      fit.final_cost = attempt.summary.initial_cost;
      report = attempt.summary.BriefReport();
    }
    if (!usable(attempt)) continue;
    ++fit.usable;
    const Matrix3 candidate = matrix_of(attempt.parameters, colors.white);
    PatchErrors errors = patch_errors(colors, candidate);
    if (!(errors.mean < fit.errors.mean)) continue;
    fit.raw_to_xyz = candidate;
    fit.errors = std::move(errors);
    fit.final_cost = attempt.summary.final_cost;
  }
  if (fit.usable == 0) throw Error(ErrorCode::input, "matrix fit", "no start converged: " + report);
  return fit;
}

}  // namespace abbe
