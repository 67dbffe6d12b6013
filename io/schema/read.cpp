#include "io/schema/read.h"

#include <algorithm>

#include <fmt/format.h>

namespace abbe::schema {
namespace {

/// State while an object is read.
struct ObjectReading {
  const JsonValue& json;
  Diagnostics& diagnostics;
  std::size_t known_count = 0;  ///< Number of members that have been found.
  /// False if a required group of keys has no unique choice; unknown keys may then belong to it.
  bool groups_resolved = true;
};

bool read_fields(ObjectReading& reading, const Fields& fields, void* instance);

bool read_member(const JsonValue& json, const Field& field, void* instance, Diagnostics& diagnostics) {
  void* member = field.member(instance);
  void* value = field.access.open(member);
  if (SourcePosition* where = field.access.where(member)) *where = json.where;
  if (read(json, std::get<ValueType>(*field.content), value, diagnostics)) return true;
  field.access.close(member);
  return false;
}

// The choice whose key is present; nullptr for none, and after an error.
const Choice* choose(ObjectReading& reading, const OneOf& group) {
  std::vector<const Choice*> present;
  for (const Choice& choice : group.choices)
    if (reading.json.find(choice.key)) present.push_back(&choice);
  if (present.size() == 1) return present.front();
  if (present.empty() && !group.required) return nullptr;
  reading.groups_resolved = false;
  if (!group.conflict.empty() && present.size() > 1) {
    reading.diagnostics.error(reading.json.where, fmt::format("{} (got {} and {})", group.conflict,
                                                              present[0]->key, present[1]->key));
    return nullptr;
  }
  std::vector<std::string_view> keys;
  for (const Choice& choice : group.choices) keys.push_back(choice.key);
  (void)choose_key(reading.json, keys, reading.diagnostics);
  return nullptr;
}

bool read_group(ObjectReading& reading, const OneOf& group, void* variant) {
  const Choice* choice = choose(reading, group);
  if (choice == nullptr) return reading.groups_resolved;
  const Alternative& alternative = choice->alternative;
  const JsonValue& json = choice->nested ? *reading.json.find(choice->key) : reading.json;
  void* value = alternative.emplace(variant, json.where);
  bool valid = false;
  if (choice->nested) {
    ++reading.known_count;
    valid = read(json, *alternative.type, value, reading.diagnostics);
  } else {
    valid = read_fields(reading, std::get<Struct>(alternative.type->variant).fields(), value);
  }
  if (!valid) group.clear(variant);
  return valid;
}

bool read_field(ObjectReading& reading, const Field& field, void* instance) {
  if (const auto* group = std::get_if<OneOf>(field.content.get()))
    return read_group(reading, *group, field.member(instance));
  if (const auto* inlined = std::get_if<Inlined>(field.content.get()))
    return read_fields(reading, inlined->fields(), field.member(instance));
  if (const JsonValue* json = reading.json.find(field.key)) {
    ++reading.known_count;
    return read_member(*json, field, instance, reading.diagnostics);
  }
  if (field.presence == Presence::optional) return true;
  reading.diagnostics.error(reading.json.where, fmt::format("missing key \"{}\"", field.key));
  return false;
}

const JsonValue* find_path(const JsonValue& json, std::string_view path) {
  const JsonValue* found = &json;
  for (std::size_t at = 0; found != nullptr && at <= path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    found = found->find(path.substr(at, end - at));
    at = end + 1;
  }
  return found;
}

// Checks that one of the keys in `any_of` is present, and no other if they are exclusive.
bool check_any_of(const ObjectReading& reading, const Fields& fields) {
  std::vector<std::string_view> present;
  for (const std::string_view path : fields.any_of)
    if (find_path(reading.json, path)) present.push_back(path);
  if (present.empty()) {
    reading.diagnostics.error(reading.json.where,
                              fmt::format("missing key \"{}\"", fmt::join(fields.any_of, "\" or \"")));
    return false;
  }
  if (present.size() == 1 || !fields.exclusive) return true;
  const auto parent = [](std::string_view path) { return path.substr(0, path.find('/')); };
  // That object reports the error.
  if (parent(present[0]) == parent(present[1])) return false;
  reading.diagnostics.error(find_path(reading.json, present[1])->where,
                            fmt::format("cannot be combined with \"{}\"", present[0]));
  return false;
}

bool read_fields(ObjectReading& reading, const Fields& fields, void* instance) {
  bool valid = true;
  if (SourcePosition* where = fields.where(instance)) *where = reading.json.where;
  for (const Field& field : fields.fields) valid = read_field(reading, field, instance) && valid;
  return (fields.any_of.empty() || check_any_of(reading, fields)) && valid;
}

// Collects the keys that an object may have, given the choices it has made.
void collect_keys(const JsonValue& json, const Fields& fields, std::vector<std::string>& keys) {
  for (const Field& field : fields.fields) {
    if (const auto* group = std::get_if<OneOf>(field.content.get())) {
      for (const Choice& choice : group->choices) {
        keys.emplace_back(choice.key);
        if (!choice.nested && json.find(choice.key))
          collect_keys(json, std::get<Struct>(choice.alternative.type->variant).fields(), keys);
      }
    } else if (const auto* inlined = std::get_if<Inlined>(field.content.get())) {
      collect_keys(json, inlined->fields(), keys);
    } else {
      keys.emplace_back(field.key);
    }
  }
}

// Collects the keys that would have to be present for the object to have `key`.
void collect_owners(const JsonValue& json, const Fields& fields, std::string_view key,
                    std::vector<std::string_view>& owners) {
  for (const Field& field : fields.fields) {
    if (const auto* inlined = std::get_if<Inlined>(field.content.get()))
      collect_owners(json, inlined->fields(), key, owners);
    const auto* group = std::get_if<OneOf>(field.content.get());
    if (group == nullptr) continue;
    for (const Choice& choice : group->choices) {
      if (choice.nested) continue;
      const Fields& inlined_fields = std::get<Struct>(choice.alternative.type->variant).fields();
      std::vector<std::string> keys;
      collect_keys(json, inlined_fields, keys);
      if (std::ranges::count(keys, key) != 0) owners.push_back(choice.key);
      if (json.find(choice.key)) collect_owners(json, inlined_fields, key, owners);
    }
  }
}

bool fits(const JsonValue& json, const Form& form) {
  constexpr Json kTypes[] = {Json::any, Json::any, Json::number, Json::text, Json::list, Json::object};
  if (form.json == Json::any) return true;
  if (form.json != kTypes[json.value.index()]) return false;
  return form.keys.empty() ||
         std::ranges::any_of(form.keys, [&](std::string_view key) { return json.find(key) != nullptr; });
}

// True if a key that selects the form is present, but misspelt. Keys of one or two letters are excluded: a
// typing error makes another word of them.
bool fits_misspelt(const JsonValue& json, const Form& form) {
  const auto* object = std::get_if<JsonValue::Object>(&json.value);
  std::vector<std::string> keys(form.keys.begin(), form.keys.end());
  std::erase_if(keys, [](const std::string& key) { return key.size() < 3; });
  return object != nullptr && std::ranges::any_of(*object, [&](const JsonValue::Member& member) {
           return nearest_name(member.first, keys).has_value();
         });
}

template <typename T>
bool store(std::optional<T> read, void* value) {
  if (!read) return false;
  *static_cast<T*>(value) = *std::move(read);
  return true;
}

struct ReadValue {
  const JsonValue& json;
  void* value;
  Diagnostics& diagnostics;

