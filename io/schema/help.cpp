#include "io/schema/help.h"

#include <set>

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

std::string entry_at(const Fields& root, const std::string& path) {
  std::vector<const Fields*> things{&root};
  std::string text;
  for (const std::string& step : split(path, '/')) {
    std::vector<std::string> known;
    text.clear();
    std::vector<const Fields*> below;
    for (const Key& key : keys_of(things)) {
      known.emplace_back(key.name);
      if (key.name != step) continue;
      text += entry(path, key);
      for (const Fields* thing : things_in(key.kinds)) below.push_back(thing);
    }
    if (text.empty()) refuse(step, known);
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
