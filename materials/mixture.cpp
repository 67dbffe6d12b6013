#include "materials/model/mixture.h"

#include <algorithm>

#include "materials/material.h"

namespace abbe {

Lobes MixtureMaterial::lobes() const {
  Lobes all;
  for (const Component& component : components) {
    const Lobes own = abbe::lobes(*component.material);
    all = {all.delta || own.delta, all.spread || own.spread};
  }
  return all;
}

bool MixtureMaterial::needs_coordinates() const {
  return std::any_of(components.begin(), components.end(),
                     [](const Component& component) { return abbe::needs_coordinates(*component.material); });
}

bool MixtureMaterial::depends_on_outside() const {
  return std::any_of(components.begin(), components.end(), [](const Component& component) {
    return abbe::depends_on_outside(*component.material);
  });
}

bool MixtureMaterial::opaque() const {
  return std::all_of(components.begin(), components.end(),
                     [](const Component& component) { return abbe::opaque(*component.material); });
}

}  // namespace abbe
