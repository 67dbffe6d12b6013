#include "io/schema/json_schema.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "io/schema/write.h"
#include "io/text.h"

namespace abbe::schema {
namespace {

using Object = JsonValue::Object;
using Array = JsonValue::Array;

JsonValue string(std::string_view text) {
  return json(std::string(text));
}
void add(Object& object, std::string_view key, JsonValue value) {
  object.push_back({std::string(key), std::move(value)});
}
JsonValue object_of(std::string_view key, JsonValue value) {
  Object object;
  add(object, key, std::move(value));
  return json(std::move(object));
}
// {"required": [key]}; of a path, that the first key is there and has the rest.
JsonValue has(std::string_view path) {
  const std::size_t end = path.find('/');
  JsonValue first = object_of("required", json(Array{string(path.substr(0, end))}));
  if (end != std::string_view::npos)
    add(std::get<Object>(first.value), "properties",
        object_of(path.substr(0, end), has(path.substr(end + 1))));
  return first;
}

/// What an object must satisfy.
struct Part {
  Object properties;
  Array required;
  Array clauses;
};

/// The definitions that have been referred to, by name.
using Definitions = std::map<std::string, JsonValue>;

JsonValue schema_of(const Kind& kind, Definitions& definitions);
void add_fields(const Fields& fields, Part& part, Definitions& definitions);

// Writes a part: one clause as it is, several as "allOf".
void write_part(Part part, Object& into) {
  if (!part.properties.empty()) add(into, "properties", json(std::move(part.properties)));
  if (!part.required.empty()) add(into, "required", json(std::move(part.required)));
  if (part.clauses.size() == 1) {
    for (auto& member : std::get<Object>(part.clauses.front().value)) into.push_back(std::move(member));
  } else if (part.clauses.size() > 1) {
    add(into, "allOf", json(std::move(part.clauses)));
  }
}

void describe_as(JsonValue& schema, std::string_view text) {
  if (!text.empty()) add(std::get<Object>(schema.value), "description", string(text));
}

JsonValue field_schema(const Field& field, const void* defaults, Definitions& definitions) {
  JsonValue schema = schema_of(std::get<Kind>(*field.part), definitions);
  describe_as(schema, field.text);
  if (auto value = default_of(field, defaults))
    add(std::get<Object>(schema.value), "default", *std::move(value));
  return schema;
}

/// What stands beside the key of each choice of a group.
std::vector<Part> branches_of(const OneOf& group, Definitions& definitions) {
  std::vector<Part> branches;
  for (const Choice& choice : group.choices) {
    Part& branch = branches.emplace_back();
    if (choice.inside) {
      JsonValue schema = schema_of(*choice.alternative.kind, definitions);
      describe_as(schema, choice.text);
      add(branch.properties, choice.key, std::move(schema));
    } else {
      add_fields(std::get<Thing>(choice.alternative.kind->of).fields(), branch, definitions);
    }
  }
  return branches;
}

bool same_everywhere(const std::vector<Part>& branches, const std::string& key, const JsonValue& schema) {
  const std::string text = to_text(schema);
  return std::all_of(branches.begin(), branches.end(), [&](const Part& branch) {
    const auto found = std::find_if(branch.properties.begin(), branch.properties.end(),
                                    [&](const auto& member) { return member.first == key; });
    return found == branch.properties.end() || to_text(found->second) == text;
  });
}

// The properties of all branches: said once where they agree, else left to each branch.
void share_properties(std::vector<Part>& branches, Object& properties) {
  const std::vector<Part> all = branches;
  for (Part& branch : branches)
    std::erase_if(branch.properties, [&](const JsonValue::Member& member) {
      const bool same = same_everywhere(all, member.first, member.second);
      const bool known = std::any_of(properties.begin(), properties.end(),
                                     [&](const auto& other) { return other.first == member.first; });
      if (!known) add(properties, member.first, same ? member.second : json(true));
      return same;
    });
}

// For each key that stands beside some choices only, that one of these is there.
void tie_companions(const OneOf& group, const std::vector<Part>& branches, Object& dependent) {
  std::map<std::string, Array> owners;
  for (std::size_t i = 0; i < branches.size(); ++i)
    for (const auto& member : branches[i].properties)
      if (member.first != group.choices[i].key) owners[member.first].push_back(has(group.choices[i].key));
  for (auto& [key, choices] : owners)
    if (choices.size() < branches.size() || !group.required)
      add(dependent, key, object_of("anyOf", json(std::move(choices))));
}

void add_group(const OneOf& group, Part& part, Definitions& definitions) {
  std::vector<Part> branches = branches_of(group, definitions);
  Object dependent;
  tie_companions(group, branches, dependent);
  share_properties(branches, part.properties);
  Array choices;
  for (std::size_t i = 0; i < branches.size(); ++i) {
    const std::string_view key = group.choices[i].key;
    choices.push_back(has(key));
    std::erase_if(branches[i].required,
                  [&](const JsonValue& other) { return std::get<std::string>(other.value) == key; });
    Object schema;
    write_part(std::move(branches[i]), schema);
    if (!schema.empty()) add(dependent, key, json(std::move(schema)));
  }
  if (!group.required) {
    JsonValue none = object_of("not", object_of("anyOf", json(choices)));
    choices.push_back(std::move(none));
  }
  Object clause;
  add(clause, "oneOf", json(std::move(choices)));
  if (!dependent.empty()) add(clause, "dependentSchemas", json(std::move(dependent)));
  part.clauses.push_back(json(std::move(clause)));
}

void add_fields(const Fields& fields, Part& part, Definitions& definitions) {
  for (const Field& field : fields.fields) {
    if (const auto* group = std::get_if<OneOf>(field.part.get())) {
      add_group(*group, part, definitions);
    } else if (const auto* lent = std::get_if<Lent>(field.part.get())) {
      add_fields(lent->fields(), part, definitions);
    } else {
      add(part.properties, field.key, field_schema(field, fields.defaults, definitions));
      if (field.presence == Presence::required) part.required.push_back(string(field.key));
    }
  }
  if (fields.any_of.empty()) return;
  Array keys;
  for (const std::string_view path : fields.any_of) keys.push_back(has(path));
  part.clauses.push_back(object_of(fields.exclusive ? "oneOf" : "anyOf", json(std::move(keys))));
}

void write_object(const Fields& fields, Object& into, Definitions& definitions) {
  Part part;
  add_fields(fields, part, definitions);
  add(into, "type", string("object"));
  write_part(std::move(part), into);
  add(into, "additionalProperties", json(false));
}

JsonValue of_type(std::string_view type) {
  return object_of("type", string(type));
}

JsonValue bounded(std::string_view type, const Range& range, double largest) {
  JsonValue schema = of_type(type);
  auto& object = std::get<Object>(schema.value);
  add(object, range.open_low ? "exclusiveMinimum" : "minimum", json(std::max(range.low, -largest)));
  add(object, range.open_high ? "exclusiveMaximum" : "maximum", json(std::min(range.high, largest)));
  return schema;
}

JsonValue array_of(JsonValue items, std::size_t least, std::size_t most) {
  JsonValue schema = of_type("array");
  auto& object = std::get<Object>(schema.value);
  add(object, "items", std::move(items));
  if (least > 0) add(object, "minItems", json(static_cast<double>(least)));
  if (most > 0) add(object, "maxItems", json(static_cast<double>(most)));
  return schema;
}

/// How each kind is said in a schema.
struct SchemaOf {
  Definitions& definitions;

