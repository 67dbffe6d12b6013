#pragma once

#include <optional>
#include <string>

#include "importers/pbrt/spectra.h"

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

}  // namespace abbe::importers::pbrt
