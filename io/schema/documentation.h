#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/schema/fields.h"

// Field tables as lists of keys, for the guide and for help.
namespace abbe::schema {

/// Anchors of a Markdown page at which structs are described, without "#".
using Links = std::map<const Fields*, std::string>;

/// A key of an object, with its role. Pointers and views refer to field tables.
struct Key {
  std::string_view name;
  std::string text;  ///< Meaning: the field's text, or the text of the struct that is its value.
  std::vector<const ValueType*> types;  ///< Types of the value; several if they depend on other keys.
  /// "required", "required without a, b", "in place of a, b", "default 4", or empty for an optional key.
  std::string presence;
  const OneOf* group = nullptr;  ///< Group of which the key is a choice, or nullptr.
  int group_number = 0;          ///< Number of the group in its object, from 1 on; 0 without a group.
  /// Keys one of which must be present with this one; empty if none is needed.
  std::vector<std::string_view> sibling_keys = {};
  /// Names of the structs that have the key; empty if all structs given to `keys_of` have it.
  std::vector<std::string_view> owners = {};

  /// `text`, preceded by the sibling keys and owners.
  [[nodiscard]] std::string meaning() const;
  /// Type, range and presence, such as "number in (0, 180), default 4". Structs with an anchor in `links` are
  /// linked in Markdown.
  [[nodiscard]] std::string allowed(const Links& links = {}) const;
};

/// All keys that an object of one of these structs may have, in order. Keys of equal name, meaning, type and
/// group are merged.
[[nodiscard]] std::vector<Key> keys_of(std::span<const Fields* const> structs);

/// A struct and the first of the shortest key paths to it.
struct StructPath {
  std::string path;  ///< Such as "sensor/readout"; empty for the root.
  const Fields* fields;
};
/// The root and all structs inside it, each once, by ascending length of their paths.
[[nodiscard]] std::vector<StructPath> structs_below(const Fields& root);

/// The Markdown text `guide` with its tables of keys regenerated. A table is between the lines `<!-- keys:
/// NAME, NAME -->` and `<!-- end -->`, below a heading. The names are those (`Fields::name`) of `root` or of
/// structs inside it. A struct that no table names is described in the first table that contains it; other
/// tables link to that heading. Throws Error{internal} for an unknown name and for a table without an end.
[[nodiscard]] std::string with_tables(const std::string& guide, const Fields& root);

/// Help for a key, as lines for a terminal: its meaning, type, range and default, and the keys of objects in
/// it. `key` is a path from the root with '/', which may include numbers of elements and names that the user
/// chose. A key alone is described at every position where it occurs; an empty text gives the keys of the
/// root. Throws Error{usage}, with the nearest known key, if a key is unknown.
[[nodiscard]] std::string help(const Fields& root, const std::string& key);

/// Every key of the file and its structs, each once, in byte order.
[[nodiscard]] std::vector<std::string> all_keys(const Fields& root);

}  // namespace abbe::schema
