#include "description/doors/shared/lamps.h"

#include <algorithm>
#include <cmath>

#include "sampling/angle.h"

namespace abbe::doors {

double hard_cone(double full_deg, double whole_deg, const SourcePosition& where, Door& door) {
  if (full_deg >= whole_deg) return whole_deg;
  door.note(where, "a spot's soft edge becomes a hard one that sends out as much");
  const double mean = (std::cos(full_deg * kDegree) + std::cos(whole_deg * kDegree)) / 2;
  return std::acos(std::clamp(mean, -1.0, 1.0)) / kDegree;
}

}  // namespace abbe::doors
