#include "materials/material.h"

namespace abbe {

Bsdf make_bsdf(const Material& material, const SurfaceLookup& at) {
  return std::visit([&at](const auto& model) { return model.bsdf(at); }, material.model);
}

Lobes lobes(const Material& material) {
  return std::visit([](const auto& model) { return model.lobes(); }, material.model);
}

bool needs_coordinates(const Material& material) {
  if (material.relief) return true;
  return std::visit(
      [](const auto& model) {
        if constexpr (requires { model.needs_coordinates(); })
          return model.needs_coordinates();
        else
          return false;
      },
      material.model);
}

bool is_dispersive(const Material& material) {
  const RefractiveIndex* inside = interior(material);
  return inside && inside->dispersive();
}

bool depends_on_outside(const Material& material) {
  return std::visit(
      [](const auto& model) {
        if constexpr (requires { model.depends_on_outside(); })
          return model.depends_on_outside();
        else
          return requires {
            model.index;
          };
      },
      material.model);
}

const RefractiveIndex* interior(const Material& material) {
  return std::visit(
      [](const auto& model) -> const RefractiveIndex* {
        if constexpr (requires { model.interior(); })
          return model.interior();
        else
          return nullptr;
      },
      material.model);
}

const Medium* medium(const Material& material) {
  return std::visit(
      [](const auto& model) -> const Medium* {
        if constexpr (requires { model.medium(); })
          return model.medium();
        else
          return nullptr;
      },
      material.model);
}

bool encloses_medium(const Material& material) {
  return interior(material) != nullptr || medium(material) != nullptr;
}

bool is_boundary(const Material& material) {
  return std::holds_alternative<MediumMaterial>(material.model);
}

}  // namespace abbe
