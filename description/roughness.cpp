#include <algorithm>

#include <fmt/format.h>

#include "description/index.h"

namespace abbe::description {
namespace {

Imath::V2f widths(double alpha) {
  return Imath::V2f(static_cast<float>(alpha));
}
Imath::V2f widths(const std::array<double, 2>& alpha) {
  return {static_cast<float>(alpha[0]), static_cast<float>(alpha[1])};
}
Imath::V2f widths(const spec::Facets& facets) {
  return std::visit([](const auto& alpha) { return widths(alpha); }, facets.alpha);
}

}  // namespace

std::optional<Microfacets<float>> build(const spec::Roughness& spec, const Coating& coating,
                                        LoadContext& context) {
  const Imath::V2f alpha = std::visit([](const auto& form) { return widths(form); }, spec.value);
  const auto* facets = std::get_if<spec::Facets>(&spec.value);
  const FacetShape shape = facets ? facets->distribution : FacetShape::ggx;
  constexpr auto min_alpha = static_cast<float>(kMinAlpha);
  if (std::max(alpha.x, alpha.y) < min_alpha) return std::nullopt;
  if (!coating.layers.empty()) context.diagnostics.error(spec.where, "a coating needs a smooth surface");
  const float wide = std::max(alpha.x, alpha.y);
  const float narrow = std::max(std::min(alpha.x, alpha.y), min_alpha);
  if (wide > narrow * static_cast<float>(kMaxAlphaRatio))
    context.diagnostics.error(
        spec.where, fmt::format("the two alphas must not differ by more than a factor of {} (got {} and {})",
                                kMaxAlphaRatio, alpha.x, alpha.y));
  return Microfacets<float>{shape, std::max(alpha.x, min_alpha), std::max(alpha.y, min_alpha)};
}

}  // namespace abbe::description
