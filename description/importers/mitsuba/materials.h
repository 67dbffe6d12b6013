#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "description/importers/mitsuba/spectra.h"

namespace abbe::importers::mitsuba {

/// Collects the interior refractive indices of all dielectrics in an element, as far as they are valid.
void collect_dielectric_indices(const Element& element, ImportState& state);

/// Converts the materials of shapes, each once per interior medium and v direction.
class Materials {
 public:
  explicit Materials(const ImportState& state) : import_(state) {}

  /// Name of the converted material. `interior` is the interior medium or nullptr. Errors, and materials
  /// without a counterpart, which are noted, become diffuse. Nothing for a "null" surface without an interior
  /// medium.
  [[nodiscard]] std::optional<std::string> name_of(const Element& bsdf, const Element* interior,
                                                   VDirection v);

 private:
  spec::Material converted(const Object& bsdf, const Element* interior, VDirection v);
  spec::Material mixture(const Object& blend, VDirection v);

  const ImportState& import_;
  std::map<std::tuple<const Element*, const Element*, VDirection>, std::string> names_{};
};

}  // namespace abbe::importers::mitsuba
