#include "validation/statistics/equivalence.h"

#include <cmath>

namespace abbe {

Verdict equivalence(const Estimate& measured, double reference, double margin) {
  constexpr double kRounding = 1e-5;  // single precision, over a path of many events
  const double scale = std::abs(reference);
  const double difference = std::abs(measured.mean - reference);
  const double spread = kInterval * measured.standard_error;
  if (difference + spread < margin * scale) return Verdict::pass;
  if (difference - spread > kRounding * scale || !std::isfinite(difference + spread)) return Verdict::fail;
  return Verdict::inconclusive;
}

}  // namespace abbe
