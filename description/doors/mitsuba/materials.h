#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>

#include "description/doors/mitsuba/spectra.h"

namespace abbe::doors::mitsuba {

/// Remembers the indices within all dielectrics of an element, as far as they say them soundly.
void find_matter(const Element& element, World& world);

/// The materials of shapes, each converted once for what is within and for the way v runs.
class Materials {
 public:
  explicit Materials(const World& world) : world_(world) {}

  /// Name of the material in the scene to be written; an error or what has no counterpart, which is noted, is
  /// replaced by something diffuse. `inside` is the matter within or nullptr. Nothing for a surface that is
  /// none, with no matter within.
  [[nodiscard]] std::optional<std::string> name_of(const Element& bsdf, const Element* inside, RunsOfV v);

 private:
  spec::Material converted(const Object& bsdf, const Element* inside, RunsOfV v);
  spec::Material mixture(const Object& blend, RunsOfV v);

  const World& world_;
  std::map<std::tuple<const Element*, const Element*, RunsOfV>, std::string> names_{};
};

}  // namespace abbe::doors::mitsuba
