#include "io/schema/documentation.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "io/schema/write.h"
#include "io/text.h"

namespace abbe::schema {

namespace {
std::string joined(std::string_view path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}/{}", path, key);
}

std::string_view group_label(const OneOf& group) {
  return group.required ? "one of" : "at most one of";
}

/// Collects the structs in each value type, each once.
struct CollectStructs {
  std::vector<const Fields*>& structs;

  void operator()(const Struct& structure) const {
    const Fields* fields = &structure.fields();
    if (std::ranges::count(structs, fields) == 0) structs.push_back(fields);
  }
  void operator()(const List& list) const { std::visit(*this, list.element->variant); }
  void operator()(const ByName& group) const { std::visit(*this, group.element->variant); }
  void operator()(const Forms& forms) const {
    for (const Form& form : forms.forms) std::visit(*this, form.alternative.type->variant);
  }
  void operator()(const auto&) const {}
};

// The structs that are values of these types, or elements or alternatives of them, each once.
std::vector<const Fields*> structs_in(std::span<const ValueType* const> types) {
  std::vector<const Fields*> structs;
  for (const ValueType* type : types) std::visit(CollectStructs{structs}, type->variant);
  return structs;
}

std::string type_text(const ValueType& type, const Links& links);

// "number in (0, 1e+12] nm", or the number itself if the range is a single value.
std::string within(std::string_view what, const Range& range) {
  if (range.low == range.high) return fmt::format("{}", range.low);
  std::string text = range.text();
  if (text == Range::any().text()) return std::string(what);
  if (!range.unit_name.empty()) text += fmt::format(" {}", range.unit_name);
  for (std::size_t at = 0; (at = text.find("000000")) != std::string::npos;) {
    const std::size_t zeros = text.find_first_not_of('0', at) - at;
    text.replace(at, zeros, fmt::format("e+{:02}", zeros));
  }
  return fmt::format("{} in {}", what, text);
}

std::string linked(std::string word, const Fields* fields, const Links& links) {
  std::replace(word.begin(), word.end(), '_', ' ');
  const auto link = links.find(fields);
  return link == links.end() ? word : fmt::format("[{}](#{})", word, link->second);
}

// The distinct texts, as "a, b or c".
std::string alternatives(const std::vector<std::string>& texts) {
  std::vector<std::string> all;
  for (const std::string& text : texts)
    if (std::ranges::count(all, text) == 0) all.push_back(text);
  const std::string last = all.back();
  all.pop_back();
  return all.empty() ? last : fmt::format("{} or {}", fmt::join(all, ", "), last);
}

struct TypeText {
  const ValueType& type;
  const Links& links;

