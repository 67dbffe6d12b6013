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

std::optional<Microfacets<float>> build(const spec::Roughness& said, const Coating& coating,
                                        LoadContext& context) {
  const Imath::V2f alpha = std::visit([](const auto& form) { return widths(form); }, said.value);
  const auto* facets = std::get_if<spec::Facets>(&said.value);
  const FacetShape shape = facets ? facets->distribution : FacetShape::ggx;
  constexpr auto kLeast = static_cast<float>(kLeastAlpha);
  if (std::max(alpha.x, alpha.y) < kLeast) return std::nullopt;
  if (!coating.layers.empty())
    context.diagnostics.error(said.where, "a coating lies on smooth surfaces only");
  const float wide = std::max(alpha.x, alpha.y);
  const float narrow = std::max(std::min(alpha.x, alpha.y), kLeast);
  if (wide > narrow * static_cast<float>(kMostStretch))
    context.diagnostics.error(said.where, fmt::format("alphas more than {} times apart (got {} and {})",
                                                      kMostStretch, alpha.x, alpha.y));
  return Microfacets<float>{shape, std::max(alpha.x, kLeast), std::max(alpha.y, kLeast)};
}

}  // namespace abbe::description
