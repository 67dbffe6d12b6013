#include "materials/bsdf/bsdf.h"

namespace abbe {

std::optional<BsdfSample> sample(const Bsdf& bsdf, const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                 TransportMode mode) {
  return std::visit([&](const auto& model) { return model.sample(wo, u, hero, mode); }, bsdf);
}

SampledSpectrum eval(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) {
  return std::visit([&](const auto& model) { return model.eval(wo, wi, mode); }, bsdf);
}

SampledSpectrum pdf(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi) {
  return std::visit([&](const auto& model) { return model.pdf(wo, wi); }, bsdf);
}

bool is_delta(const Bsdf& bsdf) {
  return std::visit([](const auto& model) { return model.delta(); }, bsdf);
}

bool is_black(const Bsdf& bsdf) {
  const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
  return diffuse != nullptr && diffuse->reflectance.is_zero();
}

}  // namespace abbe