  std::string operator()(const Number& number) const { return within("number", number.range); }
  std::string operator()(const Integer& integer) const { return within("integer", integer.range); }
  std::string operator()(const Boolean&) const { return "true or false"; }
  std::string operator()(const Text&) const { return "text"; }
  std::string operator()(const Enumeration& enumeration) const {
    std::vector<std::string> names;
    for (const char* name : enumeration.names) names.push_back(fmt::format("\"{}\"", name));
    return alternatives(names);
  }
  std::string operator()(const Vector& vector) const {
    if (vector.nonzero) return fmt::format("{} numbers, not all 0", vector.count);
    return within(fmt::format("{} {}", vector.count, vector.integers ? "integers" : "numbers"), vector.range);
  }
  std::string operator()(const Numbers& numbers) const { return within("numbers", numbers.range); }
  std::string operator()(const Struct& structure) const {
    const Fields& fields = structure.fields();
    const std::string object = linked("object", &fields, links);
    return fields.array_form ? fmt::format("{} or [{}]", object, fmt::join(fields.array_keys(), ", "))
                             : object;
  }
  std::string operator()(const List& list) const {
    const std::string element = type_text(*list.element, links);
    return fmt::format("{}[{}, …]", list.allows_single ? element + " or " : "", element);
  }
  std::string operator()(const ByName& group) const {
    return fmt::format("{{NAME: {}, …}}", type_text(*group.element, links));
  }
  std::string operator()(const Forms& forms) const {
    const std::vector<const Fields*> structs = structs_in(std::vector{&type});
    if (!forms.name.empty() && !structs.empty() && links.contains(structs.front()))
      return linked(std::string(forms.name), structs.front(), links);
    std::vector<std::string> texts;
    for (const Form& form : forms.forms) texts.push_back(type_text(*form.alternative.type, links));
    return alternatives(texts);
  }
};

std::string type_text(const ValueType& type, const Links& links) {
  return std::visit(TypeText{type, links}, type.variant);
}

// The key's own text, or that of the struct that is its value.
std::string text_of(std::string_view own, const ValueType& type) {
  const auto* structure = std::get_if<Struct>(&type.variant);
  return std::string(own.empty() && structure ? structure->fields().text : own);
}

std::string presence_of(const Field& field, const void* defaults) {
  if (field.presence == Presence::required) return "required";
  const auto value = default_of(field, defaults);
  return value ? "default " + to_text(*value) : "";
}

// Adds a key. If an equal key exists, appends the entries of `list` to it. A choice is inserted after the
// others of its group.
void merge(const Key& key, std::vector<std::string_view> Key::*list, std::vector<Key>& keys) {
  const auto same = std::find_if(keys.begin(), keys.end(), [&](const Key& other) {
    return other.name == key.name && other.text == key.text && other.allowed() == key.allowed() &&
           other.group_number == key.group_number &&
           (list == &Key::sibling_keys || other.sibling_keys == key.sibling_keys);
  });
  if (same != keys.end()) {
    same->types.insert(same->types.end(), key.types.begin(), key.types.end());
    (*same.*list).insert((*same.*list).end(), (key.*list).begin(), (key.*list).end());
    return;
  }
  const auto last = std::find_if(keys.rbegin(), keys.rend(), [&](const Key& other) {
    return key.group != nullptr && other.group_number == key.group_number;
  });
  keys.insert(last == keys.rend() ? keys.end() : last.base(), key);
}

std::vector<Key> keys_of(const Fields& fields);

// Adds the choices of a group, then the keys that some of the choices add.
void add_group(const OneOf& group, std::vector<Key>& keys) {
  int number = 1;
  for (const Key& key : keys) number = std::max(number, key.group_number + 1);
  std::vector<Key> companions;
  for (const Choice& choice : group.choices) {
    const ValueType& type = *choice.alternative.type;
    if (choice.nested)
      keys.push_back({choice.key, text_of(choice.text, type), {&type}, "", &group, number});
    else
      for (Key& key : keys_of(std::get<Struct>(type.variant).fields())) {
        if (key.name == choice.key) {
          keys.push_back({key.name, key.text, key.types, "", &group, number});
          continue;
        }
        key.sibling_keys = {choice.key};
        merge(key, &Key::sibling_keys, companions);
      }
  }
  for (Key& key : companions) {
    if (group.required && key.sibling_keys.size() == group.choices.size()) key.sibling_keys.clear();
    keys.push_back(std::move(key));
  }
}

// Sets the presence of keys that may replace one another.
void set_any_of_presence(const Fields& fields, std::vector<Key>& keys) {
  for (Key& key : keys)
    if (std::ranges::count(fields.any_of, key.name) != 0) {
      std::vector<std::string_view> others = fields.any_of;
      std::erase(others, key.name);
      key.presence = fmt::format("{} {}", fields.exclusive ? "in place of" : "required without",
                                 fmt::join(others, ", "));
    }
}

std::vector<Key> keys_of(const Fields& fields) {
  std::vector<Key> keys;
  for (const Field& field : fields.fields) {
    if (const auto* group = std::get_if<OneOf>(field.content.get())) {
      add_group(*group, keys);
    } else if (const auto* inlined = std::get_if<Inlined>(field.content.get())) {
      for (Key& key : keys_of(inlined->fields())) keys.push_back(std::move(key));
    } else {
      const ValueType& type = std::get<ValueType>(*field.content);
      keys.push_back({field.key, text_of(field.text, type), {&type}, presence_of(field, fields.defaults)});
    }
  }
  set_any_of_presence(fields, keys);
  return keys;
}

constexpr std::string_view kBegin = "<!-- keys: ";
constexpr std::string_view kBeginEnd = " -->";
constexpr std::string_view kEnd = "<!-- end -->";

/// Keys of some structs, under the path that leads to them from the structs of the table.
struct Section {
  std::string path;
  std::vector<const Fields*> structs;
};
struct Table {
  std::string anchor;  ///< Anchor of the preceding heading.
  std::vector<Section> sections;
};

// Markdown anchor of a heading: its words in lower case, joined by hyphens.
std::string anchor_of(std::string_view heading) {
  std::string anchor;
  for (const char c : heading.substr(heading.find(' ') + 1)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ' || c == '-') anchor += '-';
    if (std::isalnum(byte) != 0 || c == '_') anchor += static_cast<char>(std::tolower(byte));
  }
  return anchor;
}

// The structs of a comma-separated list of names. Throws Error{internal} for an unknown name.
Section named_section(std::string_view names, const std::vector<StructPath>& paths) {
  Section section;
  for (const std::string& name : split(names, ',')) {
    const auto path_entry =
        std::ranges::find(paths, name, [](const StructPath& p) { return p.fields->name; });
    if (path_entry == paths.end())
      throw Error(ErrorCode::internal, "", fmt::format("the guide names the unknown struct \"{}\"", name));
    section.structs.push_back(path_entry->fields);
  }
  return section;
}

// Adds sections for structs inside those of the first section that have no anchor yet.
void add_sections(Table& table, Links& links) {
  for (std::size_t i = 0; i < table.sections.size(); ++i)
    for (const Key& key : keys_of(table.sections[i].structs)) {
      Section below{joined(table.sections[i].path, key.name), {}};
      for (const Fields* fields : structs_in(key.types))
        if (links.emplace(fields, table.anchor).second) below.structs.push_back(fields);
      if (!below.structs.empty()) table.sections.push_back(std::move(below));
    }
}

/// The tables of a guide, and the anchor of each struct.
struct Plan {
  std::vector<Table> tables;
  Links links;
};

// Finds the tables of the guide, and decides in which table each struct is described.
Plan plan_of(const std::string& guide, const Fields& root) {
  const std::vector<StructPath> paths = structs_below(root);
  Plan plan;
  std::string anchor;
  std::istringstream lines(guide);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) anchor = anchor_of(line);
    if (!line.starts_with(kBegin)) continue;
    const std::size_t size = line.size() - kBegin.size() - kBeginEnd.size();
    Table& table = plan.tables.emplace_back();
    table = {anchor, {named_section(line.substr(kBegin.size(), size), paths)}};
    for (const Fields* fields : table.sections.front().structs) plan.links.emplace(fields, anchor);
  }
  for (Table& table : plan.tables) add_sections(table, plan.links);
  return plan;
}

