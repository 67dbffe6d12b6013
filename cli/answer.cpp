#include "cli/answer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "io/error.h"
#include "report/svg.h"

namespace abbe::cli {
namespace {

// Text of a value. Null and numbers that are not finite become "-".
std::string cell(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null() || (value.is_number_float() && !std::isfinite(value.get<double>()))) return "-";
  if (value.is_number_float()) return fmt::format("{:.10g}", value.get<double>());
  if (!value.is_structured()) return value.dump();
  std::string cells;
  for (const auto& [key, inner] : value.items())
    cells += (cells.empty() ? "" : "  ") + (value.is_object() ? key + " " : "") + cell(inner);
  return cells;
}

// Table with one column per list below its name. All lists have the same length.
std::string table(const std::vector<std::pair<std::string, Json>>& columns) {
  std::string all;
  std::vector<std::vector<std::string>> cells;
  std::vector<std::size_t> widths;
  for (const auto& [name, values] : columns) {
    std::vector<std::string>& column = cells.emplace_back(1, name);
    for (const Json& value : values) column.push_back(cell(value));
    widths.push_back(std::ranges::max_element(column, [](const auto& a, const auto& b) {
                       return a.size() < b.size();
                     })->size());
  }
  for (std::size_t row = 0; !cells.empty() && row < cells.front().size(); ++row) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      all += fmt::format("{}{:>{}}", i == 0 ? "" : "  ", cells[i][row], widths[i]);
    all += '\n';
  }
  return all;
}

// Keys of the lists that can start a table.
constexpr std::array<std::string_view, 4> kFirstColumns{"wavelength_nm", "surface", "field_deg",
                                                        "object_height_mm"};

std::string readable(const Json& answer) {
  std::string lines;
  std::vector<std::pair<std::string, Json>> columns;
  for (const auto& [key, value] : answer.items()) {
    const bool is_column = columns.empty() ? std::ranges::find(kFirstColumns, key) != kFirstColumns.end()
                                           : value.size() == columns.front().second.size();
    if (is_column && value.is_array())
      columns.emplace_back(key, value);
    else
      lines += fmt::format("{}  {}\n", key, cell(value));
  }
  return lines + table(columns);
}

constexpr const char* kStyle =
    "body { font: 15px/1.5 system-ui, \"DejaVu Sans\", sans-serif; color: #1c2430; max-width: 1080px; "
    "margin: 0 auto; "
    "padding: 24px; }\nh2 { border-bottom: 2px solid; margin-top: 40px; }\n"
    ".patches { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: 10px; }\n"
    ".patch { font-size: 12px; }\n.swatch { display: flex; height: 54px; }\n.swatch div { flex: 1; }\n"
    "table { border-collapse: collapse; }\ntd, th { padding: 2px 14px 2px 0; text-align: right; }\n"
    "td:first-child, th:first-child { text-align: left; }\n.soft { color: #5b6675; }\n";

}  // namespace

std::string text(const Json& answer, bool as_json) {
  return as_json ? answer.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n" : readable(answer);
}

void print(const Json& answer, bool as_json) {
  fmt::print("{}", text(answer, as_json));
}

std::string csv_quoted(const std::string& text) {
  std::string cell = "\"";
  for (const char c : text) cell += c == '"' ? "\"\"" : std::string(1, c);
  return cell + '"';
}

std::string csv_cell(const std::string& text) {
  return text.find_first_of(",\"\r\n") == std::string::npos ? text : csv_quoted(text);
}

Json one_or_all(Json list) {
  return list.size() == 1 ? list.front() : list;
}

Json without_lists_of_one(Json answer) {
  if (!answer.is_structured()) return answer;
  for (Json& inner : answer) inner = without_lists_of_one(std::move(inner));
  return answer.is_array() ? one_or_all(std::move(answer)) : answer;
}

void print_to_stderr(const std::string& text) {
  (void)!std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void print_message(const std::string& message) {
  print_to_stderr(fmt::format("abbe: {}\n", message));
}

void warn(const std::optional<std::string>& warning, bool strict) {
  if (!warning) return;
  if (strict) throw Error(ErrorCode::scene, "", *warning);
  print_message("warning: " + *warning);
}

void check(const Diagnostics& diagnostics) {
  require_no_errors(diagnostics);
  print_to_stderr(diagnostics.text());
}

std::string page_head(const std::string& title) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta "
      "charset=\"utf-8\"><title>{0}</title>\n<style>\n{1}</style></head>\n"
      "<body>\n<h1>{0}</h1>\n",
      escaped(title), kStyle);
}

std::string table_cell(const Json& value) {
  return value.is_string() ? escaped(value.get<std::string>())
         : value.is_null() ? "\u2013"
                           : escaped(value.dump());
}

}  // namespace abbe::cli
