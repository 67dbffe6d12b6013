#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/schema/fields.h"

// The tables of things as lists of keys, which guides and helps tell.
namespace abbe::schema {

/// The anchors in a page of Markdown that things are told at.
using Links = std::map<const Fields*, std::string>;

/// A key of an object.
struct Key {
  std::string_view name;
  std::string text;                           ///< What it means: its own text, or that of the thing it holds.
  std::vector<const Kind*> kinds;             ///< Of its value; several where that depends on other keys.
  std::string presence;                       ///< "required", "default 4", or nothing.
  const OneOf* group = nullptr;               ///< That it is a choice of,
  int group_number = 0;                       ///< which is this one of its object's, from 1 on.
  std::vector<std::string_view> beside = {};  ///< Keys of which one stands there too; none where it need not.
  std::vector<std::string_view> of = {};      ///< Things that have it; none where all asked of do.

  /// Its text, and what it stands beside and belongs to.
  [[nodiscard]] std::string meaning() const;
  /// Type, range and presence: "number in (0, 180), default 4". Objects told elsewhere are linked in
  /// Markdown.
  [[nodiscard]] std::string allowed(const Links& links = {}) const;
};

/// All keys that an object of one of these things may have, in the order of their tables.
[[nodiscard]] std::vector<Key> keys_of(std::span<const Fields* const> things);

/// The things that values of these kinds hold, in lists or as one of several forms too.
[[nodiscard]] std::vector<const Fields*> things_in(std::span<const Kind* const> kinds);

/// A thing, and the first of the shortest paths of keys that lead to it.
struct Place {
  std::string path;  ///< As "sensor/readout"; empty for the root.
  const Fields* thing;
};
/// The root and all things below it, each once.
[[nodiscard]] std::vector<Place> places_below(const Fields& root);

/// `path` and one more key.
[[nodiscard]] std::string joined(std::string_view path, std::string_view key);

/// What tells of keys that belong to a group: "one of" or "at most one of".
[[nodiscard]] std::string_view heading(const OneOf& group);

}  // namespace abbe::schema
