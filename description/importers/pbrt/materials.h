#pragma once

#include <optional>
#include <string>

#include "description/importers/pbrt/import_state.h"

namespace abbe::importers::pbrt {

/// The material directive that a shape uses, with its interior medium.
struct MaterialUse {
  Directive directive;
  std::string name{};      ///< Name of a named material; otherwise empty.
  std::string interior{};  ///< Name of the interior medium; empty if there is none.
  std::size_t number = 0;  ///< Number of the unnamed material directive in reading order; 0 before the first.
};

/// Converts the materials of shapes, each once. Equal unnamed materials become one.
class Materials {
 public:
  explicit Materials(ImportState& state) : import_(state) {}

  /// Name of the converted material. Errors, and materials without a counterpart, which are noted, become
  /// diffuse.
  [[nodiscard]] std::string name_of(const MaterialUse& use);

 private:
  spec::Material converted(const MaterialUse& use);
  spec::Material mixture(const Directive& directive);

  ImportState& import_;
  std::map<std::string, std::string> names_{};    // By `MaterialUse`.
  std::map<std::string, std::string> unnamed_{};  // Names of unnamed materials, by their JSON text.
};

}  // namespace abbe::importers::pbrt
