#include "cli/lab.h"

#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/output_files.h"
#include "cli/rays.h"
#include "description/load.h"
#include "io/atomic_file.h"
#include "io/picture.h"
#include "io/text.h"
#include "sensor/response/table_range.h"
#include "spectral/library.h"
#include "validation/goniometer/goniometer.h"

namespace abbe::cli {
namespace {

GoniometerSettings settings_of(const LabOptions& options) {
  Diagnostics diagnostics;
  const auto light = load_illuminant(options.illuminant, {}, diagnostics);
  if (light) check_light_range(*light, observer_channels(options.observer), {}, diagnostics);
  NamedCurve illuminant = accepted(light, diagnostics);
  return {options.at_nm,    options.angles_deg, options.inside, std::move(illuminant.curve),
          options.observer, options.samples};
}

// First warning of `warning_of` for a material at one of the wavelengths [nm]; empty without a warning.
std::optional<std::string> first_warning(const Material& material, const std::vector<double>& nm,
                                         std::optional<std::string> (*warning_of)(const Material&, double)) {
  for (const double at : nm)
    if (auto warning = warning_of(material, at)) return warning;
  return std::nullopt;
}

// Rejects requested wavelengths at which the formulas of a transparent material do not hold. Warns if that
// concerns the colours only, and of extrapolated data in both cases.
void check_material(const Material& material, const std::vector<double>& at_nm) {
  if (const auto fault = first_warning(material, at_nm, transparency_fault))
    throw Error(ErrorCode::scene, "", *fault);
  const std::vector<double> visible = visible_wavelengths();
  const auto warn_of_colors = [&](const std::string& warning) {
    print_message(fmt::format("warning: {}; colours are integrated from {:g} to {:g} nm", warning,
                              visible.front(), visible.back()));
  };
  if (const auto fault = first_warning(material, visible, transparency_fault)) warn_of_colors(*fault);
  const auto at_requested = first_warning(material, at_nm, extrapolated_index_warning);
  const auto at_visible = first_warning(material, visible, extrapolated_index_warning);
  if (at_visible) warn_of_colors(*at_visible);
  if (at_requested && at_requested != at_visible) warn(at_requested);
}

Json figures(const std::vector<Estimate>& estimates, double Estimate::*figure) {
  Json list = Json::array();
  for (const Estimate& e : estimates) list.push_back(e.*figure);
  return list;
}

// Rows of the answer, one per angle of incidence.
Json rows_of(const GoniometerReport& report) {
  Json rows = Json::array();
  for (const GoniometerAngle& at : report.angles)
    rows.push_back({{"angle_deg", at.angle_deg},
                    {"R", figures(at.reflected, &Estimate::mean)},
                    {"R_error", figures(at.reflected, &Estimate::standard_error)},
                    {"T", figures(at.transmitted, &Estimate::mean)},
                    {"T_error", figures(at.transmitted, &Estimate::standard_error)},
                    {"reflected_XYZ", at.reflected_color.xyz},
                    {"reflected_Y_error", at.reflected_color.Y_error},
                    {"reflected_Lab", at.reflected_color.lab},
                    {"transmitted_XYZ", at.transmitted_color.xyz},
                    {"transmitted_Y_error", at.transmitted_color.Y_error},
                    {"transmitted_Lab", at.transmitted_color.lab},
                    {"sampling_p", at.sampling_p},
                    {"spread", at.non_delta_probability}});
  return rows;
}

Json answer_of(const std::string& name, const LabOptions& options, const GoniometerReport& report) {
  return {{"name", name},
          {"wavelength_nm", options.at_nm},
          {"side", options.inside ? "inside" : "outside"},
          {"illuminant", options.illuminant},
          {"single_directions", report.lobes.delta},
          {"spread_directions", report.lobes.spread},
          {"dispersive", report.dispersive},
          {"reciprocity_error_max", report.reciprocity.largest},
          {"reciprocity_error_mean", report.reciprocity.mean},
          {"energy_max", report.max_albedo},
          {"angles", rows_of(report)}};
}

std::string cells(const std::vector<Estimate>& estimates) {
  std::string all;
  for (const Estimate& e : estimates) all += fmt::format("{:>10.6f}", e.mean);
  return all;
}

std::string cells(const std::array<double, 3>& color) {
  return fmt::format("{:>7.2f}{:>7.2f}{:>7.2f}", color[0], color[1], color[2]);
}

void print_table(const Json& answer, const LabOptions& options, const GoniometerReport& report) {
  Json head = answer;
  head.erase("angles");
  head.erase("wavelength_nm");
  print(head, false);
  const auto columns = [&](const char* quantity) {
    std::string all;
    for (const double nm : options.at_nm) all += fmt::format("{:>10}", fmt::format("{}({:g})", quantity, nm));
    return all;
  };
  fmt::print("\n{:>7}{}{}      X      Y      Z     L*     a*     b*   sampling p\n", "angle", columns("R"),
             columns("T"));
  for (const GoniometerAngle& at : report.angles)
    fmt::print("{:>7g}{}{}{}{}   {}\n", at.angle_deg, cells(at.reflected), cells(at.transmitted),
               cells(at.reflected_color.xyz), cells(at.reflected_color.lab),
               report.lobes.spread ? fmt::format("{:.3f}", at.sampling_p) : "-");
}

}  // namespace

void lab(const LabOptions& options) {
  for (const std::filesystem::path& output : {options.plot, options.map})
    if (!output.empty()) require_writable(output);
  Diagnostics diagnostics;
  Inputs inputs(options.max_memory_bytes);
  const Material material = accepted(load_material(options.material, diagnostics, &inputs), diagnostics);
  check_material(material, options.at_nm);
  for (std::filesystem::path& file : files_among({options.illuminant})) inputs.add_file(std::move(file));
  require_distinct(std::array{options.plot, options.map}, inputs.files());
  if (!options.plot.empty()) require_extension(options.plot, {".svg"});
  const GoniometerSettings settings = settings_of(options);
  const GoniometerReport report = measure(material, settings);
  const Json answer = answer_of(material.name, options, report);
  if (!options.plot.empty())
    write_atomically(options.plot, lobe_plot(material, settings, report, material.name));
  if (!options.map.empty()) write_picture(options.map, lobe_map(material, settings));
  if (options.json)
    print(answer, true);
  else
    print_table(answer, options, report);
}

}  // namespace abbe::cli
