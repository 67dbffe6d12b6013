#include "calibration/metrics/camera_space.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "io/error.h"
#include "spectral/colorimetry.h"

namespace abbe {
namespace {

using Samples1nm = std::vector<double>;

Samples1nm sampled(const Curve& curve) {
  Samples1nm samples;
  for (int nm = SumRange{}.low_nm; nm <= SumRange{}.high_nm; ++nm) samples.push_back(curve(nm));
  return samples;
}

double dot(const Samples1nm& a, const Samples1nm& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Orthonormal basis of the space of the curves, by Gram-Schmidt with two passes per step against rounding.
std::vector<Samples1nm> basis_of(std::vector<Samples1nm> curves) {
  constexpr double kDependent = 1e-10;
  std::vector<Samples1nm> basis;
  for (Samples1nm& curve : curves) {
    const double whole = std::sqrt(dot(curve, curve));
    for (int pass = 0; pass < 2; ++pass)
      for (const Samples1nm& e : basis) {
        const double along = dot(curve, e);
        for (std::size_t i = 0; i < curve.size(); ++i) curve[i] -= along * e[i];
      }
    const double rest = std::sqrt(dot(curve, curve));
    if (!(rest > kDependent * whole)) continue;
    for (double& v : curve) v /= rest;
    basis.push_back(std::move(curve));
  }
  return basis;
}

// Squared length of the projection of a vector on the space of a basis.
double squared_projection(const Samples1nm& vector, const std::vector<Samples1nm>& basis) {
  double total = 0;
  for (const Samples1nm& e : basis) total += dot(vector, e) * dot(vector, e);
  return total;
}

}  // namespace

// The Vora value is the sum over an orthonormal basis e_i of the observer of |P e_i|^2/3, where P projects
// on the channels. The residual of a function f is (1 - |P f|^2/|f|^2)^(1/2).
CameraSpace camera_space(std::span<const Channel> channels) {
  if (channels.size() < 3)
    throw Error(ErrorCode::usage, "camera", "the Vora value and the Luther condition need three channels");
  std::vector<Samples1nm> responses;
  for (const Channel& channel : channels) responses.push_back(sampled(channel.weight));
  const std::vector<Samples1nm> camera = basis_of(std::move(responses));
  const ColorMatching& cmf = color_matching(Observer::cie1931);
  const std::vector<Samples1nm> observer{sampled(cmf.x), sampled(cmf.y), sampled(cmf.z)};
  CameraSpace result;
  for (const Samples1nm& e : basis_of(observer)) result.vora += squared_projection(e, camera) / 3;
  for (std::size_t i = 0; i < 3; ++i)
    result.luther[i] =
        std::sqrt(std::max(0.0, 1 - squared_projection(observer[i], camera) / dot(observer[i], observer[i])));
  return result;
}

}  // namespace abbe
