#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <ImathVec.h>

#include "importers/pbrt/tokens.h"

namespace abbe::importers::pbrt {

// Errors go to `importer.diagnostics`. Functions throw Error{resource} if the memory limit of
// `importer.inputs` is exceeded.

/// A parameter `"type name" [ values ]` of the file. At least one of the two lists of values is empty, unless
/// the type is "spectrum".
struct Parameter {
  std::string type;  ///< One of pbrt's types, such as "float" or "rgb".
  std::string name;
  std::vector<double> numbers;     ///< Values that are numbers.
  std::vector<std::string> texts;  ///< Quoted strings, or true and false.
  SourcePosition where;
  mutable bool used = false;  ///< True once it has been read or ignored.
  OwnedReservation memory{};  ///< Memory of the parameter; each copy reserves as much.
};

/// The parameters of one directive.
class Parameters {
 public:
  /// Reads the parameters that follow, up to the first token that is not quoted. Empty if there is none.
  /// Returns nothing, after reporting an error, for a parameter without type, name or values, an unknown
  /// type, or values of a wrong type or count.
  [[nodiscard]] static std::optional<Parameters> read(Tokens& tokens, SceneImporter& importer);
  /// Adds the parameters of `defaults` whose names are absent.
  void add_defaults(const Parameters& defaults);

  /// The first parameter called `name`, which is marked as used; nullptr, without an error, if there is none.
  /// Its type must be one of `types`. Reports another type and returns nullptr.
  [[nodiscard]] const Parameter* find(std::string_view name, std::initializer_list<const char*> types,
                                      SceneImporter& importer) const;
  /// True if there is a parameter called `name`, of any type. Does not mark it as used.
  [[nodiscard]] bool has(std::string_view name) const;
  // Parameters with a single value; `fallback` if absent. Several values and another type are reported, and
  // `fallback` is returned.
  /// A "float".
  [[nodiscard]] double number(std::string_view name, double fallback, SceneImporter& importer) const;
  /// An "integer", as a double that holds a whole number of any size.
  [[nodiscard]] double integer(std::string_view name, double fallback, SceneImporter& importer) const;
  [[nodiscard]] bool boolean(std::string_view name, bool fallback, SceneImporter& importer) const;
  /// A "string", or the name of a "texture".
  [[nodiscard]] std::string text(std::string_view name, const std::string& fallback,
                                 SceneImporter& importer) const;
  /// A "point3", "point", "vector3" or "vector" of three numbers.
  [[nodiscard]] Imath::V3d point(std::string_view name, const Imath::V3d& fallback,
                                 SceneImporter& importer) const;
  /// All numbers of a parameter of numbers, points, vectors or normals; empty if absent. Reports another type
  /// and returns an empty list.
  [[nodiscard]] std::vector<double> numbers(std::string_view name, SceneImporter& importer) const;

  /// Marks the parameters called `names`, which have no effect in Abbe, as used. Absent ones are no error.
  void ignore(std::initializer_list<std::string_view> names) const;
  /// Notes every parameter that is not marked as used as dropped. `of` names their directive in the notes.
  void note_unused(const std::string& of, SceneImporter& importer) const;
  [[nodiscard]] const std::vector<Parameter>& all() const { return list_; }

 private:
  [[nodiscard]] const Parameter* single(std::string_view name, std::initializer_list<const char*> types,
                                        std::size_t count, SceneImporter& importer) const;

  std::vector<Parameter> list_;
};

}  // namespace abbe::importers::pbrt
