#include "transport/path/medium_at.h"

#include "scene/shapes/placed.h"

namespace abbe {

GridStretch march_grid(const PlacedGrid& grid, const Shape& shape, const BasicRay<double>& ray,
                       float distance, float column) {
  const BasicRay<double> described = to_description(shape, ray);
  return grid.march(described.origin, described.direction, distance, column);
}

MediumAt medium_at(const Scene& scene, const MediumStack& inside, const SampledSpectrum& wavelengths_nm) {
  if (inside.empty()) return {};
  const ShapeInstance& innermost = scene.shapes[inside.innermost()];
  const Material& material = scene.materials[innermost.material];
  const RefractiveIndex* index = interior(material);
  MediumAt medium;
  if (index != nullptr && index->absorbing()) medium = {true, index->absorption_per_m(wavelengths_nm)};
  const Medium* filling = abbe::medium(material);
  if (filling == nullptr) return medium;
  medium.attenuating = medium.attenuating || filling->absorbs() || filling->scatters();
  if (filling->absorbs()) medium.extinction_per_m += filling->absorption_per_m(wavelengths_nm);
  if (filling->scatters()) {
    medium.scattering = filling;
    medium.scattering_per_m = filling->scattering_per_m(wavelengths_nm);
    medium.extinction_per_m += medium.scattering_per_m;
  }
  if (filling->grid) {
    medium.grid = &*filling->grid;
    medium.grid_shape = &innermost.shape;
  }
  return medium;
}

}  // namespace abbe
