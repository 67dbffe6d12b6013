#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <ImathMatrix.h>

#include "importers/shared/scene_importer.h"

namespace abbe::importers::mitsuba {

/// An XML element with its children.
struct Element {
  std::string tag;                                                ///< Name of the element, such as "shape".
  std::vector<std::pair<std::string, std::string>> attributes{};  ///< Names and values, in file order.
  std::vector<Element> children{};                                ///< Elements inside it, in file order.
  SourcePosition where{};
  /// Index among all elements, in the order of their start tags, counted from 1; 0 for the root.
  std::size_t first_index = 0;
  /// `first_index` of the last element inside it, or its own if it has none; 0 for the root.
  std::size_t last_index = 0;
  mutable bool used = false;  ///< True once the importer has used it; it notes the others as dropped.

  /// Value of an attribute; empty if absent.
  [[nodiscard]] const std::string& operator[](std::string_view name) const;
  [[nodiscard]] bool has(std::string_view name) const;
};

/// Reads a file and returns its root. Included files replace their <include>; `$name` in attributes is
/// replaced by the value of an earlier <default>. Neither of them remains as an element. Reports:
/// - missing or unreadable files, malformed XML and a root other than <scene>;
/// - elements or files nested deeper than 64 levels, and more than 10000 included files;
/// - a `$name` without a <default>, and a value longer than 1 MiB after the replacement.
[[nodiscard]] std::optional<Element> read_xml(const std::filesystem::path& file, SceneImporter& importer);

/// State of an import that all elements share.
struct ImportState {
  SceneImporter& importer;
  std::filesystem::path folder;  ///< Folder of the scene file, to which its file names are relative.
  std::map<std::string, const Element*> ids{};          ///< Elements by their attribute "id".
  std::map<const Element*, double> interior_indices{};  ///< Declared interior indices by dielectric <bsdf>.
  Imath::M44d world_mirror{};  ///< Follows every object-to-world matrix; see `world_mirror_of`.
};

/// The element itself or, if it is a <ref>, the element that it refers to. Reports an unknown id, and a
/// target that does not end before the reference, and returns nullptr.
[[nodiscard]] const Element* resolve(const Element& element, const ImportState& state);

/// An element with its properties, which are its named children. Reading a property marks it as used. The
/// element and the state must outlive it.
class Object {
 public:
  Object(const Element& element, const ImportState& state) : element_(&element), import_(&state) {}

  /// The attribute "type"; empty if absent.
  [[nodiscard]] const std::string& type() const { return (*element_)["type"]; }
  [[nodiscard]] const SourcePosition& where() const { return element_->where; }
  [[nodiscard]] const Element& element() const { return *element_; }
  [[nodiscard]] const ImportState& state() const { return *import_; }
  [[nodiscard]] SceneImporter& importer() const { return import_->importer; }

  /// Notes an approximated or dropped property of the object.
  void note(const std::string& text) const { importer().note(where(), text); }
  /// Reports an error at the object; the result is nothing.
  std::nullopt_t fail(std::string what, ErrorCode code = ErrorCode::scene) const {
    return importer().fail(where(), std::move(what), code);
  }

  /// The first property called `name`, with references resolved; nullptr, without an error, if there is none.
  /// Its tag must be one of `tags`. Reports another tag and an unresolved reference, and returns nullptr.
  [[nodiscard]] const Element* find(std::string_view name,
                                    std::initializer_list<std::string_view> tags) const;
  /// True if there is a property called `name`. Does not mark it as used.
  [[nodiscard]] bool has(std::string_view name) const;
  /// Position of the property called `name`, or of the object if there is none.
  [[nodiscard]] const SourcePosition& position_of(std::string_view name) const;
  // Properties of one type; `fallback` if absent. Malformed or empty values and other tags are reported, and
  // `fallback` is returned.
  /// A <float> or an <integer>.
  [[nodiscard]] double number(std::string_view name, double fallback) const;
  [[nodiscard]] bool boolean(std::string_view name, bool fallback) const;
  [[nodiscard]] std::string text(std::string_view name, const std::string& fallback) const;
  /// A <point> or <vector> as read by `vector_of`, in which absent and malformed coordinates are 0.
  [[nodiscard]] Imath::V3d point(std::string_view name, const Imath::V3d& fallback) const;
  /// The matrix for row vectors of a <transform>, whose first step applies first; the identity if absent.
  /// Reports malformed steps, which are skipped, and a singular matrix, which becomes the identity.
  [[nodiscard]] Imath::M44d transform(std::string_view name) const;
  /// All children with that tag, whatever their names, in file order. References to such elements are
  /// resolved; an unresolved reference is reported and left out. Marks them as used.
  [[nodiscard]] std::vector<const Element*> all(std::string_view tag) const;

  /// Marks the properties called `names`, which have no effect in Abbe, as used. Absent ones are no error.
  void ignore(std::initializer_list<std::string_view> names) const;
  /// Notes every child that is not marked as used as dropped.
  void note_unused() const;

 private:
  const Element* element_;
  const ImportState* import_;
};

/// A vector from the attribute `value`, which has three numbers, or one for all coordinates. Without it, from
/// the attributes x, y and z; an absent one has its coordinate of `fallback`. Malformed and empty numbers are
/// reported and replaced by `fallback`.
[[nodiscard]] Imath::V3d vector_of(const Element& element, const Imath::V3d& fallback,
                                   const ImportState& state);
/// The numbers of a text, separated by blanks, line breaks or commas; empty for an empty text. Nothing,
/// without an error, if one is malformed.
[[nodiscard]] std::optional<std::vector<double>> numbers_of(const std::string& text);

}  // namespace abbe::importers::mitsuba