// Escapes the text for a table cell, where '|' would end the cell and '<' begin an element.
std::string cell(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '|' || c == '<') safe += '\\';
    safe += c;
  }
  return safe;
}

// Adds a row for each key of a section, and a row above each group of keys.
void add_rows(const Section& section, const Links& links, std::string& page) {
  int group = 0;
  const std::string under = section.path.empty() ? "" : fmt::format("`{}`: ", section.path);
  for (const Key& key : keys_of(section.structs)) {
    if (key.group != nullptr && key.group_number != group)
      page += fmt::format("| {}{} | | |\n", under, group_label(*key.group));
    group = key.group_number;
    page += fmt::format("| {}`{}` | {} | {} |\n", group == 0 ? "" : "– ", joined(section.path, key.name),
                        cell(key.meaning()), cell(key.allowed(links)));
  }
}

std::string page_of(const Table& table, Links links) {
  for (auto below = table.sections.begin() + 1; below != table.sections.end(); ++below)
    for (const Fields* fields : below->structs) links.erase(fields);
  std::string page = "| key | meaning | type, range, default |\n| --- | --- | --- |\n";
  for (const Section& section : table.sections) add_rows(section, links, page);
  return page;
}

// The keys of these structs as indented lines, with a label above each group.
std::string keys_text(const std::vector<const Fields*>& structs) {
  std::string text;
  int group = 0;
  for (const Key& key : keys_of(structs)) {
    if (key.group != nullptr && key.group_number != group)
      text += fmt::format("\n  {}\n", group_label(*key.group));
    const char* indent = key.group != nullptr ? "    " : "  ";
    if (key.group == nullptr && group != 0) text += '\n';
    group = key.group_number;
    text += fmt::format("{0}{1}\n{0}    {2}\n{0}    {3}\n", indent, key.name, key.meaning(), key.allowed());
  }
  return text;
}

std::string entry(const std::string& path, const Key& key) {
  std::string text = fmt::format("{}\n  {}\n  {}\n", path, key.meaning(), key.allowed());
  const std::vector<const Fields*> structs = structs_in(key.types);
  return structs.empty() ? text : text + '\n' + keys_text(structs);
}

[[noreturn]] void refuse(const std::string& key, const std::vector<std::string>& known) {
  throw Error(ErrorCode::usage, "", unknown_name("key", key, known));
}

