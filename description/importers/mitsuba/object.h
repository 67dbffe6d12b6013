#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <ImathMatrix.h>

#include "description/importers/mitsuba/xml.h"

namespace abbe::importers::mitsuba {

/// State of an import that all elements share.
struct ImportState {
  SceneImporter& importer;
  std::filesystem::path folder;  ///< Folder of the scene file, to which its file names are relative.
  std::map<std::string, const Element*> ids{};
  std::map<const Element*, double> interior_indices{};  ///< Declared interior indices of dielectrics.
  Imath::M44d world_mirror{};                           ///< Applied to all objects; see `world_mirror_of`.
};

/// The element, or the target of a <ref>. Reports an unknown id, and a target that has not ended before the
/// reference, and returns nullptr. Does not mark either as used.
[[nodiscard]] const Element* resolve(const Element& element, const ImportState& state);

/// An element with its properties, which are its named children. A property that is read is marked as used.
class Object {
 public:
  Object(const Element& element, const ImportState& state) : element_(&element), import_(&state) {}

  [[nodiscard]] const std::string& type() const { return (*element_)["type"]; }
  [[nodiscard]] const SourcePosition& where() const { return element_->where; }
  [[nodiscard]] const Element& element() const { return *element_; }

  /// The property called `name`, with references resolved. Its tag must be one of `tags`; others are
  /// reported. nullptr if there is none.
  [[nodiscard]] const Element* find(std::string_view name,
                                    std::initializer_list<std::string_view> tags) const;
  [[nodiscard]] bool has(std::string_view name) const;
  /// Position of the property called `name`, or of the object if there is none.
  [[nodiscard]] const SourcePosition& position_of(std::string_view name) const;
  // Properties of one type, or `fallback` if absent.
  [[nodiscard]] double number(std::string_view name, double fallback) const;
  [[nodiscard]] bool boolean(std::string_view name, bool fallback) const;
  [[nodiscard]] std::string text(std::string_view name, const std::string& fallback) const;
  [[nodiscard]] Imath::V3d point(std::string_view name, const Imath::V3d& fallback) const;
  /// The matrix of a <transform>; the identity if absent.
  [[nodiscard]] Imath::M44d transform(std::string_view name) const;
  /// All children with that tag, whatever their names, with references to such elements resolved.
  [[nodiscard]] std::vector<const Element*> all(std::string_view tag) const;

  /// Marks properties that have no effect in Abbe as used.
  void ignore(std::initializer_list<std::string_view> names) const;
  /// Notes every property that is not marked as used.
  void note_unused() const;

 private:
  const Element* element_;
  const ImportState* import_;
};

/// A vector from the attributes x, y and z, or from `value`. Malformed numbers are reported.
[[nodiscard]] Imath::V3d vector_of(const Element& element, const Imath::V3d& fallback,
                                   const ImportState& state);
/// The numbers of a text, separated by blanks or commas. Nothing if one is malformed.
[[nodiscard]] std::optional<std::vector<double>> numbers_of(const std::string& text);

}  // namespace abbe::importers::mitsuba
