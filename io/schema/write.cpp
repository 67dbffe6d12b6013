#include "io/schema/write.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe::schema {

namespace {
using Object = JsonValue::Object;
using Array = JsonValue::Array;

void add(Object& object, std::string_view key, JsonValue value) {
  object.push_back({std::string(key), std::move(value)});
}

void write_fields(const Fields& fields, const void* instance, Object& into);

void write_choice(const Choice& choice, const void* variant, Object& into) {
  const void* value = choice.alternative.get(variant);
  if (value == nullptr) return;
  if (choice.nested)
    add(into, choice.key, write(*choice.alternative.type, value));
  else
    write_fields(std::get<Struct>(choice.alternative.type->variant).fields(), value, into);
}

// True if an optional member has its default value.
bool equals_default(const Field& field, const JsonValue& written, const void* defaults) {
  if (field.presence == Presence::required) return false;
  const void* value = field.get(defaults);
  return value != nullptr && to_text(write(std::get<ValueType>(*field.content), value)) == to_text(written);
}

void write_fields(const Fields& fields, const void* instance, Object& into) {
  for (const Field& field : fields.fields) {
    const void* value = field.get(instance);
    if (value == nullptr) continue;
    if (const auto* group = std::get_if<OneOf>(field.content.get())) {
      for (const Choice& choice : group->choices) write_choice(choice, value, into);
    } else if (const auto* inlined = std::get_if<Inlined>(field.content.get())) {
      write_fields(inlined->fields(), value, into);
    } else {
      JsonValue written = write(std::get<ValueType>(*field.content), value);
      if (!equals_default(field, written, fields.defaults)) add(into, field.key, std::move(written));
    }
  }
}

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
    Array array;
    for (std::size_t i = 0; i < type.count; ++i) array.push_back(json(type.get(value, i)));
    return json(std::move(array));
  }
  JsonValue operator()(const Numbers&) const {
    Array array;
    for (const double number : as<std::vector<double>>()) array.push_back(json(number));
    return json(std::move(array));
  }
  JsonValue operator()(const Struct& type) const { return write(type.fields(), value); }
  JsonValue operator()(const List& type) const {
    const std::size_t size = type.size(value);
    if (type.allows_single && size == 1) return write(*type.element, type.at(value, 0));
    Array array;
    for (std::size_t i = 0; i < size; ++i) array.push_back(write(*type.element, type.at(value, i)));
    return json(std::move(array));
  }
  JsonValue operator()(const ByName& type) const {
    Object object;
    for (std::size_t i = 0; i < type.size(value); ++i)
      add(object, type.name(value, i), write(*type.element, type.at(value, i)));
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
  if (const auto* array = std::get_if<Array>(&value.value)) return !array->empty();
  const auto* object = std::get_if<Object>(&value.value);
  return object == nullptr || !object->empty();
}

JsonValue string(std::string_view text) {
  return json(std::string(text));
}
void add(JsonValue& object, std::string_view key, JsonValue value) {
  add(std::get<Object>(object.value), key, std::move(value));
}
JsonValue object_of(std::string_view key, JsonValue value) {
  Object object;
  add(object, key, std::move(value));
  return json(std::move(object));
}
// {"required": [key]}. For a path, the first key is required and its value must have the rest.
JsonValue has(std::string_view path) {
  const std::size_t end = path.find('/');
  JsonValue first = object_of("required", json(Array{string(path.substr(0, end))}));
  if (end != std::string_view::npos)
    add(first, "properties", object_of(path.substr(0, end), has(path.substr(end + 1))));
  return first;
}

/// Constraints on an object.
struct ObjectSchema {
  Object properties;
  Array required;
  Array clauses;
};

/// Definitions that have been referred to, by name.
using Definitions = std::map<std::string, JsonValue>;

JsonValue schema_of(const ValueType& type, Definitions& definitions);
void add_fields(const Fields& fields, ObjectSchema& content, Definitions& definitions);

// Writes the constraints: a single clause directly, several as "allOf".
void write_object_schema(ObjectSchema content, Object& into) {
  if (!content.properties.empty()) add(into, "properties", json(std::move(content.properties)));
  if (!content.required.empty()) add(into, "required", json(std::move(content.required)));
  if (content.clauses.size() == 1) {
    for (auto& member : std::get<Object>(content.clauses.front().value)) into.push_back(std::move(member));
  } else if (content.clauses.size() > 1) {
    add(into, "allOf", json(std::move(content.clauses)));
  }
}

void describe_as(JsonValue& schema, std::string_view text) {
  if (!text.empty()) add(schema, "description", string(text));
}

JsonValue field_schema(const Field& field, const void* defaults, Definitions& definitions) {
  JsonValue schema = schema_of(std::get<ValueType>(*field.content), definitions);
  describe_as(schema, field.text);
  if (auto value = default_of(field, defaults)) add(schema, "default", *std::move(value));
  return schema;
}

