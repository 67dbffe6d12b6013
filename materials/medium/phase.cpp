#include "materials/medium/phase.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace abbe {
namespace {

// Pdfs are functions of the versine 1 - cos, which stays accurate for the smallest deflections. Phase
// functions that peak backwards measure it from the opposite direction.

float density(const IsotropicPhase& /*phase*/, float /*versine*/) {
  return 1 / (4 * std::numbers::pi_v<float>);
}

// The pdf (1 - g^2)/(4 pi (1 + g^2 - 2 g cos)^(3/2)), whose bracket is (1 - g)^2 + 2 g (1 - cos).
float density(const HenyeyGreensteinPhase& phase, float versine) {
  const float g = std::abs(phase.g);
  const float squared = (1 - g) * (1 - g) + 2 * g * versine;
  return (1 - g) * (1 + g) / (4 * std::numbers::pi_v<float> * squared * std::sqrt(squared));
}

float density(const RayleighPhase& /*phase*/, float versine) {
  const float cosine = 1 - versine;
  return 3 / (16 * std::numbers::pi_v<float>)*(1 + cosine * cosine);
}

float draw_versine(const IsotropicPhase& /*phase*/, float u) {
  return 2 * u;
}

// The inverse cumulative distribution, solved for 1 - cos. It has no cancellation for |g| near 1.
float draw_versine(const HenyeyGreensteinPhase& phase, float u) {
  const float g = std::abs(phase.g);
  const float d = 1 - g + 2 * g * (1 - u);
  return 2 * (1 - g) * (1 - g) * u * (1 + g * (1 - u)) / (d * d);
}

// The equation cos^3 + 3 cos = 2 q, q in [-2, 2), has one real root, 2 sinh(asinh(q)/3).
float draw_versine(const RayleighPhase& /*phase*/, float u) {
  return 1 - 2 * std::sinh(std::asinh(2 - 4 * u) / 3);
}

// True if pdf and versine are measured from the opposite direction.
bool is_backward(const PhaseFunction& phase) {
  const auto* peaked = std::get_if<HenyeyGreensteinPhase>(&phase);
  return peaked != nullptr && peaked->g < 0;
}

}  // namespace

PhaseSample sample(const PhaseFunction& phase, const Imath::V2f& u) {
  const float versine = std::visit([&u](const auto& p) { return draw_versine(p, u.x); }, phase);
  const float pdf = std::visit([versine](const auto& p) { return density(p, versine); }, phase);
  const float sine = std::sqrt(std::max(0.0F, versine * (2 - versine)));
  const float phi = 2 * std::numbers::pi_v<float> * u.y;
  return {{sine * std::cos(phi), sine * std::sin(phi), is_backward(phase) ? versine - 1 : 1 - versine}, pdf};
}

float pdf(const PhaseFunction& phase, const Imath::V3f& from, const Imath::V3f& to) {
  const float versine = (is_backward(phase) ? from + to : from - to).length2() / 2;
  return std::visit([versine](const auto& p) { return density(p, versine); }, phase);
}

// Fields perpendicular to the scattering plane scatter equally into all directions of it, fields in the plane
// in proportion to the cosine. [Chandrasekhar1960, sec. 16]
std::optional<MuellerMatrix> mueller(const PhaseFunction& phase, const Imath::V3f& from,
                                     const Imath::V3f& to) {
  if (!std::holds_alternative<RayleighPhase>(phase)) return std::nullopt;
  const float cosine = std::clamp(from.dot(to), -1.0F, 1.0F);
  const float both = 1 + cosine * cosine;
  return MuellerMatrix{across(from, to), SampledSpectrum((1 - cosine) * (1 + cosine) / both),
                       SampledSpectrum(1.0F), SampledSpectrum(2 * cosine / both)};
}

}  // namespace abbe
