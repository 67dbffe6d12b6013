#include "transport/path/mis_weight.h"

namespace abbe {
namespace {

// W / own for the power heuristic, arranged so that no square overflows.
float weigh_by_squares(float own, float other) {
  const float ratio = other / own;
  return 1 / (own * (1 + ratio * ratio));
}

}  // namespace

float LightWeights::weigh_emission(float scattered, float connection_pdf, float path_pdf) const {
  const float other = connection_pdf * path_pdf;
  if (lights_ == LightStrategy::mis) return weigh_by_squares(scattered, other);
  return lights_ == LightStrategy::light && other > 0 ? 0 : 1 / scattered;
}

float LightWeights::weigh_connection(float scattered, float connection_pdf, float path_pdf) const {
  const float own = connection_pdf * path_pdf;
  return lights_ == LightStrategy::mis ? weigh_by_squares(own, scattered) : 1 / own;
}

}  // namespace abbe
