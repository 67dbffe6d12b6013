#include "io/schema/fields.h"

#include <fmt/format.h>

#include "io/error.h"

namespace abbe::schema {

Field Field::with(Presence other) const {
  Field field = *this;
  field.presence = other;
  return field;
}

Fields Fields::or_row(std::size_t least, std::size_t most) const {
  Fields table = *this;
  table.row = Row{least, most};
  return table;
}

std::vector<std::string_view> Fields::row_keys() const {
  std::vector<std::string_view> keys;
  for (std::size_t i = 0; row && i < row->most; ++i) keys.push_back(fields.at(i).key);
  return keys;
}

Fields describe(std::string_view name, std::string_view text, std::vector<Field> fields,
                std::vector<std::string_view> any_of, bool exclusive) {
  return {name, text, std::move(fields), std::move(any_of), exclusive};
}

std::shared_ptr<const Part> detail::part(Kind&& kind) {
  return std::make_shared<const Part>(std::move(kind));
}
std::shared_ptr<const Part> detail::part(OneOf&& group) {
  return std::make_shared<const Part>(std::move(group));
}
std::shared_ptr<const Part> detail::part(Lent lent) {
  return std::make_shared<const Part>(lent);
}

void detail::require_same(const std::type_info& said, const std::type_info& is, std::string_view what) {
  if (said != is)
    throw Error{ErrorCode::internal, "",
                fmt::format("the table of \"{}\" holds a {} for a {}", what, said.name(), is.name())};
}

}  // namespace abbe::schema
