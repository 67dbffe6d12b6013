#include "validation/statistics.h"

#include <cmath>
#include <limits>

#include <boost/math/distributions/students_t.hpp>

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

double half_interval(double standard_error, double degrees, double level) {
  if (!(degrees > 0)) return std::numeric_limits<double>::infinity();
  return standard_error * boost::math::quantile(boost::math::students_t(degrees), (1 + level) / 2);
}

}  // namespace abbe
