#include "transport/path/mis_weight.h"

namespace abbe {
namespace {

// W / own by the power heuristic, so that no square overflows.
float weigh_by_squares(float own, float other) {
  const float ratio = other / own;
  return 1 / (own * (1 + ratio * ratio));
}

}  // namespace

float LightWeights::weigh_met(float scattered, float connection_pdf, float connected) const {
  const float other = connection_pdf * connected;
  if (lights_ == LightStrategy::mis) return weigh_by_squares(scattered, other);
  return lights_ == LightStrategy::light && other > 0 ? 0 : 1 / scattered;
}

float LightWeights::weigh_connection(float scattered, float connection_pdf, float connected) const {
  const float own = connection_pdf * connected;
  return lights_ == LightStrategy::mis ? weigh_by_squares(own, scattered) : 1 / own;
}

}  // namespace abbe
