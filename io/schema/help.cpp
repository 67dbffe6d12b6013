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

std::string keys_text(const std::vector<const Fields*>& things) {
  std::string text;
  int group = 0;
  for (const Key& key : keys_of(things)) {
    if (key.group != nullptr && key.group_number != group)
      text += fmt::format("\n  {}\n", heading(*key.group));
    const char* indent = key.group != nullptr ? "    " : "  ";
    if (key.group == nullptr && group != 0) text += '\n';
    group = key.group_number;
    text += fmt::format("{0}{1}\n{0}    {2}\n{0}    {3}\n", indent, key.name, key.meaning(), key.allowed());
  }
  return text;
}

std::string entry(const std::string& path, const Key& key) {
  std::string text = fmt::format("{}\n  {}\n  {}\n", path, key.meaning(), key.allowed());
  const std::vector<const Fields*> things = things_in(key.kinds);
  return things.empty() ? text : text + '\n' + keys_text(things);
}

[[noreturn]] void refuse(const std::string& key, const std::vector<std::string>& known) {
  throw Error(ErrorCode::usage, "", unknown_name("key", key, known));
}

// Whether values of these kinds hold an element that goes by this: a number in lists, or else a name that the
// user chose.
bool hold_element(const std::vector<const Kind*>& kinds, const std::string& step) {
  const bool is_number = step.find_first_not_of("0123456789") == std::string::npos;
  return std::any_of(kinds.begin(), kinds.end(), [is_number](const Kind* kind) {
    return std::holds_alternative<ByName>(kind->of) || (is_number && std::holds_alternative<List>(kind->of));
  });
}

// A path of keys, or a JSON pointer as complaints print it, with the numbers and names of elements.
std::string entry_at(const Fields& root, const std::string& path) {
  std::vector<const Fields*> things{&root};
  std::vector<std::string> steps = split(path, '/');
  std::erase(steps, "");
  std::string text;
  std::string keys;
  std::vector<const Kind*> holders;
  for (const std::string& step : steps) {
    std::vector<std::string> known;
    std::string found;
    std::vector<const Fields*> below;
    std::vector<const Kind*> kinds;
    for (const Key& key : keys_of(things)) {
      known.emplace_back(key.name);
      if (key.name != step) continue;
      found += entry(joined(keys, step), key);
      kinds.insert(kinds.end(), key.kinds.begin(), key.kinds.end());
      for (const Fields* thing : things_in(key.kinds)) below.push_back(thing);
    }
    if (found.empty() && !hold_element(holders, step)) refuse(step, known);
    holders = std::move(kinds);
    if (found.empty()) continue;
    text = std::move(found);
    keys = joined(keys, step);
    things = std::move(below);
  }
  return text;
}

}  // namespace

std::string help(const Fields& root, const std::string& key) {
  if (key.empty()) return keys_text({&root});
  if (key.find('/') != std::string::npos) return entry_at(root, key);
  std::string text;
  for (const Place& place : places_below(root))
    for (const Key& known : keys_of(std::vector{place.thing}))
      if (known.name == key) text += (text.empty() ? "" : "\n") + entry(joined(place.path, key), known);
  if (text.empty()) refuse(key, all_keys(root));
  return text;
}

std::vector<std::string> all_keys(const Fields& root) {
  std::set<std::string> keys;
  for (const Place& place : places_below(root))
    for (const Key& key : keys_of(std::vector{place.thing})) keys.emplace(key.name);
  return {keys.begin(), keys.end()};
}

}  // namespace abbe::schema
