#include "validation/cases/radiative_transfer.h"

#include <cmath>

#include "validation/cases/suites.h"

namespace abbe {

ChandrasekharH::ChandrasekharH(double albedo) : albedo_(albedo), h_(400, 1.0) {
  for (int iteration = 0; iteration < 100; ++iteration) {
    std::vector<double> next;
    for (std::size_t i = 0; i < h_.size(); ++i) next.push_back((*this)(node(i)));
    h_ = next;
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

double single_scattering_radiance(const HomogeneousMedium& medium, double h, double before, double after) {
  constexpr int kSteps = 20000;
  const auto integrand = [&](double x) {
    const double r = std::hypot(x, h);
    const double cosine = -x / r;  // between the directions of the light and to the camera, which is -x
    return medium.phase(cosine) * std::exp(-medium.extinction * (x + before + r)) / (r * r);
  };
  return medium.scattering * midpoint_integral(integrand, -before, after, kSteps);
}

}  // namespace abbe
