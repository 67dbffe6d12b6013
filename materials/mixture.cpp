#include "materials/model/mixture.h"

#include <algorithm>

#include "materials/material.h"

namespace abbe {

Lobes MixtureMaterial::lobes() const {
  Lobes all;
  for (const Part& part : parts) {
    const Lobes own = abbe::lobes(*part.material);
    all = {all.delta || own.delta, all.spread || own.spread};
  }
  return all;
}

bool MixtureMaterial::needs_coordinates() const {
  return std::any_of(parts.begin(), parts.end(),
                     [](const Part& part) { return abbe::needs_coordinates(*part.material); });
}

bool MixtureMaterial::depends_on_outside() const {
  return std::any_of(parts.begin(), parts.end(),
                     [](const Part& part) { return abbe::depends_on_outside(*part.material); });
}

}  // namespace abbe
