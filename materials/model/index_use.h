#pragma once

#include <string>
#include <vector>

#include "materials/index/refractive_index.h"
#include "materials/interface/coating.h"

namespace abbe {

/// A refractive index that a material uses, under the name that the material calls it by; refers to both.
struct IndexUse {
  const std::string* name;
  const RefractiveIndex* index;
};

/// Those of a coating.
[[nodiscard]] inline std::vector<IndexUse> indices_of(const Coating& coating) {
  std::vector<IndexUse> uses;
  for (const Coating::Material& film : coating.materials) uses.push_back({&film.index_name, &film.index});
  return uses;
}

/// The index of a surface's own matter and those of the coating on it.
[[nodiscard]] inline std::vector<IndexUse> indices_of(const std::string& name, const RefractiveIndex& index,
                                                      const Coating& coating) {
  std::vector<IndexUse> uses = indices_of(coating);
  uses.insert(uses.begin(), {&name, &index});
  return uses;
}

}  // namespace abbe
