#include "materials/interface/hemispherical.h"

#include <cmath>

namespace abbe {

double diffuse_reflectance_outside(double eta) {
  // Near 1 the terms below are as large as 1/(eta - 1)^2 and cancel: their limit takes over.
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

double diffuse_reflectance_inside(double eta) {
  if (eta < 1) return diffuse_reflectance_outside(1 / eta);
  return 1 - (1 - diffuse_reflectance_outside(eta)) / (eta * eta);
}

}  // namespace abbe
