#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <ImathVec.h>

#include "description/doors/pbrt/tokens.h"

namespace abbe::doors::pbrt {

/// `"type name" [ values ]`, as it stands in the file.
struct Parameter {
  std::string type;
  std::string name;
  std::vector<double> numbers;
  std::vector<std::string> texts;  ///< Quoted, or true and false.
  SourcePosition where;
  mutable bool used = false;
  OwnedMemory memory{};  ///< Counts the parameter, wherever it is copied to.
};

/// The parameters of one directive.
class Parameters {
 public:
  /// Reads those that follow. Reports, and ends the reading with, a parameter without type, name or values,
  /// an unknown type, and values that are not of the type or not as many as it takes.
  [[nodiscard]] static std::optional<Parameters> read(Tokens& tokens, Door& door);
  /// Adds those of `defaults` that are not there.
  void complete(const Parameters& defaults);

  /// The parameter of that name, used from now on; of one of the types, another is reported.
  [[nodiscard]] const Parameter* find(std::string_view name, std::initializer_list<const char*> types,
                                      Door& door) const;
  [[nodiscard]] bool has(std::string_view name) const;
  // The same of one kind and one value each, or what holds in its absence; more values are reported.
  [[nodiscard]] double number(std::string_view name, double absent, Door& door) const;
  [[nodiscard]] double integer(std::string_view name, double absent, Door& door) const;
  [[nodiscard]] bool truth(std::string_view name, bool absent, Door& door) const;
  [[nodiscard]] std::string text(std::string_view name, const std::string& absent, Door& door) const;
  [[nodiscard]] Imath::V3d point(std::string_view name, const Imath::V3d& absent, Door& door) const;
  /// All its numbers; none in its absence.
  [[nodiscard]] std::vector<double> numbers(std::string_view name, Door& door) const;

  /// Takes parameters for used that change nothing here.
  void ignore(std::initializer_list<std::string_view> names) const;
  /// Notes every parameter that nobody has used; `of` names what has them.
  void note_unused(const std::string& of, Door& door) const;
  [[nodiscard]] const std::vector<Parameter>& all() const { return list_; }

 private:
  [[nodiscard]] const Parameter* single(std::string_view name, std::initializer_list<const char*> types,
                                        std::size_t count, Door& door) const;

  std::vector<Parameter> list_;
};

}  // namespace abbe::doors::pbrt
