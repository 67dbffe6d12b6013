#include <utility>
#include <vector>

#include <fmt/format.h>

#include "description/material.h"
#include "materials/interface/fresnel.h"

namespace abbe::description {
namespace {

constexpr double kClear = 1e-3;  // more k than any glass or varnish has, less than any metal

// Why `index` cannot be a coat's, if it cannot.
std::optional<std::string> coat_fault(const RefractiveIndex& index) {
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) {
    if (index.n(nm) < 1)
      return fmt::format("a coat is denser than air (got n = {:g} at {} nm)", index.n(nm), nm);
    if (index.k(nm) > kClear)
      return fmt::format("a coat is clear (got k = {:g} at {} nm, allowed [0, {:g}])", index.k(nm), nm,
                         kClear);
  }
  return std::nullopt;
}

// What matter of this index reflects along the normal.
Curve normal_reflectance(const RefractiveIndex& index) {
  std::vector<Knot> knots;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm)
    knots.push_back({static_cast<double>(nm), fresnel_conductor(1.0, index.n(nm), index.k(nm)).R()});
  return Curve(std::move(knots));
}

/// Each material of the list from what is said of it; none after an error.
struct ModelBuilder {
  using Model = std::optional<MaterialModel>;
  LoadContext& context;

  Model operator()(std::monostate) const { return std::nullopt; }
  Model operator()(const spec::Mixture&) const { return MixtureMaterial{}; }  // whose parts come later
  Model operator()(const spec::Diffuse& said) const {
    auto reflectance = build(said.reflectance, context);
    if (!reflectance) return std::nullopt;
    return DiffuseMaterial{std::move(*reflectance)};
  }
  Model operator()(const spec::Dielectric& said) const {
    auto ior = build(said.ior, context);
    auto filling = build(said.scattering, std::nullopt, context);
    Coating coating = build(said.coating, context);
    const auto facets = said.roughness ? build(*said.roughness, coating, context) : std::nullopt;
    if (!ior || !filling) return std::nullopt;
    if (!filling->scatters()) filling.reset();
    if (facets)
      return RoughDielectricMaterial(std::move(ior->name), std::move(ior->index), *facets,
                                     std::move(filling));
    return DielectricMaterial{std::move(ior->name), std::move(ior->index), std::move(coating),
                              std::move(filling)};
  }
  Model operator()(const spec::Conductor& said) const {
    auto ior = build(said.ior, context);
    Coating coating = build(said.coating, context);
    const auto facets = said.roughness ? build(*said.roughness, coating, context) : std::nullopt;
    if (!ior) return std::nullopt;
    if (facets) return RoughConductorMaterial(std::move(ior->name), std::move(ior->index), *facets);
    return ConductorMaterial{std::move(ior->name), std::move(ior->index), std::move(coating)};
  }
  Model operator()(const spec::Film& said) const {
    return DielectricMaterial{"air", RefractiveIndex(1), build(said.layers, context)};
  }
  Model operator()(const spec::Medium& said) const {
    auto filling = build(said.scattering, said.absorption_per_m, context);
    if (!filling) return std::nullopt;
    if (said.grid && !(filling->grid = build(*said.grid, context))) return std::nullopt;
    return MediumMaterial{std::move(*filling)};
  }
  Model operator()(const spec::CoatedDiffuse& said) const {
    auto ior = build(said.ior, context);
    auto reflectance = build(said.reflectance, context);
    if (!ior || !reflectance) return std::nullopt;
    if (const auto fault = coat_fault(ior->index)) {
      context.diagnostics.error(said.ior.where, *fault);
      return std::nullopt;
    }
    return CoatedDiffuseMaterial{std::move(ior->name), std::move(ior->index), std::move(*reflectance)};
  }
  Model operator()(const spec::ThinGlass& said) const {
    auto ior = build(said.ior, context);
    if (!ior) return std::nullopt;
    return ThinGlassMaterial{std::move(ior->name), std::move(ior->index), said.thickness * context.unit_m};
  }
  Model operator()(const spec::Mirror& said) const {
    auto reflectance = build(said.reflectance, context);
    if (!reflectance) return std::nullopt;
    return MirrorMaterial{std::move(*reflectance)};
  }
  Model operator()(const spec::Schlick& said) const {
    std::optional<SpectralTexture> r0;
    if (const auto* reflectance = std::get_if<spec::Reflectance>(&said.normal))
      r0 = build(*reflectance, context);
    else if (const auto ior = build(std::get<spec::Ior>(said.normal), context))
      r0 = normal_reflectance(ior->index);
    if (!r0) return std::nullopt;
    return SchlickMaterial{std::move(*r0)};
  }
  Model operator()(const spec::OrenNayar& said) const {
    auto reflectance = build(said.reflectance, context);
    if (!reflectance) return std::nullopt;
    return OrenNayarMaterial{std::move(*reflectance), said.sigma_deg};
  }
  Model operator()(const spec::Principled& said) const {
    auto base = build(said.base_color, context);
    if (!base) return std::nullopt;
    const auto amount = [](double x) { return static_cast<float>(x); };
    const PrincipledLook look{amount(said.metallic), amount(said.roughness), amount(said.specular),
                              amount(said.sheen),    amount(said.clearcoat), amount(said.clearcoat_gloss)};
    return PrincipledMaterial{std::move(*base), Principled(look)};
  }
  Model operator()(const spec::CosinePower& said) const {
    auto reflectance = build(said.power.reflectance, context);
    if (!reflectance) return std::nullopt;
    return CosinePowerMaterial{std::move(*reflectance), said.power.exponent, said.reciprocal};
  }
  Model operator()(const spec::Phong& said) const {
    auto reflectance = build(said.power.reflectance, context);
    if (!reflectance) return std::nullopt;
    return PhongMaterial{std::move(*reflectance), said.power.exponent};
  }
  Model operator()(const spec::Retroreflector& said) const {
    auto reflectance = build(said.power.reflectance, context);
    if (!reflectance) return std::nullopt;
    return RetroreflectorMaterial{std::move(*reflectance), said.power.exponent};
  }
};

}  // namespace

std::optional<MaterialModel> build_model(const spec::Material& material, LoadContext& context) {
  return std::visit(ModelBuilder{context}, material.model);
}

}  // namespace abbe::description
