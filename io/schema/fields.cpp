#include "io/schema/fields.h"

#include <fmt/format.h>

#include "io/error.h"

namespace abbe::schema {

Field Field::with(Presence other) const {
  Field field = *this;
  field.presence = other;
  return field;
}

Fields Fields::or_array(std::size_t min_size, std::size_t max_size) const {
  Fields table = *this;
  table.array_form = ArrayForm{min_size, max_size};
  return table;
}

std::vector<std::string_view> Fields::array_keys() const {
  std::vector<std::string_view> keys;
  for (std::size_t i = 0; array_form && i < array_form->max_size; ++i) keys.push_back(fields.at(i).key);
  return keys;
}

Fields describe(std::string_view name, std::string_view text, std::vector<Field> fields,
                std::vector<std::string_view> any_of, bool exclusive) {
  return {name, text, std::move(fields), std::move(any_of), exclusive};
}

std::shared_ptr<const FieldContent> detail::content(ValueType&& type) {
  return std::make_shared<const FieldContent>(std::move(type));
}
std::shared_ptr<const FieldContent> detail::content(OneOf&& group) {
  return std::make_shared<const FieldContent>(std::move(group));
}
std::shared_ptr<const FieldContent> detail::content(Inlined inlined) {
  return std::make_shared<const FieldContent>(inlined);
}

void detail::require_same(const std::type_info& declared, const std::type_info& actual,
                          std::string_view what) {
  if (declared != actual)
    throw Error{ErrorCode::internal, "",
                fmt::format("the field table of \"{}\" declares the type {} for a member of type {}", what,
                            declared.name(), actual.name())};
}

}  // namespace abbe::schema
