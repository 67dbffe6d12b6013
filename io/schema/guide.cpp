#include "io/schema/guide.h"

#include <algorithm>
#include <cctype>
#include <sstream>

#include <fmt/format.h>

#include "io/error.h"
#include "io/schema/keys.h"
#include "io/text.h"

namespace abbe::schema {
namespace {

constexpr std::string_view kBegin = "<!-- keys: ";
constexpr std::string_view kBeginEnd = " -->";
constexpr std::string_view kEnd = "<!-- end -->";

/// Keys of some things, under the path that leads to these from the things of the table.
struct Section {
  std::string path;
  std::vector<const Fields*> things;
};
struct Table {
  std::string anchor;  ///< Of the heading above.
  std::vector<Section> sections;
};

// What a heading is linked by: its words in small letters, joined by hyphens.
std::string anchor_of(std::string_view heading) {
  std::string anchor;
  for (const char c : heading.substr(heading.find(' ') + 1)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ' ' || c == '-') anchor += '-';
    if (std::isalnum(byte) != 0 || c == '_') anchor += static_cast<char>(std::tolower(byte));
  }
  return anchor;
}

Section named_section(std::string_view names, const std::vector<Place>& places) {
  Section section;
  for (const std::string& name : split(names, ',')) {
    const auto place =
        std::find_if(places.begin(), places.end(), [&](const Place& p) { return p.thing->name == name; });
    if (place == places.end())
      throw Error(ErrorCode::internal, "", fmt::format("the guide asks for the keys of \"{}\"", name));
    section.things.push_back(place->thing);
  }
  return section;
}

// Adds sections for what lies below the first and is told nowhere yet.
void add_sections(Table& table, Links& links) {
  for (std::size_t i = 0; i < table.sections.size(); ++i)
    for (const Key& key : keys_of(table.sections[i].things)) {
      Section below{joined(table.sections[i].path, key.name), {}};
      for (const Fields* thing : things_in(key.kinds))
        if (links.emplace(thing, table.anchor).second) below.things.push_back(thing);
      if (!below.things.empty()) table.sections.push_back(std::move(below));
    }
}

/// The tables that a guide asks for, and where each thing is told.
struct Plan {
  std::vector<Table> tables;
  Links links;
};

Plan plan_of(const std::string& guide, const Fields& root) {
  const std::vector<Place> places = places_below(root);
  Plan plan;
  std::string anchor;
  std::istringstream lines(guide);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) anchor = anchor_of(line);
    if (!line.starts_with(kBegin)) continue;
    const std::size_t size = line.size() - kBegin.size() - kBeginEnd.size();
    Table& table = plan.tables.emplace_back();
    table = {anchor, {named_section(line.substr(kBegin.size(), size), places)}};
    for (const Fields* thing : table.sections.front().things) plan.links.emplace(thing, anchor);
  }
  for (Table& table : plan.tables) add_sections(table, plan.links);
  return plan;
}

// Text for a cell, where a bar would end it and < begin an element.
std::string cell(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '|' || c == '<') safe += '\\';
    safe += c;
  }
  return safe;
}

void add_rows(const Section& section, const Links& links, std::string& page) {
  int group = 0;
  const std::string under = section.path.empty() ? "" : fmt::format("`{}`: ", section.path);
  for (const Key& key : keys_of(section.things)) {
    if (key.group != nullptr && key.group_number != group)
      page += fmt::format("| {}{} | | |\n", under, heading(*key.group));
    group = key.group_number;
    page += fmt::format("| {}`{}` | {} | {} |\n", group == 0 ? "" : "– ", joined(section.path, key.name),
                        cell(key.meaning()), cell(key.allowed(links)));
  }
}

std::string page_of(const Table& table, Links links) {
  for (auto below = table.sections.begin() + 1; below != table.sections.end(); ++below)
    for (const Fields* thing : below->things) links.erase(thing);
  std::string page = "| key | meaning | type, range, default |\n| --- | --- | --- |\n";
  for (const Section& section : table.sections) add_rows(section, links, page);
  return page;
}

}  // namespace

std::string with_tables(const std::string& guide, const Fields& root) {
  const Plan plan = plan_of(guide, root);
  std::string page;
  std::size_t at = 0;
  for (const Table& table : plan.tables) {
    const std::size_t rows = guide.find('\n', guide.find(kBegin, at)) + 1;
    const std::size_t end = guide.find(kEnd, rows);
    if (end == std::string::npos)
      throw Error(ErrorCode::internal, "", fmt::format("a table of the guide lacks its {}", kEnd));
    page += guide.substr(at, rows - at) + page_of(table, plan.links);
    at = end;
  }
  return page + guide.substr(at);
}

}  // namespace abbe::schema
