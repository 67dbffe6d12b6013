#pragma once

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "importers/mitsuba/object.h"
#include "importers/mitsuba/spectra.h"
#include "importers/shared/placement.h"

namespace abbe::importers::mitsuba {

/// Adds the valid interior indices of all dielectrics inside an element to `state.interior_indices`.
void collect_dielectric_indices(const Element& element, ImportState& state);

/// Converts the materials of shapes, each once per interior medium and v direction. The state must outlive
/// it.
class Materials {
 public:
  explicit Materials(const ImportState& state) : import_(state) {}

  /// Name of the converted material in the written scene. `bsdf` is a <bsdf> element; `interior` is the
  /// <medium> inside the shape or nullptr; `v` is the direction of v in the shape's texture coordinates. A
  /// material of an unknown type is reported, one without a counterpart is noted; both become diffuse.
  /// Nothing, without an error, for a "null" surface without an interior medium.
  [[nodiscard]] std::optional<std::string> name_of(const Element& bsdf, const Element* interior,
                                                   VDirection v);

 private:
  spec::Material converted(const Object& bsdf, const Element* interior, VDirection v);
  spec::Material mixture(const Object& blend, VDirection v);

  const ImportState& import_;
  std::map<std::tuple<const Element*, const Element*, VDirection>, std::string> names_{};
};

/// Converts a <shape>:
/// - A shape group becomes an object of `state.importer.scene`.
/// - An instance is added to the shapes of that scene.
/// - Any other shape is added to `shapes`, or becomes an object and an instance; see `append_shape`.
/// - A shape with neither a surface nor a medium nor an emitter is left out.
/// `owner` is the kind of the owner of `shapes`. Reports unknown types, missing files and an instance without
/// one shape group.
void add_shape(const Object& shape, ShapeOwner owner, std::vector<spec::Shape>& shapes, Materials& materials);

/// Adds an <emitter> that is not an area light. A type of Mitsuba without a counterpart in Abbe is noted and
/// dropped. Reports an unknown type, malformed properties and missing files.
void add_light(const Object& light);

}  // namespace abbe::importers::mitsuba