  JsonValue operator()(const Number& kind) const { return bounded("number", kind.range, kLargestFloat); }
  JsonValue operator()(const Integer& kind) const { return bounded("integer", kind.range, kLargestInteger); }
  JsonValue operator()(const Boolean&) const { return of_type("boolean"); }
  JsonValue operator()(const Text&) const { return of_type("string"); }
  JsonValue operator()(const Word& kind) const {
    Array names;
    for (const char* name : kind.names) {
      names.push_back(string(name));
      if (kind.numbers) names.push_back(json(parse_number(name).value()));
    }
    return object_of("enum", json(std::move(names)));
  }
  JsonValue operator()(const Vector& kind) const {
    JsonValue number = kind.whole ? bounded("integer", kind.range, kLargestInteger)
                                  : bounded("number", kind.range, kLargestFloat);
    JsonValue schema = array_of(std::move(number), kind.count, kind.count);
    if (kind.direction)
      add(std::get<Object>(schema.value), "not", object_of("const", json(Array(kind.count, json(0.0)))));
    return schema;
  }
  JsonValue operator()(const Numbers& kind) const {
    return array_of(bounded("number", kind.range, kLargestFloat), 0, 0);
  }
  // Refers to the definition of that name, which `write` writes the first time.
  template <typename Write>
  JsonValue defined(std::string_view name, Write write) const {
    if (!definitions.contains(std::string(name))) {
      definitions[std::string(name)];  // may be referred to by what it holds
      JsonValue schema = write();
      definitions[std::string(name)] = std::move(schema);
    }
    return object_of("$ref", string(fmt::format("#/$defs/{}", name)));
  }
  JsonValue operator()(const Thing& kind) const {
    const Fields& fields = kind.fields();
    return defined(fields.name, [&] {
      Object schema;
      if (!fields.text.empty()) add(schema, "description", string(fields.text));
      if (fields.row) {
        Object object;
        write_object(fields, object, definitions);
        add(schema, "anyOf", json(Array{json(std::move(object)), row_of(fields)}));
      } else {
        write_object(fields, schema, definitions);
      }
      return json(std::move(schema));
    });
  }
  JsonValue row_of(const Fields& fields) const {
    Array values;
    for (std::size_t i = 0; i < fields.row->most; ++i)
      values.push_back(object_of(
          "anyOf",
          json(Array{schema_of(std::get<Kind>(*fields.fields[i].part), definitions), of_type("null")})));
    JsonValue schema = of_type("array");
    auto& object = std::get<Object>(schema.value);
    add(object, "prefixItems", json(std::move(values)));
    add(object, "minItems", json(static_cast<double>(fields.row->least)));
    add(object, "maxItems", json(static_cast<double>(fields.row->most)));
    return schema;
  }
  JsonValue operator()(const List& kind) const {
    JsonValue all = array_of(schema_of(*kind.element, definitions), kind.least, 0);
    if (!kind.bare) return all;
    return object_of("anyOf", json(Array{schema_of(*kind.element, definitions), std::move(all)}));
  }
  JsonValue operator()(const ByName& kind) const {
    JsonValue schema = of_type("object");
    auto& object = std::get<Object>(schema.value);
    add(object, "additionalProperties", schema_of(*kind.element, definitions));
    if (kind.least > 0) add(object, "minProperties", json(static_cast<double>(kind.least)));
    return schema;
  }
  JsonValue operator()(const Forms& kind) const {
    const auto any_of = [&] {
      Array forms;
      for (const Form& form : kind.forms) forms.push_back(schema_of(*form.alternative.kind, definitions));
      return object_of("anyOf", json(std::move(forms)));
    };
    return kind.name.empty() ? any_of() : defined(kind.name, any_of);
  }
};

JsonValue schema_of(const Kind& kind, Definitions& definitions) {
  return std::visit(SchemaOf{definitions}, kind.of);
}

}  // namespace

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
