#include "validation/statistics/students_interval.h"

#include <limits>

#include <boost/math/distributions/students_t.hpp>

namespace abbe {

double half_interval(double standard_error, double degrees, double level) {
  if (!(degrees > 0)) return std::numeric_limits<double>::infinity();
  return standard_error * boost::math::quantile(boost::math::students_t(degrees), (1 + level) / 2);
}

}  // namespace abbe