/// Constraints on the object for each choice of a group.
std::vector<ObjectSchema> branches_of(const OneOf& group, Definitions& definitions) {
  std::vector<ObjectSchema> branches;
  for (const Choice& choice : group.choices) {
    ObjectSchema& branch = branches.emplace_back();
    if (choice.nested) {
      JsonValue schema = schema_of(*choice.alternative.type, definitions);
      describe_as(schema, choice.text);
      add(branch.properties, choice.key, std::move(schema));
    } else {
      add_fields(std::get<Struct>(choice.alternative.type->variant).fields(), branch, definitions);
    }
  }
  return branches;
}

bool same_everywhere(const std::vector<ObjectSchema>& branches, const std::string& key,
                     const JsonValue& schema) {
  const std::string text = to_text(schema);
  return std::ranges::all_of(branches, [&](const ObjectSchema& branch) {
    const auto found = std::ranges::find(branch.properties, key, &JsonValue::Member::first);
    return found == branch.properties.end() || to_text(found->second) == text;
  });
}

// Merges the properties of all branches. A property with the same schema in all branches is moved to
// `properties`; others stay in their branches.
void merge_properties(std::vector<ObjectSchema>& branches, Object& properties) {
  const std::vector<ObjectSchema> all = branches;
  for (ObjectSchema& branch : branches)
    std::erase_if(branch.properties, [&](const JsonValue::Member& member) {
      const bool same = same_everywhere(all, member.first, member.second);
      if (std::ranges::find(properties, member.first, &JsonValue::Member::first) == properties.end())
        add(properties, member.first, same ? member.second : json(true));
      return same;
    });
}

// Requires, for each key that belongs to some choices only, one of these choices.
void require_owner_keys(const OneOf& group, const std::vector<ObjectSchema>& branches, Object& dependent) {
  std::map<std::string, Array> owners;
  for (std::size_t i = 0; i < branches.size(); ++i)
    for (const auto& member : branches[i].properties)
      if (member.first != group.choices[i].key) owners[member.first].push_back(has(group.choices[i].key));
  for (auto& [key, choices] : owners)
    if (choices.size() < branches.size() || !group.required)
      add(dependent, key, object_of("anyOf", json(std::move(choices))));
}

// Adds a group: exactly one of its keys is present, or none if it is not required. The keys of a choice are
// allowed with its key only.
void add_group(const OneOf& group, ObjectSchema& content, Definitions& definitions) {
  std::vector<ObjectSchema> branches = branches_of(group, definitions);
  Object dependent;
  require_owner_keys(group, branches, dependent);
  merge_properties(branches, content.properties);
  Array choices;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const std::string_view key = group.choices[i].key;
    choices.push_back(has(key));
    std::erase_if(branches[i].required,
                  [&](const JsonValue& other) { return std::get<std::string>(other.value) == key; });
    Object schema;
    write_object_schema(std::move(branches[i]), schema);
    if (!schema.empty()) add(dependent, key, json(std::move(schema)));
  }
  if (!group.required) choices.push_back(object_of("not", object_of("anyOf", json(choices))));
  Object clause;
  add(clause, "oneOf", json(std::move(choices)));
  if (!dependent.empty()) add(clause, "dependentSchemas", json(std::move(dependent)));
  content.clauses.push_back(json(std::move(clause)));
}

// Adds the keys of all fields, and the rule that one of `any_of` is present.
void add_fields(const Fields& fields, ObjectSchema& content, Definitions& definitions) {
  for (const Field& field : fields.fields) {
    if (const auto* group = std::get_if<OneOf>(field.content.get())) {
      add_group(*group, content, definitions);
    } else if (const auto* inlined = std::get_if<Inlined>(field.content.get())) {
      add_fields(inlined->fields(), content, definitions);
    } else {
      add(content.properties, field.key, field_schema(field, fields.defaults, definitions));
      if (field.presence == Presence::required) content.required.push_back(string(field.key));
    }
  }
  if (fields.any_of.empty()) return;
  Array keys;
  for (const std::string_view path : fields.any_of) keys.push_back(has(path));
  content.clauses.push_back(object_of(fields.exclusive ? "oneOf" : "anyOf", json(std::move(keys))));
}

void write_object(const Fields& fields, Object& into, Definitions& definitions) {
  ObjectSchema content;
  add_fields(fields, content, definitions);
  add(into, "type", string("object"));
  write_object_schema(std::move(content), into);
  add(into, "additionalProperties", json(false));
}

JsonValue of_type(std::string_view type) {
  return object_of("type", string(type));
}

JsonValue bounded(std::string_view type, const Range& range, double largest) {
  JsonValue schema = of_type(type);
  add(schema, range.open_low ? "exclusiveMinimum" : "minimum", json(std::max(range.low, -largest)));
  add(schema, range.open_high ? "exclusiveMaximum" : "maximum", json(std::min(range.high, largest)));
  return schema;
}

// An array of that size; a `max_size` of 0 is no limit. `items_key` says to which elements `items` apply.
JsonValue array_of(JsonValue items, std::size_t min_size, std::size_t max_size,
                   std::string_view items_key = "items") {
  JsonValue schema = of_type("array");
  add(schema, items_key, std::move(items));
  if (min_size > 0) add(schema, "minItems", json(static_cast<double>(min_size)));
  if (max_size > 0) add(schema, "maxItems", json(static_cast<double>(max_size)));
  return schema;
}

