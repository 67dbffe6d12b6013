#pragma once

#include "io/schema/fields.h"

namespace abbe::schema {

/// The JSON Schema (draft 2020-12) of a file that holds one such thing: it allows exactly what `read` takes
/// without a complaint.
[[nodiscard]] JsonValue json_schema(const Fields& fields);

}  // namespace abbe::schema
