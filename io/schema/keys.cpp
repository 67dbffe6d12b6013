#include "io/schema/keys.h"

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "io/schema/write.h"

namespace abbe::schema {
namespace {

std::string kind_text(const Kind& kind, const Links& links);

// "number in (0, 1e+12] nm", or the number itself where there is but one.
std::string within(std::string_view what, const Range& range) {
  if (range.low == range.high) return fmt::format("{}", range.low);
  std::string text = range.text();
  if (text == Range::any().text()) return std::string(what);
  if (!range.measured_in.empty()) text += fmt::format(" {}", range.measured_in);
  for (std::size_t at = 0; (at = text.find("000000")) != std::string::npos;) {
    const std::size_t zeros = text.find_first_not_of('0', at) - at;
    text.replace(at, zeros, fmt::format("e+{:02}", zeros));
  }
  return fmt::format("{} in {}", what, text);
}

std::string linked(std::string word, const Fields* thing, const Links& links) {
  std::replace(word.begin(), word.end(), '_', ' ');
  const auto link = links.find(thing);
  return link == links.end() ? word : fmt::format("[{}](#{})", word, link->second);
}

// Texts that differ, as "a, b or c".
std::string alternatives(const std::vector<std::string>& texts) {
  std::vector<std::string> all;
  for (const std::string& text : texts)
    if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
  const std::string last = all.back();
  all.pop_back();
  return all.empty() ? last : fmt::format("{} or {}", fmt::join(all, ", "), last);
}

/// How each kind is told.
struct KindText {
  const Kind& kind;
  const Links& links;

  std::string operator()(const Number& number) const { return within("number", number.range); }
  std::string operator()(const Integer& integer) const { return within("integer", integer.range); }
  std::string operator()(const Boolean&) const { return "true or false"; }
  std::string operator()(const Text&) const { return "text"; }
  std::string operator()(const Word& word) const {
    std::vector<std::string> names;
    for (const char* name : word.names) names.push_back(fmt::format("\"{}\"", name));
    return alternatives(names);
  }
  std::string operator()(const Vector& vector) const {
    if (vector.direction) return fmt::format("{} numbers, not all 0", vector.count);
    return within(fmt::format("{} {}", vector.count, vector.whole ? "integers" : "numbers"), vector.range);
  }
  std::string operator()(const Numbers& numbers) const { return within("numbers", numbers.range); }
  std::string operator()(const Thing& thing) const {
    const Fields& fields = thing.fields();
    const std::string object = linked("object", &fields, links);
    return fields.row ? fmt::format("{} or [{}]", object, fmt::join(fields.row_keys(), ", ")) : object;
  }
  std::string operator()(const List& list) const {
    const std::string element = kind_text(*list.element, links);
    return fmt::format("{}[{}, …]", list.bare ? element + " or " : "", element);
  }
  std::string operator()(const ByName& group) const {
    return fmt::format("{{NAME: {}, …}}", kind_text(*group.element, links));
  }
  std::string operator()(const Forms& forms) const {
    const std::vector<const Fields*> things = things_in(std::vector{&kind});
    if (!forms.name.empty() && !things.empty() && links.contains(things.front()))
      return linked(std::string(forms.name), things.front(), links);
    std::vector<std::string> texts;
    for (const Form& form : forms.forms) texts.push_back(kind_text(*form.alternative.kind, links));
    return alternatives(texts);
  }
};

std::string kind_text(const Kind& kind, const Links& links) {
  return std::visit(KindText{kind, links}, kind.of);
}

// A key's own text, or that of what is under it.
std::string text_of(std::string_view own, const Kind& kind) {
  const auto* thing = std::get_if<Thing>(&kind.of);
  return std::string(own.empty() && thing ? thing->fields().text : own);
}

std::string presence_of(const Field& field, const void* defaults) {
  if (field.presence == Presence::required) return "required";
  const auto value = default_of(field, defaults);
  return value ? "default " + to_text(*value) : "";
}

// Adds a key, or to a like one what `list` has more; a choice goes with the others of its group.
void merge(const Key& key, std::vector<std::string_view> Key::*list, std::vector<Key>& keys) {
  const auto same = std::find_if(keys.begin(), keys.end(), [&](const Key& other) {
    return other.name == key.name && other.text == key.text && other.allowed() == key.allowed() &&
           other.group_number == key.group_number && (list == &Key::beside || other.beside == key.beside);
  });
  if (same != keys.end()) {
    same->kinds.insert(same->kinds.end(), key.kinds.begin(), key.kinds.end());
    (*same.*list).insert((*same.*list).end(), (key.*list).begin(), (key.*list).end());
    return;
  }
  const auto last = std::find_if(keys.rbegin(), keys.rend(), [&](const Key& other) {
    return key.group != nullptr && other.group_number == key.group_number;
  });
  keys.insert(last == keys.rend() ? keys.end() : last.base(), key);
}

std::vector<Key> keys_of(const Fields& fields);

// The choices of a group, then what stands beside some of them.
void add_group(const OneOf& group, std::vector<Key>& keys) {
  const int number = 1 + std::accumulate(keys.begin(), keys.end(), 0, [](int most, const Key& key) {
                       return std::max(most, key.group_number);
                     });
  std::vector<Key> companions;
  for (const Choice& choice : group.choices) {
    const Kind& kind = *choice.alternative.kind;
    if (choice.inside)
      keys.push_back({choice.key, text_of(choice.text, kind), {&kind}, "", &group, number});
    else
      for (Key& key : keys_of(std::get<Thing>(kind.of).fields())) {
        if (key.name == choice.key) {
          keys.push_back({key.name, key.text, key.kinds, "", &group, number});
          continue;
        }
        key.beside = {choice.key};
        merge(key, &Key::beside, companions);
      }
  }
  for (Key& key : companions) {
    if (group.required && key.beside.size() == group.choices.size()) key.beside.clear();
    keys.push_back(std::move(key));
  }
}

// Says which key may stand in the place of one that must be there.
void tell_any_of(const Fields& fields, std::vector<Key>& keys) {
  for (Key& key : keys)
    if (std::find(fields.any_of.begin(), fields.any_of.end(), key.name) != fields.any_of.end()) {
      std::vector<std::string_view> others = fields.any_of;
      std::erase(others, key.name);
      key.presence = fmt::format("{} {}", fields.exclusive ? "in place of" : "required without",
                                 fmt::join(others, ", "));
    }
}

std::vector<Key> keys_of(const Fields& fields) {
  std::vector<Key> keys;
  for (const Field& field : fields.fields) {
    if (const auto* group = std::get_if<OneOf>(field.part.get())) {
      add_group(*group, keys);
    } else if (const auto* lent = std::get_if<Lent>(field.part.get())) {
      for (Key& key : keys_of(lent->fields())) keys.push_back(std::move(key));
    } else {
      const Kind& kind = std::get<Kind>(*field.part);
      keys.push_back({field.key, text_of(field.text, kind), {&kind}, presence_of(field, fields.defaults)});
    }
  }
  tell_any_of(fields, keys);
  return keys;
}

/// Finds the things of each kind, each once.
struct CollectThings {
  std::vector<const Fields*>& things;

