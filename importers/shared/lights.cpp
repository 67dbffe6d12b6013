#include "importers/shared/lights.h"

#include <algorithm>
#include <cmath>

#include "sampling/angle.h"

namespace abbe::importers {

namespace {

// Mean of the cosine over the falloff. The intensity is I w(a), with w = 1 up to a0 and 0 from a1 on. Its
// flux is
//
//   2 pi I int w sin a da = 2 pi I (1 - c),  c = int cos a (-dw).
//
// A hard edge at the cosine c has that flux.
double mean_cosine(double a0, double a1, Falloff falloff) {
  const double c0 = std::cos(a0);
  const double c1 = std::cos(a1);
  if (falloff == Falloff::linear_angle) return (std::sin(a1) - std::sin(a0)) / (a1 - a0);
  if (falloff == Falloff::squared_cosine) return (2 * c0 + c1) / 3;
  return (c0 + c1) / 2;
}

}  // namespace

double hard_cone(double inner_deg, double outer_deg, Falloff falloff, const SourcePosition& where,
                 SceneImporter& importer) {
  if (inner_deg >= outer_deg) return outer_deg;
  importer.note(where, "the soft edge of a spot is replaced by a hard edge of equal flux");
  const double mean = mean_cosine(inner_deg * kDegree, outer_deg * kDegree, falloff);
  return std::acos(std::clamp(mean, -1.0, 1.0)) / kDegree;
}

}  // namespace abbe::importers
