#include "calibration/fit/response_problem.h"

namespace abbe {
namespace {

// Residual w (g(z) - ln E - ln t) of a code z, with its weight w, the curve g, the exposure E and the time
// t.
struct SampleResidual {
  ResponseSample sample;
  double weight;

  template <typename T>
  bool operator()(const T* theta, const T* log_exposure, T* residual) const {
    residual[0] = weight * (ResponseModel<T>(theta)(sample.code) - log_exposure[0] - sample.log_time);
    return true;
  }
};

}  // namespace

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

std::unique_ptr<ceres::Problem> all_terms(const WeightedSamples& data, double roughness,
                                          ResponseUnknowns& unknowns) {
  auto problem = data_terms(data, unknowns);
  problem->AddResidualBlock(new SmoothnessCost(new ResponseSmoothness{roughness}), nullptr,
                            unknowns.theta.data());
  return problem;
}

}  // namespace abbe