  void operator()(const Thing& thing) const {
    const Fields* fields = &thing.fields();
    if (std::find(things.begin(), things.end(), fields) == things.end()) things.push_back(fields);
  }
  void operator()(const List& list) const { std::visit(*this, list.element->of); }
  void operator()(const ByName& group) const { std::visit(*this, group.element->of); }
  void operator()(const Forms& forms) const {
    for (const Form& form : forms.forms) std::visit(*this, form.alternative.kind->of);
  }
  void operator()(const auto&) const {}
};

}  // namespace

std::string Key::meaning() const {
  std::string before;
  if (!of.empty()) before += fmt::format("Of {}: ", fmt::join(of, ", "));
  if (!beside.empty()) before += fmt::format("Beside `{}`: ", fmt::join(beside, "`, `"));
  return before + text;
}

std::string Key::allowed(const Links& links) const {
  std::vector<std::string> types;
  for (const Kind* kind : kinds) types.push_back(kind_text(*kind, links));
  return alternatives(types) + (presence.empty() ? "" : ", " + presence);
}

std::vector<Key> keys_of(std::span<const Fields* const> things) {
  std::vector<Key> keys;
  for (const Fields* thing : things)
    for (Key& key : keys_of(*thing)) {
      key.of = {thing->name};
      merge(key, &Key::of, keys);
    }
  for (Key& key : keys)
    if (key.of.size() == things.size()) key.of.clear();
  return keys;
}

std::vector<const Fields*> things_in(std::span<const Kind* const> kinds) {
  std::vector<const Fields*> things;
  for (const Kind* kind : kinds) std::visit(CollectThings{things}, kind->of);
  return things;
}

std::vector<Place> places_below(const Fields& root) {
  std::vector<Place> places{{"", &root}};
  for (std::size_t i = 0; i < places.size(); ++i)
    for (const Key& key : keys_of(*places[i].thing))
      for (const Fields* thing : things_in(key.kinds))
        if (std::none_of(places.begin(), places.end(), [&](const Place& p) { return p.thing == thing; }))
          places.push_back({joined(places[i].path, key.name), thing});
  return places;
}

std::string joined(std::string_view path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}/{}", path, key);
}

std::string_view heading(const OneOf& group) {
  return group.required ? "one of" : "at most one of";
}

}  // namespace abbe::schema
