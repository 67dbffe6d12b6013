#include "io/schema/fields.h"

#include <fmt/format.h>

#include "io/error.h"

namespace abbe::schema::detail {

void require_same(const std::type_info& a, const std::type_info& b, std::string_view what) {
  if (a != b)
    throw Error{ErrorCode::internal, "",
                fmt::format("the table of \"{}\" holds a {} for a {}", what, a.name(), b.name())};
}

}  // namespace abbe::schema::detail
