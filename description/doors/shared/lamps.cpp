#include "description/doors/shared/lamps.h"

#include <algorithm>
#include <cmath>

#include "sampling/angle.h"

namespace abbe::doors {

namespace {

// With the intensity I w of the angle a, w = 1 up to a0 and 0 from a1 on, the flux is
//
//   2 pi I int w sin a da = 2 pi I (1 - c),  c = int cos a (-dw),
//
// so that of a hard edge at the cosine c: the mean of the cosine over the fall of w.
double mean_cosine(double a0, double a1, Falloff falloff) {
  const double c0 = std::cos(a0);
  const double c1 = std::cos(a1);
  if (falloff == Falloff::linear_angle) return (std::sin(a1) - std::sin(a0)) / (a1 - a0);
  if (falloff == Falloff::squared_cosine) return (2 * c0 + c1) / 3;
  return (c0 + c1) / 2;
}

}  // namespace

double hard_cone(double full_deg, double whole_deg, Falloff falloff, const SourcePosition& where,
                 Door& door) {
  if (full_deg >= whole_deg) return whole_deg;
  door.note(where, "a spot's soft edge becomes a hard one that sends out as much");
  const double mean = mean_cosine(full_deg * kDegree, whole_deg * kDegree, falloff);
  return std::acos(std::clamp(mean, -1.0, 1.0)) / kDegree;
}

}  // namespace abbe::doors