  bool operator()(const Number& type) const {
    return store(read_number(json, type.range, diagnostics), value);
  }
  bool operator()(const Integer& type) const {
    const auto read = read_integer(json, type.range, diagnostics);
    if (read) type.set(value, *read);
    return read.has_value();
  }
  bool operator()(const Boolean&) const { return store(read_boolean(json, diagnostics), value); }
  bool operator()(const Text&) const { return store(read_string(json, diagnostics), value); }
  // A name, or a number in place of its digits.
  bool operator()(const Enumeration& type) const {
    const auto* number = type.accepts_numbers ? std::get_if<double>(&json.value) : nullptr;
    const auto read =
        number ? read_choice({fmt::format("{}", *number), json.where}, type.what, type.names, diagnostics)
               : read_choice(json, type.what, type.names, diagnostics);
    if (read) type.set(value, *read);
    return read.has_value();
  }
  bool operator()(const Vector& type) const {
    const auto numbers =
        read_numbers(json, type.count, type.integers ? Range::any() : type.range, diagnostics);
    if (!numbers) return false;
    bool valid = true;
    for (std::size_t i = 0; i < type.count; ++i) {
      const JsonValue& element = std::get<JsonValue::Array>(json.value)[i];
      if (type.integers && !read_integer(element, type.range, diagnostics))
        valid = false;
      else
        type.set(value, i, (*numbers)[i]);
    }
    if (!type.nonzero || std::ranges::any_of(*numbers, [](double x) { return x != 0; })) return valid;
    diagnostics.error(json.where, fmt::format("a direction must not be zero (got [{}])",
                                              fmt::join(std::vector<int>(type.count, 0), ", ")));
    return false;
  }
  bool operator()(const Numbers& type) const {
    return store(read_numbers(json, 0, type.range, diagnostics), value);
  }
  bool operator()(const Struct& type) const { return read(json, type.fields(), value, diagnostics); }
  bool operator()(const List& list) const {
    if (list.allows_single && !std::holds_alternative<JsonValue::Array>(json.value))
      return read(json, *list.element, list.append(value, json.where), diagnostics);
    const JsonValue::Array* elements = read_array(json, list.what, list.min_size, diagnostics);
    if (!elements) return false;
    // There may be many vectors: report the first error only.
    const bool is_vector_list = std::holds_alternative<Vector>(list.element->variant);
    list.reserve(value, elements->size());
    bool valid = true;
    for (const JsonValue& element : *elements) {
      valid = read(element, *list.element, list.append(value, element.where), diagnostics) && valid;
      if (is_vector_list && !valid) return false;
    }
    return valid;
  }
  bool operator()(const ByName& group) const {
    const auto* members = std::get_if<JsonValue::Object>(&json.value);
    if (!members || members->size() < group.min_size) {
      diagnostics.error(json.where,
                        fmt::format("expected {} (got {})", group.what, members ? "none" : json.type_name()));
      return false;
    }
    bool valid = true;
    for (const auto& [name, member] : *members)
      valid = read(member, *group.element, group.append(value, name, member.where), diagnostics) && valid;
    return valid;
  }
  bool operator()(const Forms& forms) const {
    for (const Form& form : forms.forms)
      if (fits(json, form) || fits_misspelt(json, form))
        return read(json, *form.alternative.type, form.alternative.emplace(value, json.where), diagnostics);
    diagnostics.error(json.where, fmt::format("expected {} (got {})", forms.expected, json.type_name()));
    return false;
  }
};

// The object that an array replaces.
std::optional<JsonValue> object_of_array(const JsonValue& json, const JsonValue::Array& array,
                                         const Fields& fields, Diagnostics& diagnostics) {
  const std::vector<std::string_view> keys = fields.array_keys();
  if (array.size() < fields.array_form->min_size || array.size() > keys.size())
    return diagnostics.refuse(
        json.where,
        fmt::format("an array in place of this object has the values {} (got {} values, allowed {} to {})",
                    fmt::join(keys, ", "), array.size(), fields.array_form->min_size, keys.size()));
  JsonValue::Object object;
  for (std::size_t i = 0; i < array.size(); ++i) {
    if (std::holds_alternative<std::nullptr_t>(array[i].value)) continue;
    JsonValue& value = object.emplace_back(JsonValue::Member{std::string(keys[i]), array[i]}).second;
    value.key_offset = value.where.offset;
  }
  JsonValue whole = json;
  whole.value = std::move(object);
  return whole;
}

}  // namespace

bool read(const JsonValue& json, const ValueType& type, void* value, Diagnostics& diagnostics) {
  return std::visit(ReadValue{json, value, diagnostics}, type.variant);
}

bool read(const JsonValue& json, const Fields& fields, void* instance, Diagnostics& diagnostics) {
  if (const auto* array = std::get_if<JsonValue::Array>(&json.value); array != nullptr && fields.array_form) {
    const auto object = object_of_array(json, *array, fields, diagnostics);
    return object && read(*object, fields, instance, diagnostics);
  }
  const JsonValue::Object* object = read_object(json, diagnostics);
  if (!object) return false;
  ObjectReading reading{json, diagnostics};
  const bool valid = read_fields(reading, fields, instance);
  if (!reading.groups_resolved || reading.known_count == object->size()) return valid;
  std::vector<std::string> keys;
  collect_keys(json, fields, keys);
  for (const auto& [key, member] : *object) {
    if (std::ranges::count(keys, key) != 0) continue;
    std::vector<std::string_view> owners;
    collect_owners(json, fields, key, owners);
    diagnostics.error(member.key_position(), owners.empty() ? unknown_name("key", key, keys)
                                                            : fmt::format("{} requires {}, which is missing",
                                                                          key, fmt::join(owners, " or ")));
  }
  return false;
}

}  // namespace abbe::schema
