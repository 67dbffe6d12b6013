#include "scene/shutter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace abbe {

Shutter::Shutter(std::vector<Knot> knots, double delay, int rows)
    : knots_(std::move(knots)), passed_{0}, mean_(0), delay_(delay), span_(1 + delay * (rows - 1)) {
  for (std::size_t i = 1; i < knots_.size(); ++i) {
    mean_ += (knots_[i].at - knots_[i - 1].at) * (knots_[i].passes + knots_[i - 1].passes) / 2;
    passed_.push_back(mean_);
  }
  for (double& passed : passed_) passed /= mean_;
  plain_ = delay_ == 0 && std::all_of(knots_.begin(), knots_.end(), [this](const Knot& knot) {
             return knot.passes == knots_.front().passes;
           });
}

Shutter Shutter::where_nothing_moves() const {
  return Shutter({{0, mean_}, {1, mean_}}, 0, 1);
}

// Within a piece from (a, f) to (b, g) the integral of S up to a + x is f x + (g - f) x^2 / (2 (b - a)); it
// is solved for x in the form that loses nothing where f = g.
float Shutter::draw_in(int row, float u) const {
  const double wanted = static_cast<double>(u);
  const auto above = std::upper_bound(passed_.begin() + 1, passed_.end() - 1, wanted);
  const auto i = static_cast<std::size_t>(above - passed_.begin());
  const Knot& from = knots_[i - 1];
  const double width = knots_[i].at - from.at;
  const double rest = (wanted - passed_[i - 1]) * mean_;
  const double slope = width > 0 ? (knots_[i].passes - from.passes) / width : 0;
  const double root = std::sqrt(std::max(0.0, from.passes * from.passes + 2 * slope * rest));
  const double x = from.passes + root > 0 ? 2 * rest / (from.passes + root) : 0;
  return static_cast<float>((row * delay_ + from.at + std::min(x, width)) / span_);
}

float Shutter::weight_in(int row, float time) const {
  const double at = static_cast<double>(time) * span_ - row * delay_;
  if (!(at >= 0 && at < 1)) return 0;
  const auto after = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, at,
                                      [](double s, const Knot& knot) { return s < knot.at; });
  const Knot& from = *(after - 1);
  const double width = after->at - from.at;
  const double passes =
      width > 0 ? from.passes + (after->passes - from.passes) * (at - from.at) / width : after->passes;
  return static_cast<float>(passes * span_);
}

}  // namespace abbe
