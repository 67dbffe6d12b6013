#include "scene/shutter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace abbe {

Shutter::Shutter(std::vector<Knot> knots, double delay, int rows)
    : knots_(std::move(knots)), cdf_{0}, mean_(0), delay_(delay), span_(1 + delay * (rows - 1)) {
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    mean_ +=
        (knots_[i].time - knots_[i - 1].time) * (knots_[i].transmittance + knots_[i - 1].transmittance) / 2;
    cdf_.push_back(mean_);
  }
  for (double& cumulative : cdf_) cumulative /= mean_;
  plain_ = delay_ == 0 && std::all_of(knots_.begin(), knots_.end(), [this](const Knot& knot) {
             return knot.transmittance == knots_.front().transmittance;
           });
}

Shutter Shutter::static_equivalent() const {
  return Shutter({{0, mean_}, {1, mean_}}, 0, 1);
}

// Between the knots (a, f) and (b, g) the integral of S up to a + x is f x + (g - f) x^2 / (2 (b - a)). The
// solution for x is written in the form that is stable for f = g.
float Shutter::sample_row(int row, float u) const {
  const double target = static_cast<double>(u);
  const auto above = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, target);
  const auto i = static_cast<std::size_t>(above - cdf_.begin());
  const Knot& from = knots_[i - 1];
  const double width = knots_[i].time - from.time;
  const double rest = (target - cdf_[i - 1]) * mean_;
  const double slope = width > 0 ? (knots_[i].transmittance - from.transmittance) / width : 0;
  const double root = std::sqrt(std::max(0.0, from.transmittance * from.transmittance + 2 * slope * rest));
  const double x = from.transmittance + root > 0 ? 2 * rest / (from.transmittance + root) : 0;
  return static_cast<float>((row * delay_ + from.time + std::min(x, width)) / span_);
}

float Shutter::row_weight(int row, float time) const {
  const double at = static_cast<double>(time) * span_ - row * delay_;
  if (!(at >= 0 && at < 1)) return 0;
  const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, at,
                                      [](double s, const Knot& knot) { return s < knot.time; });
  const Knot& from = *(after - 1);
  const double width = after->time - from.time;
  const double transmittance =
      width > 0 ? from.transmittance + (after->transmittance - from.transmittance) * (at - from.time) / width
                : after->transmittance;
  return static_cast<float>(transmittance * span_);
}

}  // namespace abbe
