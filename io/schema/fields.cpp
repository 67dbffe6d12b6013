#include "io/schema/fields.h"

#include <fmt/format.h>

#include "io/error.h"

namespace abbe::schema {

Field Field::or_default() const {
  Field field = *this;
  field.presence = Presence::optional;
  return field;
}

Field Field::required() const {
  Field field = *this;
  field.presence = Presence::required;
  return field;
}

namespace detail {

void require_same(const std::type_info& said, const std::type_info& is, std::string_view what) {
  if (said != is)
    throw Error{ErrorCode::internal, "",
                fmt::format("the table of \"{}\" holds a {} for a {}", what, said.name(), is.name())};
}

std::shared_ptr<const Part> part(Kind&& kind) {
  return std::make_shared<const Part>(std::move(kind));
}
std::shared_ptr<const Part> part(OneOf&& group) {
  return std::make_shared<const Part>(std::move(group));
}
std::shared_ptr<const Part> part(Lent lent) {
  return std::make_shared<const Part>(lent);
}

}  // namespace detail
}  // namespace abbe::schema