struct SchemaOf {
  Definitions& definitions;

  JsonValue operator()(const Number& type) const { return bounded("number", type.range, kLargestFloat); }
  JsonValue operator()(const Integer& type) const { return bounded("integer", type.range, kLargestInteger); }
  JsonValue operator()(const Boolean&) const { return of_type("boolean"); }
  JsonValue operator()(const Text&) const { return of_type("string"); }
  JsonValue operator()(const Enumeration& type) const {
    Array names;
    for (const char* name : type.names) {
      names.push_back(string(name));
      if (type.accepts_numbers) names.push_back(json(parse_number(name).value()));
    }
    return object_of("enum", json(std::move(names)));
  }
  JsonValue operator()(const Vector& type) const {
    JsonValue number = type.integers ? bounded("integer", type.range, kLargestInteger)
                                     : bounded("number", type.range, kLargestFloat);
    JsonValue schema = array_of(std::move(number), type.count, type.count);
    if (type.nonzero) add(schema, "not", object_of("const", json(Array(type.count, json(0.0)))));
    return schema;
  }
  JsonValue operator()(const Numbers& type) const {
    return array_of(bounded("number", type.range, kLargestFloat), 0, 0);
  }
  // A reference to the definition called `name`, which `write` creates at the first use.
  template <typename Write>
  JsonValue defined(std::string_view name, Write write) const {
    // Inserted first, since the struct may contain its own type.
    if (const auto [definition, is_new] = definitions.try_emplace(std::string(name)); is_new)
      definition->second = write();
    return object_of("$ref", string(fmt::format("#/$defs/{}", name)));
  }
  JsonValue operator()(const Struct& type) const {
    const Fields& fields = type.fields();
    return defined(fields.name, [&] {
      JsonValue schema = json(Object{});
      describe_as(schema, fields.text);
      Object object;
      write_object(fields, object, definitions);
      if (fields.array_form)
        add(schema, "anyOf", json(Array{json(std::move(object)), row_of(fields)}));
      else
        std::ranges::move(object, std::back_inserter(std::get<Object>(schema.value)));
      return schema;
    });
  }
  JsonValue row_of(const Fields& fields) const {
    Array values;
    for (std::size_t i = 0; i < fields.array_form->max_size; ++i)
      values.push_back(object_of(
          "anyOf", json(Array{schema_of(std::get<ValueType>(*fields.fields[i].content), definitions),
                              of_type("null")})));
    return array_of(json(std::move(values)), fields.array_form->min_size, fields.array_form->max_size,
                    "prefixItems");
  }
  JsonValue operator()(const List& type) const {
    JsonValue all = array_of(schema_of(*type.element, definitions), type.min_size, 0);
    if (!type.allows_single) return all;
    return object_of("anyOf", json(Array{schema_of(*type.element, definitions), std::move(all)}));
  }
  JsonValue operator()(const ByName& type) const {
    JsonValue schema = of_type("object");
    add(schema, "additionalProperties", schema_of(*type.element, definitions));
    if (type.min_size > 0) add(schema, "minProperties", json(static_cast<double>(type.min_size)));
    return schema;
  }
  JsonValue operator()(const Forms& type) const {
    const auto any_of = [&] {
      Array forms;
      for (const Form& form : type.forms) forms.push_back(schema_of(*form.alternative.type, definitions));
      return object_of("anyOf", json(std::move(forms)));
    };
    return type.name.empty() ? any_of() : defined(type.name, any_of);
  }
};

JsonValue schema_of(const ValueType& type, Definitions& definitions) {
  return std::visit(SchemaOf{definitions}, type.variant);
}
}  // namespace

JsonValue write(const ValueType& type, const void* value) {
  return std::visit(WriteValue{value}, type.variant);
}

JsonValue write(const Fields& fields, const void* instance) {
  Object object;
  write_fields(fields, instance, object);
  return json(std::move(object));
}

std::optional<JsonValue> default_of(const Field& field, const void* defaults) {
  const void* otherwise = field.presence == Presence::optional ? field.get(defaults) : nullptr;
  if (otherwise == nullptr) return std::nullopt;
  JsonValue value = write(std::get<ValueType>(*field.content), otherwise);
  return is_informative(value) ? std::optional(std::move(value)) : std::nullopt;
}

JsonValue json_schema(const Fields& fields) {
  Definitions definitions;
  Object schema;
  add(schema, "$schema", string("https://json-schema.org/draft/2020-12/schema"));
  add(schema, "title", string(fields.name));
  add(schema, "description", string(fields.text));
  write_object(fields, schema, definitions);
  Object all;
  for (auto& [name, definition] : definitions) add(all, name, std::move(definition));
  if (!all.empty()) add(schema, "$defs", json(std::move(all)));
  return json(std::move(schema));
}

}  // namespace abbe::schema
