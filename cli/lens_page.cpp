#include <fmt/format.h>

#include "cli/lens_answer.h"
#include "cli/page.h"
#include "report/lens_drawing.h"
#include "report/lens_plots.h"
#include "report/svg.h"

namespace abbe::cli {
namespace {

// HTML table with a column per list.
std::string columns_table(const Json& table) {
  std::string html = "<table>\n<tr>";
  for (const auto& [name, values] : table.items()) html += fmt::format("<th>{}</th>", escaped(name));
  html += "</tr>\n";
  for (std::size_t row = 0; row < table.front().size(); ++row) {
    html += "<tr>";
    for (const Json& values : table) html += fmt::format("<td>{}</td>", table_cell(values.at(row)));
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

// HTML table with a row per list or per single value.
std::string rows_table(const Json& table) {
  std::string html = "<table>\n";
  for (const auto& [name, values] : table.items()) {
    html += fmt::format("<tr><td>{}</td>", escaped(name));
    for (const Json& value : values.is_array() ? values : Json::array({values}))
      html += fmt::format("<td>{}</td>", table_cell(value));
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

std::string lens_page(const LensFigures& figures) {
  const LensTables tables = lens_tables(figures);
  std::string html = page_head(figures.system.title);
  html += inline_svg(lens_drawing(figures)) + rows_table(tables.whole);
  html += "<h2>By wavelength</h2>\n" + rows_table(tables.wavelengths) + inline_svg(focal_shift_plot(figures));
  html += "<h2>Seidel sums [mm]</h2>\n" + columns_table(tables.surfaces);
  html +=
      "<h2>By field</h2>\n<p>The modulation is geometric. Diffraction lowers it further for lines as fine as "
      "the Airy disc.</p>\n" +
      columns_table(tables.fields);
  html += "<h2>Brightest ghosts of a point on the axis</h2>\n" + columns_table(tables.ghosts);
  html += inline_svg(spot_plot(figures)) + inline_svg(lens_mtf_plot(figures));
  for (const LensFieldFigures& field : figures.fields) html += inline_svg(fan_plot(figures, field));
  return html + kPageEnd;
}

}  // namespace abbe::cli
