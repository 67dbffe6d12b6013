#include "io/schema/read.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace abbe::schema {
namespace {

/// An object on its way into a thing.
struct ObjectReading {
  const JsonValue& json;
  Diagnostics& diagnostics;
  std::size_t known = 0;  ///< How many members have been found.
  bool chosen = true;     ///< Whether every group of keys that must be there is; else keys may belong to it.
};

bool read_fields(ObjectReading& reading, const Fields& fields, void* thing);

bool read_member(const JsonValue& json, const Field& field, void* thing, Diagnostics& diagnostics) {
  void* member = field.member(thing);
  void* value = field.holder.open(member);
  if (SourcePosition* where = field.holder.where(member)) *where = json.where;
  if (read(json, std::get<Kind>(*field.part), value, diagnostics)) return true;
  field.holder.close(member);
  return false;
}

// The choice whose key is there; nullptr for none, and after an error.
const Choice* choose(ObjectReading& reading, const OneOf& group) {
  std::vector<const Choice*> present;
  for (const Choice& choice : group.choices)
    if (reading.json.find(choice.key)) present.push_back(&choice);
  if (present.size() == 1) return present.front();
  if (present.empty() && !group.required) return nullptr;
  reading.chosen = false;
  if (!group.several.empty() && present.size() > 1) {
    reading.diagnostics.error(reading.json.where, fmt::format("{} (got {} and {})", group.several,
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
  if (choice == nullptr) return reading.chosen;
  const Alternative& alternative = choice->alternative;
  const JsonValue& json = choice->inside ? *reading.json.find(choice->key) : reading.json;
  void* value = alternative.emplace(variant, json.where);
  bool sound = false;
  if (choice->inside) {
    ++reading.known;
    sound = read(json, *alternative.kind, value, reading.diagnostics);
  } else {
    sound = read_fields(reading, std::get<Thing>(alternative.kind->of).fields(), value);
  }
  if (!sound) group.clear(variant);
  return sound;
}

bool read_field(ObjectReading& reading, const Field& field, void* thing) {
  if (const auto* group = std::get_if<OneOf>(field.part.get()))
    return read_group(reading, *group, field.member(thing));
  if (const auto* lent = std::get_if<Lent>(field.part.get()))
    return read_fields(reading, lent->fields(), field.member(thing));
  if (const JsonValue* json = reading.json.find(field.key)) {
    ++reading.known;
    return read_member(*json, field, thing, reading.diagnostics);
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

// Whether one of the keys is there that a table asks for, and no other where there may be none.
bool check_any_of(const ObjectReading& reading, const Fields& fields) {
  std::vector<std::string_view> present;
  for (const std::string_view path : fields.any_of)
    if (find_path(reading.json, path)) present.push_back(path);
  if (present.empty()) {
    reading.diagnostics.error(reading.json.where,
                              fmt::format("missing key \"{}\"", fmt::join(fields.any_of, "\" or \"")));
    return false;
  }
  const auto parent = [](std::string_view path) { return path.substr(0, path.find('/')); };
  if (present.size() == 1 || !fields.exclusive) return true;
  if (parent(present[0]) == parent(present[1])) return false;  // of which that one tells
  reading.diagnostics.error(find_path(reading.json, present[1])->where,
                            fmt::format("goes in place of \"{}\", and there is one", present[0]));
  return false;
}

bool read_fields(ObjectReading& reading, const Fields& fields, void* thing) {
  bool sound = true;
  if (SourcePosition* where = fields.where(thing)) *where = reading.json.where;
  for (const Field& field : fields.fields) sound = read_field(reading, field, thing) && sound;
  return (fields.any_of.empty() || check_any_of(reading, fields)) && sound;
}

// The keys that an object may have, given the alternatives it has chosen.
void collect_keys(const JsonValue& json, const Fields& fields, std::vector<std::string>& keys) {
  for (const Field& field : fields.fields) {
    if (const auto* group = std::get_if<OneOf>(field.part.get())) {
      for (const Choice& choice : group->choices) {
        keys.emplace_back(choice.key);
        if (!choice.inside && json.find(choice.key))
          collect_keys(json, std::get<Thing>(choice.alternative.kind->of).fields(), keys);
      }
    } else if (const auto* lent = std::get_if<Lent>(field.part.get())) {
      collect_keys(json, lent->fields(), keys);
    } else {
      keys.emplace_back(field.key);
    }
  }
}

// The keys one of which would have to be there for an object to have this one.
void collect_owners(const JsonValue& json, const Fields& fields, std::string_view key,
                    std::vector<std::string_view>& owners) {
  for (const Field& field : fields.fields) {
    if (const auto* lent = std::get_if<Lent>(field.part.get()))
      collect_owners(json, lent->fields(), key, owners);
    const auto* group = std::get_if<OneOf>(field.part.get());
    if (group == nullptr) continue;
    for (const Choice& choice : group->choices) {
      if (choice.inside) continue;
      const Fields& beside = std::get<Thing>(choice.alternative.kind->of).fields();
      std::vector<std::string> keys;
      collect_keys(json, beside, keys);
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) owners.push_back(choice.key);
      if (json.find(choice.key)) collect_owners(json, beside, key, owners);
    }
  }
}

bool read_list(const JsonValue& json, const List& list, void* value, Diagnostics& diagnostics) {
  if (list.bare && !std::holds_alternative<JsonValue::Array>(json.value))
    return read(json, *list.element, list.append(value, json.where), diagnostics);
  const JsonValue::Array* elements = read_array(json, list.what, list.least, diagnostics);
  if (!elements) return false;
  const bool rows =
      std::holds_alternative<Vector>(list.element->of);  // of which there may be many: one fault will do
  list.reserve(value, elements->size());
  bool sound = true;
  for (const JsonValue& element : *elements) {
    sound = read(element, *list.element, list.append(value, element.where), diagnostics) && sound;
    if (rows && !sound) return false;
  }
  return sound;
}

bool read_by_name(const JsonValue& json, const ByName& group, void* value, Diagnostics& diagnostics) {
  const auto* members = std::get_if<JsonValue::Object>(&json.value);
  if (!members || members->size() < group.least) {
    diagnostics.error(json.where,
                      fmt::format("expected {} (got {})", group.what, members ? "none" : json.kind()));
    return false;
  }
  bool sound = true;
  for (const auto& [name, member] : *members)
    sound = read(member, *group.element, group.append(value, name, member.where), diagnostics) && sound;
  return sound;
}

bool fits(const JsonValue& json, const Form& form) {
  constexpr Json kTypes[] = {Json::any, Json::any, Json::number, Json::text, Json::list, Json::object};
  if (form.json == Json::any) return true;
  if (form.json != kTypes[json.value.index()]) return false;
  return form.keys.empty() || std::any_of(form.keys.begin(), form.keys.end(),
                                          [&](std::string_view key) { return json.find(key) != nullptr; });
}

// Whether a key that tells a form is there but for a slip, which in one of two letters makes another word.
bool fits_misspelt(const JsonValue& json, const Form& form) {
  const auto* object = std::get_if<JsonValue::Object>(&json.value);
  std::vector<std::string> keys(form.keys.begin(), form.keys.end());
  std::erase_if(keys, [](const std::string& key) { return key.size() < 3; });
  return object != nullptr &&
         std::any_of(object->begin(), object->end(), [&](const JsonValue::Member& member) {
           return nearest_name(member.first, keys).has_value();
         });
}

bool read_form(const JsonValue& json, const Forms& forms, void* value, Diagnostics& diagnostics) {
  for (const Form& form : forms.forms)
    if (fits(json, form) || fits_misspelt(json, form))
      return read(json, *form.alternative.kind, form.alternative.emplace(value, json.where), diagnostics);
  diagnostics.error(json.where, fmt::format("expected {} (got {})", forms.expected, json.kind()));
  return false;
}

// Integers, each of which is reported at its own place.
bool read_integers(const JsonValue& json, const Vector& vector, void* value, Diagnostics& diagnostics) {
  if (!read_numbers(json, vector.count, Range::any(), diagnostics)) return false;
  bool sound = true;
  for (std::size_t i = 0; i < vector.count; ++i) {
    const auto read = read_integer(std::get<JsonValue::Array>(json.value)[i], vector.range, diagnostics);
    if (read) vector.set(value, i, static_cast<double>(*read));
    sound = sound && read;
  }
  return sound;
}

bool read_vector(const JsonValue& json, const Vector& vector, void* value, Diagnostics& diagnostics) {
  if (vector.whole) return read_integers(json, vector, value, diagnostics);
  const auto numbers = read_numbers(json, vector.count, vector.range, diagnostics);
  if (!numbers) return false;
  for (std::size_t i = 0; i < vector.count; ++i) vector.set(value, i, (*numbers)[i]);
  const auto is_zero = [](double x) { return x == 0; };
  if (!vector.direction || !std::all_of(numbers->begin(), numbers->end(), is_zero)) return true;
  diagnostics.error(json.where, fmt::format("a direction must not be zero (got [{}])",
                                            fmt::join(std::vector<int>(vector.count, 0), ", ")));
  return false;
}

// A word, or a number in place of its digits.
bool read_word(const JsonValue& json, const Word& word, void* value, Diagnostics& diagnostics) {
  const auto* number = word.numbers ? std::get_if<double>(&json.value) : nullptr;
  const auto read =
      number ? read_choice({fmt::format("{}", *number), json.where}, word.what, word.names, diagnostics)
             : read_choice(json, word.what, word.names, diagnostics);
  if (read) word.set(value, *read);
  return read.has_value();
}

template <typename T>
bool store(std::optional<T> read, void* value) {
  if (!read) return false;
  *static_cast<T*>(value) = *std::move(read);
  return true;
}

/// How each kind reads.
struct ReadValue {
  const JsonValue& json;
  void* value;
  Diagnostics& diagnostics;

  bool operator()(const Number& kind) const {
    return store(read_number(json, kind.range, diagnostics), value);
  }
  bool operator()(const Integer& kind) const {
    const auto read = read_integer(json, kind.range, diagnostics);
    if (read) kind.set(value, *read);
    return read.has_value();
  }
  bool operator()(const Boolean&) const { return store(read_boolean(json, diagnostics), value); }
  bool operator()(const Text&) const { return store(read_string(json, diagnostics), value); }
  bool operator()(const Word& kind) const { return read_word(json, kind, value, diagnostics); }
  bool operator()(const Vector& kind) const { return read_vector(json, kind, value, diagnostics); }
  bool operator()(const Numbers& kind) const {
    return store(read_numbers(json, 0, kind.range, diagnostics), value);
  }
  bool operator()(const Thing& kind) const { return read(json, kind.fields(), value, diagnostics); }
  bool operator()(const List& kind) const { return read_list(json, kind, value, diagnostics); }
  bool operator()(const ByName& kind) const { return read_by_name(json, kind, value, diagnostics); }
  bool operator()(const Forms& kind) const { return read_form(json, kind, value, diagnostics); }
};

// What a row stands for.
std::optional<JsonValue> object_of_row(const JsonValue& json, const JsonValue::Array& row,
                                       const Fields& fields, Diagnostics& diagnostics) {
  const std::vector<std::string_view> keys = fields.row_keys();
  if (row.size() < fields.row->least || row.size() > keys.size()) {
    diagnostics.error(
        json.where, fmt::format("a list in place of an object has {} here (got {} values, allowed {} to {})",
                                fmt::join(keys, ", "), row.size(), fields.row->least, keys.size()));
    return std::nullopt;
  }
  JsonValue::Object object;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (std::holds_alternative<std::nullptr_t>(row[i].value)) continue;
    JsonValue& value = object.emplace_back(JsonValue::Member{std::string(keys[i]), row[i]}).second;
    value.key_offset = value.where.offset;
  }
  JsonValue whole = json;
  whole.value = std::move(object);
  return whole;
}

}  // namespace

bool read(const JsonValue& json, const Kind& kind, void* value, Diagnostics& diagnostics) {
  return std::visit(ReadValue{json, value, diagnostics}, kind.of);
}

bool read(const JsonValue& json, const Fields& fields, void* thing, Diagnostics& diagnostics) {
  if (const auto* row = std::get_if<JsonValue::Array>(&json.value); row != nullptr && fields.row) {
    const auto object = object_of_row(json, *row, fields, diagnostics);
    return object && read(*object, fields, thing, diagnostics);
  }
  const JsonValue::Object* object = read_object(json, diagnostics);
  if (!object) return false;
  ObjectReading reading{json, diagnostics};
  const bool sound = read_fields(reading, fields, thing);
  if (!reading.chosen || reading.known == object->size()) return sound;
  std::vector<std::string> keys;
  collect_keys(json, fields, keys);
  for (const auto& [key, member] : *object) {
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    std::vector<std::string_view> owners;
    collect_owners(json, fields, key, owners);
    diagnostics.error(
        member.key_position(),
        owners.empty() ? unknown_name("key", key, keys)
                       : fmt::format("{} goes with {}, which is not there", key, fmt::join(owners, " or ")));
  }
  return false;
}

}  // namespace abbe::schema
