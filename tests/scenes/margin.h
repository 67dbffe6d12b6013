#pragma once

#include <algorithm>
#include <cmath>

#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

namespace abbe::test {

/// The standard error of the ratio of two independent means.
inline double ratio_error(const Region& a, const Region& b) {
  return std::sqrt(a.variance / (a.mean * a.mean) + b.variance / (b.mean * b.mean));
}

/// Of all channels of a film together, which see the same paths, so that their deviations add up at most.
inline Region all_channels(const Film& film) {
  double mean = 0;
  double deviation = 0;
  for (int channel = 0; channel < film.channels(); ++channel) {
    const Region one = whole(film, channel);
    mean += one.mean;
    deviation += std::sqrt(one.variance);
  }
  return {mean, deviation * deviation};
}

/// How far from 1 the ratio of two means may be: at night so much; by day, of fewer samples, 4.5 standard
/// errors where these are more, which may not be more than `by_day`.
inline double ratio_margin(const Region& a, const Region& b, double at_night, double by_day) {
  if (nightly()) return at_night;
  const double chance = 4.5 * ratio_error(a, b);
  EXPECT_LT(chance, by_day) << "too noisy to tell";
  return std::max(at_night, chance);
}
inline double ratio_margin(const Film& a, const Film& b, double at_night, double by_day) {
  return ratio_margin(all_channels(a), all_channels(b), at_night, by_day);
}

}  // namespace abbe::test
