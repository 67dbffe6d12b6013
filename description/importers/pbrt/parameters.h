#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <ImathVec.h>

#include "description/importers/pbrt/tokens.h"

namespace abbe::importers::pbrt {

/// A parameter `"type name" [ values ]` of the file.
struct Parameter {
  std::string type;
  std::string name;
  std::vector<double> numbers;
  std::vector<std::string> texts;  ///< Quoted strings, or true and false.
  SourcePosition where;
  mutable bool used = false;
  OwnedReservation memory{};  ///< Memory of the parameter; each copy reserves as much.
};

/// The parameters of one directive.
class Parameters {
 public:
  /// Reads the parameters that follow. Nothing, after reporting an error, for a parameter without type, name
  /// or values, an unknown type, or values of a wrong type or count.
  [[nodiscard]] static std::optional<Parameters> read(Tokens& tokens, SceneImporter& importer);
  /// Adds the parameters of `defaults` that are absent.
  void add_defaults(const Parameters& defaults);

  /// The parameter called `name`, which is marked as used. Its type must be one of `types`; others are
  /// reported. nullptr if there is none.
  [[nodiscard]] const Parameter* find(std::string_view name, std::initializer_list<const char*> types,
                                      SceneImporter& importer) const;
  [[nodiscard]] bool has(std::string_view name) const;
  // Parameters with a single value of one type, or `fallback` if absent. Several values are reported.
  [[nodiscard]] double number(std::string_view name, double fallback, SceneImporter& importer) const;
  [[nodiscard]] double integer(std::string_view name, double fallback, SceneImporter& importer) const;
  [[nodiscard]] bool boolean(std::string_view name, bool fallback, SceneImporter& importer) const;
  [[nodiscard]] std::string text(std::string_view name, const std::string& fallback,
                                 SceneImporter& importer) const;
  [[nodiscard]] Imath::V3d point(std::string_view name, const Imath::V3d& fallback,
                                 SceneImporter& importer) const;
  /// All numbers of a parameter; empty if absent.
  [[nodiscard]] std::vector<double> numbers(std::string_view name, SceneImporter& importer) const;

  /// Marks parameters that have no effect in Abbe as used.
  void ignore(std::initializer_list<std::string_view> names) const;
  /// Notes every parameter that is not marked as used. `of` names their directive in the notes.
  void note_unused(const std::string& of, SceneImporter& importer) const;
  [[nodiscard]] const std::vector<Parameter>& all() const { return list_; }

 private:
  [[nodiscard]] const Parameter* single(std::string_view name, std::initializer_list<const char*> types,
                                        std::size_t count, SceneImporter& importer) const;

  std::vector<Parameter> list_;
};

}  // namespace abbe::importers::pbrt
