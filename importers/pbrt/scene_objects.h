#pragma once

#include <optional>
#include <string>
#include <vector>

#include <ImathMatrix.h>

#include "importers/pbrt/spectra.h"
#include "importers/shared/placement.h"

namespace abbe::importers::pbrt {

/// The material directive that a shape uses, with its interior medium.
struct MaterialUse {
  Directive directive;
  std::string name{};      ///< Name of a named material; otherwise empty.
  std::string interior{};  ///< Name of the interior medium; empty if there is none.
  /// Number of the unnamed material directive in reading order, counted from 1; 0 for pbrt's default
  /// material.
  std::size_t number = 0;
};

/// Converts the materials of shapes, each once per interior medium. Equal unnamed materials become one. The
/// state must outlive it.
class Materials {
 public:
  explicit Materials(ImportState& state) : import_(state) {}

  /// Name of the converted material in the written scene. An unknown type is reported, a type without a
  /// counterpart is noted; both become diffuse.
  [[nodiscard]] std::string name_of(const MaterialUse& use);

 private:
  spec::Material converted(const MaterialUse& use);
  spec::Material mixture(const Directive& directive);

  ImportState& import_;
  std::map<std::string, std::string> names_{};    // By `MaterialUse`.
  std::map<std::string, std::string> unnamed_{};  // Names of unnamed materials, by their JSON text.
};

/// Adds the shape of a directive to `shapes`, which belongs to an owner of the kind `owner`. `shape` has its
/// matrix, material and orientation, `light` is its area light. Some shapes become an object and an instance
/// instead; see `append_shape`. Reports unknown types, missing parameters and missing files; such a shape is
/// left out. Types of pbrt without a counterpart, emission inside objects and unsupported parameters are
/// noted and dropped.
void add_shape(const Directive& directive, const std::optional<Directive>& light, ImportedShape shape,
               ShapeOwner owner, std::vector<spec::Shape>& shapes, ImportState& state);

/// Adds a LightSource to the scene. `to_world` leads from its coordinates to those of the written scene. A
/// type of pbrt without a counterpart in Abbe is noted and dropped. Reports an unknown type and unreadable
/// images.
void add_light(const Directive& light, const Imath::M44d& to_world, ImportState& state);

}  // namespace abbe::importers::pbrt
