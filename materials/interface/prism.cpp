#include "materials/interface/prism.h"

#include <cmath>

#include "materials/interface/fresnel.h"
#include "sampling/angle.h"

namespace abbe {

std::optional<PrismPassage> prism_passage(double n, double apex_deg, double incidence_deg) {
  const double sin_i = std::sin(incidence_deg * kDegree);
  const double r = std::asin(sin_i / n);
  const double inside = apex_deg * kDegree - r;  // angle of incidence on the second face
  const double sin_e = n * std::sin(inside);
  if (!(std::abs(sin_e) < 1) || !(std::cos(inside) > 0)) return std::nullopt;
  const FresnelPower<double> in = fresnel_dielectric(std::cos(incidence_deg * kDegree), n);
  const FresnelPower<double> out = fresnel_dielectric(std::cos(inside), 1 / n);
  return PrismPassage{incidence_deg, incidence_deg + std::asin(sin_e) / kDegree - apex_deg, in.Ts * out.Ts,
                      in.Tp * out.Tp};
}

std::optional<PrismPassage> prism_minimum(double n, double apex_deg) {
  const double sin_i = n * std::sin(apex_deg * kDegree / 2);
  if (!(sin_i < 1)) return std::nullopt;
  const double incidence = std::asin(sin_i);
  const FresnelPower<double> face = fresnel_dielectric(std::cos(incidence), n);
  return PrismPassage{incidence / kDegree, 2 * incidence / kDegree - apex_deg, face.Ts * face.Ts,
                      face.Tp * face.Tp};
}

}  // namespace abbe