// True if values of these types have an element that the step of a path names: a number in lists, or a name
// that the user chose.
bool hold_element(const std::vector<const ValueType*>& types, const std::string& step) {
  const bool is_number = step.find_first_not_of("0123456789") == std::string::npos;
  return std::ranges::any_of(types, [is_number](const ValueType* type) {
    return std::holds_alternative<ByName>(type->variant) ||
           (is_number && std::holds_alternative<List>(type->variant));
  });
}

// Help for a path of keys, or for a JSON pointer as in error messages, with numbers and names of elements.
std::string entry_at(const Fields& root, const std::string& path) {
  std::vector<const Fields*> structs{&root};
  std::vector<std::string> steps = split(path, '/');
  std::erase(steps, "");
  std::string text;
  std::string keys;
  std::vector<const ValueType*> holders;
  for (const std::string& step : steps) {
    std::vector<std::string> known;
    std::string found;
    std::vector<const Fields*> below;
    std::vector<const ValueType*> types;
    for (const Key& key : keys_of(structs)) {
      known.emplace_back(key.name);
      if (key.name != step) continue;
      found += entry(joined(keys, step), key);
      types.insert(types.end(), key.types.begin(), key.types.end());
      for (const Fields* fields : structs_in(key.types)) below.push_back(fields);
    }
    if (found.empty() && !hold_element(holders, step)) refuse(step, known);
    holders = std::move(types);
    if (found.empty()) continue;
    text = std::move(found);
    keys = joined(keys, step);
    structs = std::move(below);
  }
  return text;
}
}  // namespace

std::string Key::meaning() const {
  std::string before;
  if (!owners.empty()) before += fmt::format("In {}: ", fmt::join(owners, ", "));
  std::replace(before.begin(), before.end(), '_', ' ');  // names of objects, as words
  if (!sibling_keys.empty()) before += fmt::format("With `{}`: ", fmt::join(sibling_keys, "`, `"));
  return before + text;
}

std::string Key::allowed(const Links& links) const {
  std::vector<std::string> texts;
  for (const ValueType* type : types) texts.push_back(type_text(*type, links));
  return alternatives(texts) + (presence.empty() ? "" : ", " + presence);
}

std::vector<Key> keys_of(std::span<const Fields* const> structs) {
  std::vector<Key> keys;
  for (const Fields* fields : structs)
    for (Key& key : keys_of(*fields)) {
      key.owners = {fields->name};
      merge(key, &Key::owners, keys);
    }
  for (Key& key : keys)
    if (key.owners.size() == structs.size()) key.owners.clear();
  return keys;
}

std::vector<StructPath> structs_below(const Fields& root) {
  std::vector<StructPath> paths{{"", &root}};
  for (std::size_t i = 0; i < paths.size(); ++i)
    for (const Key& key : keys_of(*paths[i].fields))
      for (const Fields* fields : structs_in(key.types))
        if (std::ranges::count(paths, fields, &StructPath::fields) == 0)
          paths.push_back({joined(paths[i].path, key.name), fields});
  return paths;
}

std::string with_tables(const std::string& guide, const Fields& root) {
  const Plan plan = plan_of(guide, root);
  std::string page;
  std::size_t at = 0;
  for (const Table& table : plan.tables) {
    const std::size_t rows = guide.find('\n', guide.find(kBegin, at)) + 1;
    const std::size_t end = guide.find(kEnd, rows);
    if (end == std::string::npos)
      throw Error(ErrorCode::internal, "", fmt::format("a table of the guide has no end line {}", kEnd));
    page += guide.substr(at, rows - at) + page_of(table, plan.links);
    at = end;
  }
  return page + guide.substr(at);
}

std::string help(const Fields& root, const std::string& key) {
  if (key.empty()) return keys_text({&root});
  if (key.find('/') != std::string::npos) return entry_at(root, key);
  std::string text;
  for (const StructPath& path_entry : structs_below(root))
    for (const Key& known : keys_of(std::vector{path_entry.fields}))
      if (known.name == key) text += (text.empty() ? "" : "\n") + entry(joined(path_entry.path, key), known);
  if (text.empty()) refuse(key, all_keys(root));
  return text;
}

std::vector<std::string> all_keys(const Fields& root) {
  std::set<std::string> keys;
  for (const StructPath& path_entry : structs_below(root))
    for (const Key& key : keys_of(std::vector{path_entry.fields})) keys.emplace(key.name);
  return {keys.begin(), keys.end()};
}

}  // namespace abbe::schema
