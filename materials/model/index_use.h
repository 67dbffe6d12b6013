#pragma once

#include <string>
#include <vector>

#include "materials/index/refractive_index.h"
#include "materials/interface/coating.h"

namespace abbe {

/// A refractive index that a material uses, with its name in that material. The material owns both and must
/// outlive this.
struct IndexUse {
  const std::string* name;
  const RefractiveIndex* index;
};

/// The indices of a coating, one for each entry of `Coating::materials`.
[[nodiscard]] inline std::vector<IndexUse> indices_of(const Coating& coating) {
  std::vector<IndexUse> uses;
  for (const Coating::Material& film : coating.materials) uses.push_back({&film.index_name, &film.index});
  return uses;
}

/// The index inside a surface under the name `name`, followed by those of its coating.
[[nodiscard]] inline std::vector<IndexUse> indices_of(const std::string& name, const RefractiveIndex& index,
                                                      const Coating& coating) {
  std::vector<IndexUse> uses = indices_of(coating);
  uses.insert(uses.begin(), {&name, &index});
  return uses;
}

}  // namespace abbe
