#include "io/schema/write.h"

#include <cmath>

namespace abbe::schema {
namespace {

void write_fields(const Fields& fields, const void* thing, JsonValue::Object& into);

void write_choice(const Choice& choice, const void* variant, JsonValue::Object& into) {
  const void* value = choice.alternative.get(variant);
  if (value == nullptr) return;
  if (choice.inside)
    into.push_back({std::string(choice.key), write(*choice.alternative.kind, value)});
  else
    write_fields(std::get<Thing>(choice.alternative.kind->of).fields(), value, into);
}

// Whether a member that may be absent holds what it holds without its key.
bool as_default(const Field& field, const JsonValue& written, const void* defaults) {
  if (field.presence == Presence::required) return false;
  const void* value = field.look(defaults);
  return value != nullptr && to_text(write(std::get<Kind>(*field.part), value)) == to_text(written);
}

void write_fields(const Fields& fields, const void* thing, JsonValue::Object& into) {
  for (const Field& field : fields.fields) {
    const void* value = field.look(thing);
    if (value == nullptr) continue;
    if (const auto* group = std::get_if<OneOf>(field.part.get())) {
      for (const Choice& choice : group->choices) write_choice(choice, value, into);
    } else if (const auto* lent = std::get_if<Lent>(field.part.get())) {
      write_fields(lent->fields(), value, into);
    } else {
      JsonValue written = write(std::get<Kind>(*field.part), value);
      if (!as_default(field, written, fields.defaults))
        into.push_back({std::string(field.key), std::move(written)});
    }
  }
}

/// How each kind writes.
struct WriteValue {
  const void* value;

  template <typename T>
  [[nodiscard]] const T& as() const {
    return *static_cast<const T*>(value);
  }
  JsonValue operator()(const Number&) const { return json(as<double>()); }
  JsonValue operator()(const Integer& kind) const { return json(static_cast<double>(kind.get(value))); }
  JsonValue operator()(const Boolean&) const { return json(as<bool>()); }
  JsonValue operator()(const Text&) const { return json(as<std::string>()); }
  JsonValue operator()(const Word& kind) const { return json(std::string(kind.names[kind.get(value)])); }
  JsonValue operator()(const Vector& kind) const {
    JsonValue::Array array;
    for (std::size_t i = 0; i < kind.count; ++i) array.push_back(json(kind.get(value, i)));
    return json(std::move(array));
  }
  JsonValue operator()(const Numbers&) const {
    JsonValue::Array array;
    for (const double number : as<std::vector<double>>()) array.push_back(json(number));
    return json(std::move(array));
  }
  JsonValue operator()(const Thing& kind) const { return write(kind.fields(), value); }
  JsonValue operator()(const List& kind) const {
    const std::size_t size = kind.size(value);
    if (kind.bare && size == 1) return write(*kind.element, kind.at(value, 0));
    JsonValue::Array array;
    for (std::size_t i = 0; i < size; ++i) array.push_back(write(*kind.element, kind.at(value, i)));
    return json(std::move(array));
  }
  JsonValue operator()(const ByName& kind) const {
    JsonValue::Object object;
    for (std::size_t i = 0; i < kind.size(value); ++i)
      object.push_back({kind.name(value, i), write(*kind.element, kind.at(value, i))});
    return json(std::move(object));
  }
  JsonValue operator()(const Forms& kind) const {
    for (const Form& form : kind.forms)
      if (const void* held = form.alternative.get(value)) return write(*form.alternative.kind, held);
    return json(nullptr);
  }
};

// Whether a default is worth telling: no infinity, and no list of nothing.
bool says_something(const JsonValue& value) {
  if (const auto* number = std::get_if<double>(&value.value)) return std::isfinite(*number);
  if (const auto* array = std::get_if<JsonValue::Array>(&value.value)) return !array->empty();
  const auto* object = std::get_if<JsonValue::Object>(&value.value);
  return object == nullptr || !object->empty();
}

}  // namespace

JsonValue write(const Kind& kind, const void* value) {
  return std::visit(WriteValue{value}, kind.of);
}

JsonValue write(const Fields& fields, const void* thing) {
  JsonValue::Object object;
  write_fields(fields, thing, object);
  return json(std::move(object));
}

std::optional<JsonValue> default_of(const Field& field, const void* defaults) {
  const void* otherwise = field.presence == Presence::optional ? field.look(defaults) : nullptr;
  if (otherwise == nullptr) return std::nullopt;
  JsonValue value = write(std::get<Kind>(*field.part), otherwise);
  return says_something(value) ? std::optional(std::move(value)) : std::nullopt;
}

}  // namespace abbe::schema
