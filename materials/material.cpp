#include "materials/material.h"

#include <cmath>

#include <fmt/format.h>

#include "materials/interface/fresnel.h"

namespace abbe {

Bsdf make_bsdf(const Material& material, const SurfaceLookup& at) {
  return std::visit([&at](const auto& model) { return model.bsdf(at); }, material.model);
}

Lobes lobes(const Material& material) {
  return std::visit([](const auto& model) { return model.lobes(); }, material.model);
}

bool needs_coordinates(const Material& material) {
  return material.relief ||
         std::visit([](const auto& model) { return model.needs_coordinates(); }, material.model);
}

bool is_dispersive(const Material& material) {
  const RefractiveIndex* inside = interior_index(material);
  return inside && inside->dispersive();
}

bool depends_on_outside(const Material& material) {
  return std::visit([](const auto& model) { return model.depends_on_outside(); }, material.model);
}

bool opaque(const Material& material) {
  return std::visit([](const auto& model) { return model.opaque(); }, material.model);
}

const RefractiveIndex* interior_index(const Material& material) {
  return std::visit([](const auto& model) { return model.interior_index(); }, material.model);
}

const Medium* medium(const Material& material) {
  return std::visit([](const auto& model) { return model.medium(); }, material.model);
}

std::optional<std::string> transparency_fault(const Material& material, double wavelength_nm) {
  constexpr double kTolerance = 1e-4;
  const auto* pane = std::get_if<ThinGlassMaterial>(&material.model);
  const RefractiveIndex* index = pane != nullptr ? &pane->index : interior_index(material);
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
  return std::visit([](const auto& model) { return model.indices(); }, material.model);
}

std::size_t texture_bytes(const Material& material) {
  std::size_t bytes = std::visit([](const auto& model) { return model.texture_bytes(); }, material.model);
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

}  // namespace abbe
