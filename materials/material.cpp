#include "materials/material.h"

namespace abbe {

Bsdf make_bsdf(const Material& material, const SampledSpectrum& wavelengths_nm) {
  struct {
    const SampledSpectrum& nm;
    Bsdf operator()(const DiffuseMaterial& m) const { return DiffuseBsdf{m.reflectance(nm)}; }
    Bsdf operator()(const DielectricMaterial& m) const {
      if (!m.coating.layers.empty()) return CoatedDielectricBsdf{nm, &m.index, &m.coating};
      return DielectricBsdf{m.index.n(nm), m.index.dispersive()};
    }
    Bsdf operator()(const ConductorMaterial& m) const {
      if (!m.coating.layers.empty()) return CoatedConductorBsdf{nm, &m.index, &m.coating};
      return ConductorBsdf{m.index.n(nm), m.index.k(nm)};
    }
  } const make{wavelengths_nm};
  return std::visit(make, material.model);
}

bool is_specular(const Material& material) {
  return !std::holds_alternative<DiffuseMaterial>(material.model);
}

bool is_dispersive(const Material& material) {
  const RefractiveIndex* inside = interior(material);
  return inside && inside->dispersive();
}

const RefractiveIndex* interior(const Material& material) {
  const auto* dielectric = std::get_if<DielectricMaterial>(&material.model);
  return dielectric ? &dielectric->index : nullptr;
}

}  // namespace abbe
