#pragma once

#include <string>

#include "io/schema/fields.h"

namespace abbe::schema {

/// A guide in Markdown with its tables of keys written anew. A table stands between the lines
/// `<!-- keys: NAME, NAME -->`, which names things that `root` or something below it holds, and `<!-- end
/// -->`. A thing below these that no table names is told in the first that meets it; others link to the
/// heading above. Throws Error{internal} for a name that is no thing's, and a table without an end.
[[nodiscard]] std::string with_tables(const std::string& guide, const Fields& root);

}  // namespace abbe::schema
