#include "materials/material.h"

#include <cmath>

#include <fmt/format.h>

#include "materials/interface/fresnel.h"

namespace abbe {
namespace {

// The model's answer to `ask`, or a value-initialised one if it has no such member function.
template <typename T, typename Ask>
T answer(const Material& material, Ask ask) {
  return std::visit(
      [&]<typename Model>(const Model& model) -> T {
        if constexpr (std::invocable<Ask, const Model&>)
          return ask(model);
        else
          return T{};
      },
      material.model);
}

}  // namespace

Bsdf make_bsdf(const Material& material, const SurfaceLookup& at) {
  return std::visit([&at](const auto& model) { return as_bsdf(model.bsdf(at)); }, material.model);
}

Lobes lobes(const Material& material) {
  return std::visit([](const auto& model) { return model.lobes(); }, material.model);
}

bool needs_coordinates(const Material& material) {
  return material.relief || answer<bool>(material, [](const auto& m) -> decltype(m.needs_coordinates()) {
           return m.needs_coordinates();
         });
}

bool is_dispersive(const Material& material) {
  const RefractiveIndex* inside = interior_index(material);
  return inside && inside->dispersive();
}

bool depends_on_outside(const Material& material) {
  return answer<bool>(
      material, [](const auto& m) -> decltype(m.depends_on_outside()) { return m.depends_on_outside(); });
}

bool opaque(const Material& material) {
  return answer<bool>(material, [](const auto& m) -> decltype(m.opaque()) { return m.opaque(); });
}

bool preserves_polarisation(const Material& material) {
  return answer<bool>(material, [](const auto& m) -> decltype(m.preserves_polarisation()) {
    return m.preserves_polarisation();
  });
}

bool polarises(const Material& material) {
  return answer<std::optional<bool>>(material,
                                     [](const auto& m) -> decltype(m.polarises()) { return m.polarises(); })
      .value_or(lobes(material).delta && !preserves_polarisation(material));
}

const RefractiveIndex* interior_index(const Material& material) {
  return answer<const RefractiveIndex*>(
      material, [](const auto& m) -> decltype(m.interior_index()) { return m.interior_index(); });
}

const Medium* medium(const Material& material) {
  return answer<const Medium*>(material, [](const auto& m) -> decltype(m.medium()) { return m.medium(); });
}

std::optional<std::string> transparency_fault(const Material& material, double wavelength_nm) {
  constexpr double kTolerance = 1e-4;
  const auto* sheet = answer<const RefractiveIndex*>(
      material, [](const auto& m) -> decltype(m.clear_index()) { return m.clear_index(); });
  const RefractiveIndex* index = sheet != nullptr ? sheet : interior_index(material);
  if (index == nullptr) return std::nullopt;
  const double n = index->n(wavelength_nm);
  const double k = index->k(wavelength_nm);
  const double clear = fresnel_conductor(1.0, n, 0.0).R();
  const double exact = fresnel_conductor(1.0, n, k).R();
  if (std::abs(exact - clear) <= kTolerance) return std::nullopt;
  return fmt::format(
      "\"{}\" is not clear: with n = {:.4g} and k = {:.4g} at {:g} nm it reflects {:.4f} along the normal, "
      "but dielectrics and thin glass are computed from n alone and reflect {:.4f}: use a conductor",
      material.name, n, k, wavelength_nm, exact, clear);
}

std::vector<IndexUse> indices(const Material& material) {
  return answer<std::vector<IndexUse>>(material,
                                       [](const auto& m) -> decltype(m.indices()) { return m.indices(); });
}

std::size_t texture_bytes(const Material& material) {
  auto bytes = answer<std::size_t>(
      material, [](const auto& m) -> decltype(m.texture_bytes()) { return m.texture_bytes(); });
  if (material.relief)
    bytes += std::visit([](const auto& map) { return map.image.memory_bytes(); }, *material.relief);
  return bytes;
}

bool encloses_medium(const Material& material) {
  return interior_index(material) != nullptr || medium(material) != nullptr;
}

bool is_boundary(const Material& material) {
  return std::holds_alternative<MediumMaterial>(material.model);
}

std::optional<FresnelPower<double>> smooth_power(const Material& material, const SmoothLookup& at) {
  return answer<std::optional<FresnelPower<double>>>(
      material, [&](const auto& m) -> decltype(m.smooth_power(at)) { return m.smooth_power(at); });
}

std::optional<SmoothMueller> smooth_mueller(const Material& material, const SmoothLookup& at) {
  if (!smooth_power(material, at)) return std::nullopt;
  return answer<std::optional<SmoothMueller>>(
      material, [&](const auto& m) -> decltype(m.smooth_mueller(at)) { return m.smooth_mueller(at); });
}

}  // namespace abbe
