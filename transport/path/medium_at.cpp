#include "transport/path/medium_at.h"

#include "scene/shapes/shape.h"

namespace abbe {

GridSegment march_grid_along(const PlacedGrid& grid, const Shape& shape, const BasicRay<double>& ray,
                             float distance, float column) {
  const BasicRay<double> described = to_description(shape, ray);
  return grid.march(described.origin, described.direction, distance, column);
}

MediumAt medium_at(const Scene& scene, const MediumStack& stack, const SampledSpectrum& wavelengths_nm) {
  if (stack.empty()) return {};
  const ShapeInstance& innermost = scene.shapes[stack.innermost()];
  const Material& material = scene.materials[innermost.material];
  const RefractiveIndex* index = interior_index(material);
  MediumAt medium;
  if (index != nullptr && index->absorbing()) medium = {true, index->absorption_per_m(wavelengths_nm)};
  const Medium* interior_medium = abbe::medium(material);
  if (interior_medium == nullptr) return medium;
  medium.attenuating = medium.attenuating || interior_medium->absorbs() || interior_medium->scatters();
  if (interior_medium->absorbs())
    medium.extinction_per_m += interior_medium->absorption_per_m(wavelengths_nm);
  if (interior_medium->scatters()) {
    medium.scattering = interior_medium;
    medium.scattering_per_m = interior_medium->scattering_per_m(wavelengths_nm);
    medium.extinction_per_m += medium.scattering_per_m;
  }
  if (interior_medium->grid) {
    medium.grid = &*interior_medium->grid;
    medium.grid_shape = &innermost.shape;
  }
  return medium;
}

}  // namespace abbe
