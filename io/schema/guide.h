#pragma once

#include <string>

#include "io/schema/fields.h"

namespace abbe::schema {

/// The Markdown text `guide` with its tables of keys regenerated. A table is between the lines `<!-- keys:
/// NAME, NAME -->` and `<!-- end -->`, below a heading. The names are those (`Fields::name`) of `root` or of
/// structs inside it. A struct that no table names is described in the first table that contains it; other
/// tables link to that heading. Throws Error{internal} for an unknown name and for a table without an end.
[[nodiscard]] std::string with_tables(const std::string& guide, const Fields& root);

}  // namespace abbe::schema
