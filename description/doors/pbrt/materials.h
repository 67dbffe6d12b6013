#pragma once

#include <optional>
#include <string>

#include "description/doors/pbrt/world.h"

namespace abbe::doors::pbrt {

/// A material as a shape uses it.
struct MaterialUse {
  Made made;
  std::string name{};      ///< Of a named material; empty of others.
  std::string inside{};    ///< Name of the medium within; empty without one.
  std::size_t number = 0;  ///< Of the directive without a name, as they are read; 0 before the first.
};

/// The materials of shapes, each converted once; those without a name that are equal are one.
class Materials {
 public:
  explicit Materials(World& world) : world_(world) {}

  /// Name of the material in the scene to be written; an error or what has no counterpart, which is noted, is
  /// replaced by something diffuse.
  [[nodiscard]] std::string name_of(const MaterialUse& use);

 private:
  spec::Material converted(const MaterialUse& use);
  spec::Material mixture(const Made& made);

  World& world_;
  std::map<std::string, std::string> names_{};   // by what is used
  std::map<std::string, std::string> shared_{};  // of those without a name, by what they are
};

}  // namespace abbe::doors::pbrt
