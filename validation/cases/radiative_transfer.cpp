#include "validation/cases/radiative_transfer.h"

#include <cmath>
#include <numeric>

#include "validation/cases/quadrature.h"

namespace abbe {

ChandrasekharH::ChandrasekharH(double albedo) : albedo_(albedo), h_(400, 1.0) {
  for (int round = 0; round < 100; ++round) {
    std::vector<double> better;
    for (std::size_t i = 0; i < h_.size(); ++i) better.push_back((*this)(node(i)));
    h_ = better;
  }
}

double ChandrasekharH::node(std::size_t i) const {
  return (static_cast<double>(i) + 0.5) / static_cast<double>(h_.size());
}

double ChandrasekharH::operator()(double mu) const {
  double sum = 0;
  for (std::size_t i = 0; i < h_.size(); ++i)
    sum += node(i) * h_[i] / (mu + node(i)) / static_cast<double>(h_.size());
  return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * sum);
}

double ChandrasekharH::mean() const {
  return std::accumulate(h_.begin(), h_.end(), 0.0) / static_cast<double>(h_.size());
}

double scattered_once(const EvenMatter& matter, double h, double before, double after) {
  constexpr int kSteps = 20000;
  const auto from = [&](double x) {
    const double r = std::hypot(x, h);
    const double cosine = -x / r;  // between the way of the light and the way to the camera, which is -x
    return matter.phase(cosine) * std::exp(-matter.extinction * (x + before + r)) / (r * r);
  };
  return matter.scattering * midpoint_integral(from, -before, after, kSteps);
}

}  // namespace abbe
