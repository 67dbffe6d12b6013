#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/command_options.h"
#include "cli/output_files.h"
#include "description/lens_files.h"
#include "io/atomic_file.h"
#include "io/text.h"
#include "report/lens_report.h"
#include "report/svg.h"

namespace abbe::cli {
namespace {

using lens::FirstOrder;
using lens::Speed;

struct LensOptions {
  std::string lens;
  std::vector<double> wavelengths_nm;
  std::vector<double> frequencies_per_mm{10, 20, 40};
  std::filesystem::path html;
  std::filesystem::path drawing;
  bool json = false;
};

constexpr double kUmPerMm = 1000;

// Null if the value is missing or not finite.
Json finite(const std::optional<double>& value, double factor = 1) {
  return value && std::isfinite(*value) ? Json(factor * *value) : Json();
}

Json first_order_answer(const LensFigures& figures) {
  Json answer{{"wavelength_nm", figures.system.wavelengths_nm}};
  const auto add = [&](const char* name, double FirstOrder::*member) {
    for (const FirstOrder& first : figures.first_order) answer[name].push_back(finite(first.*member));
  };
  add("focal_length_mm", &FirstOrder::focal_length_mm);
  add("back_focus_mm", &FirstOrder::back_focus_mm);
  add("front_focus_mm", &FirstOrder::front_focus_mm);
  add("front_principal_mm", &FirstOrder::front_principal_mm);
  add("rear_principal_mm", &FirstOrder::rear_principal_mm);
  add("entrance_pupil_mm", &FirstOrder::entrance_pupil_mm);
  add("exit_pupil_mm", &FirstOrder::exit_pupil_mm);
  for (const FirstOrder& first : figures.first_order)
    answer["exit_diameter_mm"].push_back(
        finite(2 * figures.stop_radius_mm * std::abs(first.exit_magnification)));
  add("image_distance_mm", &FirstOrder::image_distance_mm);
  if (figures.system.object_distance_mm) add("magnification", &FirstOrder::magnification);
  const double primary = figures.first_order[figures.system.primary].image_distance_mm;
  for (const FirstOrder& first : figures.first_order)
    answer["focal_shift_um"].push_back(finite(kUmPerMm * (first.image_distance_mm - primary)));
  return answer;
}

Json wavelength_answer(const LensFigures& figures) {
  Json answer = first_order_answer(figures);
  const auto add = [&](const char* name, double Speed::*member) {
    for (const auto& speed : figures.speed) answer[name].push_back(speed ? finite((*speed).*member) : Json());
  };
  add("entrance_diameter_mm", &Speed::entrance_diameter_mm);
  add("f_number", &Speed::f_number);
  add("working_f_number", &Speed::working_f_number);
  add("transmittance", &Speed::transmittance);
  add("t_stop", &Speed::t_stop);
  add("airy_radius_um", &Speed::airy_radius_um);
  return answer;
}

Json seidel_answer(const lens::SeidelSums& sums) {
  using lens::Seidel;
  Json answer;
  for (std::size_t i = 0; i < sums.surfaces.size(); ++i) answer["surface"].push_back(i + 1);
  answer["surface"].push_back("sum");
  const auto add = [&](const char* name, double Seidel::*member) {
    for (const Seidel& surface : sums.surfaces) answer[name].push_back(finite(surface.*member));
    answer[name].push_back(finite(sums.sum.*member));
  };
  add("S_I", &Seidel::spherical);
  add("S_II", &Seidel::coma);
  add("S_III", &Seidel::astigmatism);
  add("S_IV", &Seidel::petzval);
  add("S_V", &Seidel::distortion);
  add("C_I", &Seidel::axial_color);
  add("C_II", &Seidel::lateral_color);
  return answer;
}

Json fans_answer(const LensFigures& figures, const LensFieldFigures& field) {
  Json fans = Json::array();
  for (std::size_t w = 0; w < field.fans.size(); ++w) {
    const lens::RayFan& fan = field.fans[w];
    Json one{{"wavelength_nm", figures.system.wavelengths_nm[w]}, {"pupil", fan.pupil}};
    one["tangential_um"] = one["sagittal_um"] = Json::array();
    for (std::size_t i = 0; i < fan.pupil.size(); ++i) {
      one["tangential_um"].push_back(finite(fan.tangential[i], kUmPerMm));
      one["sagittal_um"].push_back(finite(fan.sagittal[i], kUmPerMm));
    }
    fans.push_back(std::move(one));
  }
  return fans;
}

Json spots_answer(const LensFieldFigures& field) {
  Json spots = Json::array();
  for (std::size_t w = 0; w < field.spots.size(); ++w) {
    const lens::Spot& spot = field.spots[w];
    const auto size = lens::size_of({&spot, 1});
    const auto& chief = field.chiefs[w];
    Json one{{"wavelength_nm", spot.wavelength_nm}, {"rays", spot.rays.size()}};
    one["chief_mm"] = chief ? Json(chief->height_mm) : Json();
    one["distortion_percent"] = chief ? finite(chief->distortion, 100) : Json();
    one["centroid_mm"] = size ? Json{size->centroid.x, size->centroid.y} : Json();
    one["rms_um"] = size ? Json(kUmPerMm * size->rms_mm) : Json();
    one["largest_um"] = size ? Json(kUmPerMm * size->largest_mm) : Json();
    one["vignetting_percent"] = finite(spot.vignetting(), 100);
    spots.push_back(std::move(one));
  }
  return spots;
}

Json field_answer(const LensFigures& figures, const LensFieldFigures& field) {
  const auto size = lens::size_of(field.spots);
  Json answer{{figures.system.object_distance_mm ? "object_height_mm" : "field_deg", field.field}};
  answer["rms_um"] = size ? Json(kUmPerMm * size->rms_mm) : Json();
  answer["lateral_color_um"] = finite(field.lateral_color_mm(), kUmPerMm);
  answer["relative_illumination"] = finite(field.relative_illumination);
  answer["mtf"] = {{"per_mm", figures.frequencies_per_mm},
                   {"tangential", field.tangential_mtf},
                   {"sagittal", field.sagittal_mtf}};
  answer["spots"] = spots_answer(field);
  answer["fans"] = fans_answer(figures, field);
  return answer;
}

Json whole_answer(const LensFigures& figures) {
  Json answer{{"title", figures.system.title}, {"source", figures.system.source}};
  answer["primary_nm"] = figures.system.primary_nm();
  answer["set_at_nm"] = figures.system.set_at_nm.value_or(figures.system.primary_nm());
  answer["stop_surface"] = figures.system.stop + 1;
  answer["stop_radius_mm"] = figures.stop_radius_mm;
  answer["image_mm"] = figures.system.surfaces.back().thickness_mm;
  answer["best_focus_shift_mm"] = finite(figures.best_focus_mm);
  return answer;
}

// Adds the figures of a field as one line of a table.
void add_row(const LensFigures& figures, const LensFieldFigures& field, Json& table) {
  const std::size_t primary = figures.system.primary;
  const auto size = lens::size_of(field.spots);
  const auto& chief = field.chiefs[primary];
  table[figures.system.object_distance_mm ? "object_height_mm" : "field_deg"].push_back(field.field);
  table["image_mm"].push_back(chief ? Json(chief->height_mm) : Json());
  table["distortion_%"].push_back(chief ? finite(chief->distortion, 100) : Json());
  table["lateral_color_um"].push_back(finite(field.lateral_color_mm(), kUmPerMm));
  table["vignetting_%"].push_back(finite(field.spots[primary].vignetting(), 100));
  table["relative_illumination"].push_back(finite(field.relative_illumination));
  table["rms_um"].push_back(size ? Json(kUmPerMm * size->rms_mm) : Json());
  for (std::size_t i = 0; i < figures.frequencies_per_mm.size(); ++i) {
    table[fmt::format("T{:g}", figures.frequencies_per_mm[i])].push_back(field.tangential_mtf[i]);
    table[fmt::format("S{:g}", figures.frequencies_per_mm[i])].push_back(field.sagittal_mtf[i]);
  }
}

// Columns of the brightest ghosts, of which there are at most `max_count`.
Json ghosts_answer(const LensFigures& figures, std::size_t max_count) {
  Json answer = Json::object();
  for (const char* name : {"surface", "then", "reflectance", "focus_mm", "diameter_mm"})
    answer[name] = Json::array();
  for (std::size_t i = 0; i < std::min(max_count, figures.ghosts.size()); ++i) {
    const GhostFigures& ghost_figures = figures.ghosts[i];
    answer["surface"].push_back(ghost_figures.ghost.first + 1);
    answer["then"].push_back(ghost_figures.ghost.second + 1);
    answer["reflectance"].push_back(ghost_figures.ghost.reflectance);
    answer["focus_mm"].push_back(finite(ghost_figures.focus_mm));
    answer["diameter_mm"].push_back(finite(ghost_figures.diameter_mm));
  }
  return answer;
}

// Rounds numbers to the digits that fit into a table.
Json rounded(Json table) {
  for (auto& [name, values] : table.items())
    for (Json& value : values)
      if (value.is_number_float())
        value = fmt::format("{:.7g}", value.get<double>() + 0.0);  // removes negative zeros
  return table;
}

// All figures of a lens as JSON. Keys name the units; figures that do not exist, such as the focal length of
// an afocal lens, are null.
Json lens_answer(const LensFigures& figures) {
  Json answer = whole_answer(figures);
  answer.update(wavelength_answer(figures));
  answer["seidel_mm"] = seidel_answer(figures.seidel);
  answer["fields"] = Json::array();
  for (const LensFieldFigures& field : figures.fields)
    answer["fields"].push_back(field_answer(figures, field));
  answer["ghosts"] = ghosts_answer(figures, figures.ghosts.size());
  return answer;
}

// Figures of a lens as tables, each an object with a list per column. Numbers are texts of seven digits,
// except in `whole`, which has a single value per key.
struct LensTables {
  Json whole;
  Json wavelengths;  ///< First-order properties by wavelength.
  Json surfaces;     ///< Seidel sums [mm] by surface, counted from 1, and their sum.
  Json fields;       ///< Distortion, spots and modulation by field.
  Json ghosts;       ///< Up to ten ghosts, the brightest first; surfaces are counted from 1.
};
LensTables lens_tables(const LensFigures& figures) {
  constexpr std::size_t kGhosts = 10;
  Json fields;
  for (const LensFieldFigures& field : figures.fields) add_row(figures, field, fields);
  return {whole_answer(figures), rounded(wavelength_answer(figures)), rounded(seidel_answer(figures.seidel)),
          rounded(std::move(fields)), rounded(ghosts_answer(figures, kGhosts))};
}

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

// Self-contained HTML page with tables, drawing and plots.
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

// Transposed table with a line per column.
std::string transposed(const Json& columns) {
  std::string lines;
  for (const auto& [name, values] : columns.items()) {
    lines += fmt::format("{:<22}", name);
    for (const Json& value : values)
      lines += fmt::format("  {:>12}", value.is_string() ? value.get<std::string>()
                                       : value.is_null() ? "-"
                                                         : value.dump());
    lines += '\n';
  }
  return lines;
}

std::string tables_text(const LensFigures& figures) {
  const LensTables tables = lens_tables(figures);
  return fmt::format("{}\n{}\n{}\n{}\nbrightest ghosts\n{}", text(tables.whole, false),
                     transposed(tables.wavelengths), text(tables.surfaces, false), text(tables.fields, false),
                     text(tables.ghosts, false));
}

void lens(const LensOptions& options) {
  if (!options.html.empty()) require_extension(options.html, {".html"});
  if (!options.drawing.empty()) require_extension(options.drawing, {".svg"});
  Inputs inputs;
  Diagnostics diagnostics;
  const lens::System system =
      accepted(load_lens(options.lens, diagnostics, &inputs, {}, options.wavelengths_nm), diagnostics);
  require_distinct(std::array{options.html, options.drawing}, inputs.files());
  const LensFigures figures = lens_figures(system, options.frequencies_per_mm);
  if (!options.html.empty()) write_atomically(options.html, lens_page(figures));
  if (!options.drawing.empty()) write_atomically(options.drawing, lens_drawing(figures));
  fmt::print("{}", options.json ? text(lens_answer(figures), true) : tables_text(figures));
}

}  // namespace

void add_lens(CLI::App& app, Command& command) {
  const Subcommand<LensOptions> sub(
      app, "lens", "Report the first-order properties, aberrations, spots and losses of a lens", command,
      lens);
  add_value(*sub.app, "lens", sub->lens,
            "Prescription (.json), lens of Zemax (.zmx), table of pbrt (.dat), or a name in data/lens",
            "FILE.json|FILE.zmx|FILE.dat")
      ->required();
  add_parsed(*sub.app, "--lambda", sub->wavelengths_nm, numbers_in(kMinWavelengthNm, kMaxWavelengthNm),
             "Wavelengths in nm that replace those of the lens; the primary one is at the centre of the "
             "list, and stop and focus stay as set at the lens's own",
             "NM,...");
  add_parsed(*sub.app, "--frequencies", sub->frequencies_per_mm, numbers_in(1e-3, 1e4),
             "Spatial frequencies of the modulation transfer function in cycles per mm (default 10,20,40)",
             "N,...");
  add_value(*sub.app, "--html", sub->html, "HTML page to write", "FILE.html");
  add_value(*sub.app, "-o,--output", sub->drawing, "Drawing of the lens to write", "FILE.svg");
  add_json(*sub.app, sub->json);
}

}  // namespace abbe::cli
