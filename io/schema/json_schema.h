#pragma once

#include "io/schema/fields.h"

namespace abbe::schema {

/// The JSON Schema (draft 2020-12) of a file that contains one such struct, without source positions. It
/// accepts exactly the files that `read` accepts without an error.
[[nodiscard]] JsonValue json_schema(const Fields& fields);

}  // namespace abbe::schema
