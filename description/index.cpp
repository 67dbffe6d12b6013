#include "description/index.h"

#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "materials/index/library.h"

namespace abbe::description {
namespace {

// k of an absorption coefficient alpha [1/m]: alpha lambda/(4 pi), lambda in metres.
Curve extinction(const Curve& absorption_per_m) {
  const auto k = [](double nm) { return nm * 1e-9 / (4 * std::numbers::pi); };
  const Curve per_alpha(
      std::vector<Knot>{{kMinWavelengthNm, k(kMinWavelengthNm)}, {kMaxWavelengthNm, k(kMaxWavelengthNm)}});
  return product(absorption_per_m, per_alpha);
}

Ior constant_ior(double n, double k) {
  return {k > 0 ? fmt::format("{} + {}i", n, k) : fmt::format("{}", n), RefractiveIndex(n, k), true};
}

}  // namespace

std::optional<Ior> build(const spec::Ior& said, LoadContext& context) {
  if (const auto* n = std::get_if<double>(&said.value)) return constant_ior(*n, 0);
  if (const auto* constant = std::get_if<spec::ConstantIor>(&said.value))
    return constant_ior(constant->n, constant->k);
  if (const auto* constant = std::get_if<spec::MetalIor>(&said.value))
    return constant_ior(constant->n, constant->k);
  const auto name = context.table(std::get<std::string>(said.value), said.where);
  if (!name) return std::nullopt;
  auto named = load_index(*name, said.where, context.diagnostics);
  if (!named) return std::nullopt;
  return Ior{std::move(named->name), std::move(named->index), false};
}

std::optional<Ior> build(const spec::TintedIor& said, LoadContext& context) {
  auto ior = build(said.ior, context);
  if (!ior || !said.absorption_per_m) return ior;
  if (!ior->constant || ior->index.absorbing()) {
    context.diagnostics.error(said.absorption_per_m->where,
                              "absorption_per_m goes with a constant real index; this one brings its own k");
    return std::nullopt;
  }
  const auto alpha = build(*said.absorption_per_m, {"filter", spec::kPower}, context);
  if (!alpha) return std::nullopt;
  ior->index = RefractiveIndex(Curve(ior->index.catalogued_n(kMinWavelengthNm)), extinction(*alpha),
                               IndexMedium::air, kMinWavelengthNm, kMaxWavelengthNm);
  return ior;
}

}  // namespace abbe::description
