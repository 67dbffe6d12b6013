#pragma once

#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <ImathMatrix.h>

#include "description/doors/mitsuba/xml.h"

namespace abbe::doors::mitsuba {

/// What a scene's elements share, and where it goes.
struct World {
  Door& door;
  std::filesystem::path folder;  ///< Of the scene file: where the files it names are.
  std::map<std::string, const Element*> ids{};
  std::map<const Element*, double> matter{};  ///< Indices within its dielectrics, as they say them.
  Imath::M44d upright{};                      ///< What everything goes through: see `upright_world`.
};

/// The element itself, or what it refers to. An unknown name, and one that stands for something not ended
/// before, are reported; nullptr then. Neither counts as used.
[[nodiscard]] const Element* resolved(const Element& element, const World& world);

/// The properties of an element: those within it, by name. What is asked for counts as used.
class Object {
 public:
  Object(const Element& element, const World& world) : element_(&element), world_(&world) {}

  [[nodiscard]] const std::string& type() const { return (*element_)["type"]; }
  [[nodiscard]] const SourcePosition& where() const { return element_->where; }
  [[nodiscard]] const Element& element() const { return *element_; }

  /// The property of that name, of one of the tags; another is reported. References are followed.
  [[nodiscard]] const Element* find(std::string_view name,
                                    std::initializer_list<std::string_view> tags) const;
  [[nodiscard]] bool has(std::string_view name) const;
  /// Where the property of that name stands, or else the object.
  [[nodiscard]] const SourcePosition& place_of(std::string_view name) const;
  // The same of one kind each, or what holds in its absence.
  [[nodiscard]] double number(std::string_view name, double absent) const;
  [[nodiscard]] bool truth(std::string_view name, bool absent) const;
  [[nodiscard]] std::string text(std::string_view name, const std::string& absent) const;
  [[nodiscard]] Imath::V3d point(std::string_view name, const Imath::V3d& absent) const;
  /// The matrix of a transform, the identity in its absence.
  [[nodiscard]] Imath::M44d transform(std::string_view name) const;
  /// All elements of a tag within it, whatever their names, and what references of any stand for.
  [[nodiscard]] std::vector<const Element*> all(std::string_view tag) const;

  /// Takes properties for used that change nothing here.
  void ignore(std::initializer_list<std::string_view> names) const;
  /// Notes every property that nobody has asked for.
  void note_unused() const;

 private:
  const Element* element_;
  const World* world_;
};

/// Three numbers of attributes x, y and z, or of `value`; malformed ones are reported.
[[nodiscard]] Imath::V3d vector_of(const Element& element, const Imath::V3d& absent, const World& world);
/// The numbers of a text, between blanks and commas; nothing if one is none.
[[nodiscard]] std::optional<std::vector<double>> numbers_of(const std::string& text);

}  // namespace abbe::doors::mitsuba
