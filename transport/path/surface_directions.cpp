#include "transport/path/surface_directions.h"

#include <cmath>
#include <numbers>

#include "materials/bsdf/warp.h"

namespace abbe {
namespace {

// True if light may be transmitted, so that both sides are sampled.
bool is_two_sided(const SurfaceVertex& vertex) {
  return !vertex.light_context().side;
}

// p(wi) of a local direction [1/sr].
float density(DirectionSampling directions, const SurfaceVertex& vertex, const Imath::V3f& wi) {
  const bool both = is_two_sided(vertex);
  if (!both && !(vertex.wo.z * wi.z > 0)) return 0;
  const float over_side = directions == DirectionSampling::cosine
                              ? std::abs(wi.z) * std::numbers::inv_pi_v<float>
                              : std::numbers::inv_pi_v<float> / 2;
  return both ? over_side / 2 : over_side;
}

// Samples a local direction; with two sides the first number also selects the side.
Imath::V3f draw(DirectionSampling directions, const SurfaceVertex& vertex, Imath::V2f u) {
  float side = std::copysign(1.0F, vertex.wo.z);
  if (is_two_sided(vertex)) {
    side = u.x < 0.5F ? 1.0F : -1.0F;
    u.x = 2 * u.x - (u.x < 0.5F ? 0.0F : 1.0F);
  }
  Imath::V3f wi = directions == DirectionSampling::cosine ? cosine_hemisphere(u)
                                                          : direction_at(1 - u.x, 2 * std::numbers::pi * u.y);
  wi.z *= side;
  return wi;
}

}  // namespace

SampledSpectrum pdf_of_directions(DirectionSampling directions, const SurfaceVertex& vertex,
                                  const Imath::V3f& wi) {
  return (SampledSpectrum(1) - delta_probability(vertex.bsdf, vertex.wo)) * density(directions, vertex, wi);
}

std::optional<BsdfSample> sample_directions(DirectionSampling directions, const SurfaceVertex& vertex,
                                            const BsdfRandom& u, int hero, TransportMode mode) {
  std::optional<BsdfSample> event;
  const bool may_be_delta = delta_probability(vertex.bsdf, vertex.wo)[hero] > 0;
  if (may_be_delta) event = vertex.scatter(u, hero, mode);
  if (!scatters(vertex.bsdf) || (event && event->delta)) return event;
  const Imath::V3f wi = draw(directions, vertex, u.direction);
  const SampledSpectrum f = vertex.f(vertex.frame.to_world(wi), wi, mode);
  const SampledSpectrum drawn = pdf_of_directions(directions, vertex, wi);
  const float pdf = drawn[hero];
  if (f.is_zero() || !(pdf > 0)) return std::nullopt;
  return BsdfSample{.wi = wi,
                    .weight = f * (std::abs(wi.z) / pdf),
                    .lane_pdf = drawn * (1 / pdf),
                    .pdf = pdf,
                    .transmitted = wi.z * vertex.wo.z < 0};
}

}  // namespace abbe
