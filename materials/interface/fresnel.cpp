#include "materials/interface/fresnel.h"

#include <boost/math/quadrature/gauss.hpp>

namespace abbe {
namespace {

// Diffuse reflectance from the side of lower index; eta >= 1 is the higher index divided by the lower.
double diffuse_reflectance_outside(double eta) {
  // Near 1 the terms below are as large as 1/(eta - 1)^2 and cancel, so their limit is used.
  if (eta < 1 + 1e-4) return (eta - 1) / 3;
  const double n2 = eta * eta;
  const double n4 = n2 * n2;
  const double minus = n2 - 1;
  const double plus = n2 + 1;
  return 0.5 + (eta - 1) * (3 * eta + 1) / (6 * (eta + 1) * (eta + 1)) +
         n2 * minus * minus / (plus * plus * plus) * std::log((eta - 1) / (eta + 1)) -
         2 * n2 * eta * (n2 + 2 * eta - 1) / (plus * (n4 - 1)) +
         8 * n4 * (n4 + 1) / (plus * (n4 - 1) * (n4 - 1)) * std::log(eta);
}

}  // namespace

double diffuse_reflectance_inside(double eta) {
  if (eta < 1) return diffuse_reflectance_outside(1 / eta);
  return 1 - (1 - diffuse_reflectance_outside(eta)) / (eta * eta);
}

double diffuse_reflectance(double n, double k) {
  const auto reflected = [n, k](double c) { return 2 * c * fresnel_conductor(c, n, k).R(); };
  const auto integral = [&](double low, double high) {
    return boost::math::quadrature::gauss<double, 10>::integrate(reflected, low, high);
  };
  if (n >= 1) return integral(0, 1);
  const double critical = std::sqrt((1 - n) * (1 + n));
  return integral(0, critical) + integral(critical, 1);
}

}  // namespace abbe
