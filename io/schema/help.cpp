#include "io/schema/help.h"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "io/error.h"
#include "io/schema/keys.h"
#include "io/text.h"

namespace abbe::schema {
namespace {

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
  return std::any_of(types.begin(), types.end(), [is_number](const ValueType* type) {
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
