#include "cli/page.h"

#include <fmt/format.h>

#include "report/svg.h"

namespace abbe::cli {
namespace {

constexpr const char* kStyle =
    "body { font: 15px/1.5 system-ui, \"DejaVu Sans\", sans-serif; color: #1c2430; max-width: 1080px; "
    "margin: 0 auto; "
    "padding: 24px; }\nh2 { border-bottom: 2px solid; margin-top: 40px; }\n"
    ".patches { display: grid; grid-template-columns: repeat(auto-fill, minmax(150px, 1fr)); gap: 10px; }\n"
    ".patch { font-size: 12px; }\n.swatch { display: flex; height: 54px; }\n.swatch div { flex: 1; }\n"
    "table { border-collapse: collapse; }\ntd, th { padding: 2px 14px 2px 0; text-align: right; }\n"
    "td:first-child, th:first-child { text-align: left; }\n.soft { color: #5b6675; }\n";

}  // namespace

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

std::string inline_svg(const std::string& document) {
  return document.substr(document.find("<svg"));
}

}  // namespace abbe::cli
