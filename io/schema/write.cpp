#include "io/schema/write.h"

#include <cmath>

namespace abbe::schema {
namespace {

void write_fields(const Fields& fields, const void* instance, JsonValue::Object& into);

void write_choice(const Choice& choice, const void* variant, JsonValue::Object& into) {
  const void* value = choice.alternative.get(variant);
  if (value == nullptr) return;
  if (choice.nested)
    into.push_back({std::string(choice.key), write(*choice.alternative.type, value)});
  else
    write_fields(std::get<Struct>(choice.alternative.type->variant).fields(), value, into);
}

// True if an optional member has its default value.
bool equals_default(const Field& field, const JsonValue& written, const void* defaults) {
  if (field.presence == Presence::required) return false;
  const void* value = field.get(defaults);
  return value != nullptr && to_text(write(std::get<ValueType>(*field.content), value)) == to_text(written);
}

void write_fields(const Fields& fields, const void* instance, JsonValue::Object& into) {
  for (const Field& field : fields.fields) {
    const void* value = field.get(instance);
    if (value == nullptr) continue;
    if (const auto* group = std::get_if<OneOf>(field.content.get())) {
      for (const Choice& choice : group->choices) write_choice(choice, value, into);
    } else if (const auto* inlined = std::get_if<Inlined>(field.content.get())) {
      write_fields(inlined->fields(), value, into);
    } else {
      JsonValue written = write(std::get<ValueType>(*field.content), value);
      if (!equals_default(field, written, fields.defaults))
        into.push_back({std::string(field.key), std::move(written)});
    }
  }
}

/// Writes each value type.
struct WriteValue {
  const void* value;

  template <typename T>
  [[nodiscard]] const T& as() const {
    return *static_cast<const T*>(value);
  }
  JsonValue operator()(const Number&) const { return json(as<double>()); }
  JsonValue operator()(const Integer& type) const { return json(static_cast<double>(type.get(value))); }
  JsonValue operator()(const Boolean&) const { return json(as<bool>()); }
  JsonValue operator()(const Text&) const { return json(as<std::string>()); }
  JsonValue operator()(const Enumeration& type) const {
    return json(std::string(type.names[type.get(value)]));
  }
  JsonValue operator()(const Vector& type) const {
    JsonValue::Array array;
    for (std::size_t i = 0; i < type.count; ++i) array.push_back(json(type.get(value, i)));
    return json(std::move(array));
  }
  JsonValue operator()(const Numbers&) const {
    JsonValue::Array array;
    for (const double number : as<std::vector<double>>()) array.push_back(json(number));
    return json(std::move(array));
  }
  JsonValue operator()(const Struct& type) const { return write(type.fields(), value); }
  JsonValue operator()(const List& type) const {
    const std::size_t size = type.size(value);
    if (type.allows_single && size == 1) return write(*type.element, type.at(value, 0));
    JsonValue::Array array;
    for (std::size_t i = 0; i < size; ++i) array.push_back(write(*type.element, type.at(value, i)));
    return json(std::move(array));
  }
  JsonValue operator()(const ByName& type) const {
    JsonValue::Object object;
    for (std::size_t i = 0; i < type.size(value); ++i)
      object.push_back({type.name(value, i), write(*type.element, type.at(value, i))});
    return json(std::move(object));
  }
  JsonValue operator()(const Forms& type) const {
    for (const Form& form : type.forms)
      if (const void* member = form.alternative.get(value)) return write(*form.alternative.type, member);
    return json(nullptr);
  }
};

// True if a default is worth stating: not an infinite number, and not an empty list or object.
bool is_informative(const JsonValue& value) {
  if (const auto* number = std::get_if<double>(&value.value)) return std::isfinite(*number);
  if (const auto* array = std::get_if<JsonValue::Array>(&value.value)) return !array->empty();
  const auto* object = std::get_if<JsonValue::Object>(&value.value);
  return object == nullptr || !object->empty();
}

}  // namespace

JsonValue write(const ValueType& type, const void* value) {
  return std::visit(WriteValue{value}, type.variant);
}

JsonValue write(const Fields& fields, const void* instance) {
  JsonValue::Object object;
  write_fields(fields, instance, object);
  return json(std::move(object));
}

std::optional<JsonValue> default_of(const Field& field, const void* defaults) {
  const void* otherwise = field.presence == Presence::optional ? field.get(defaults) : nullptr;
  if (otherwise == nullptr) return std::nullopt;
  JsonValue value = write(std::get<ValueType>(*field.content), otherwise);
  return is_informative(value) ? std::optional(std::move(value)) : std::nullopt;
}

}  // namespace abbe::schema
