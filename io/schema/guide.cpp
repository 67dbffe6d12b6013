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
        std::find_if(paths.begin(), paths.end(), [&](const StructPath& p) { return p.fields->name == name; });
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

}  // namespace

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

}  // namespace abbe::schema
