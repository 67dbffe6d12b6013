#include "cli/meter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/interrupt.h"
#include "cli/output_files.h"
#include "cli/progress.h"
#include "film/meter_reading.h"
#include "film/rendered_film.h"
#include "film/shortcomings.h"
#include "io/atomic_file.h"
#include "io/extension.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/collect.h"
#include "transport/render/threads.h"
#include "validation/statistics/students_interval.h"

namespace abbe::cli {
namespace {

constexpr double kLevel = 0.95;

/// The units of a quantity.
struct Units {
  const char* radiant;
  const char* luminous;
  const char* photons;
};
constexpr std::array<Units, 4> kUnits{{{"W/m2", "lx", "photons/(s m2)"},
                                       {"W", "lm", "photons/s"},
                                       {"W/(m2 sr)", "cd/m2", "photons/(s m2 sr)"},
                                       {"W/sr", "cd", "photons/(s sr)"}}};

const Units& units_of(const Meter& meter) {
  return kUnits.at(static_cast<std::size_t>(meter.quantity));
}

/// One meter and what it read.
struct Measured {
  const Meter& meter;
  Integrator integrator;
  MeterReading reading;
  RenderStats stats;
};

std::vector<const Meter*> chosen(const MeteredScene& scene, const std::vector<std::string>& names) {
  std::vector<const Meter*> meters;
  std::vector<std::string_view> known;
  for (const Meter& meter : scene.meters) {
    known.push_back(meter.name);
    if (names.empty() || std::find(names.begin(), names.end(), meter.name) != names.end())
      meters.push_back(&meter);
  }
  for (const std::string& name : names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ErrorCode::usage, "--only",
                  fmt::format("no such meter (got \"{}\", allowed {})", name, fmt::join(known, ", ")));
  return meters;
}

void warn(const Meter& meter, const std::string& sentence) {
  say(fmt::format("warning: meter {}: {}", meter.name, sentence));
}

void check_reach(const Scene& scene, const Meter& meter, bool strict) {
  for (const auto& lost : {lost_light(scene), dark_camera(scene)}) {
    if (!lost) continue;
    if (strict) throw Error(ErrorCode::scene, meter.name, *lost);
    warn(meter, *lost);
  }
}

abbe::RenderOptions how_to_render(const MeterOptions& options, const InterruptWatch& watch,
                                  ProgressDisplay& display) {
  abbe::RenderOptions how;
  how.threads = options.threads;
  how.time_limit_s = options.time_limit_s;
  how.target_error = options.target_error;
  how.target_figure = &RelativeError::frame_mean;
  how.stop = &watch.stop();
  if (!options.quiet) how.progress = [&display](const Progress& progress) { display(progress); };
  return how;
}

// What each meter's scene holds besides its film is counted once, for the first of them.
Measured measure(const MeteredScene& metered, const Meter& meter, const MeterOptions& options,
                 const InterruptWatch& watch, Inputs& inputs, bool first) {
  Diagnostics diagnostics(options.strict ? Strictness::strict : Strictness::lenient);
  Scene scene = accepted(scene_of(metered, meter, diagnostics, first ? &inputs : nullptr), diagnostics);
  set_sampling(options, scene.render);
  const bool chooses = scene.render.integrator == Integrator::automatic;
  scene.render.integrator = choose_integrator(scene, thread_count(options.threads)).integrator;
  check_reach(scene, meter, options.strict && !chooses);
  ProgressDisplay display;
  const abbe::RenderOptions how = how_to_render(options, watch, display);
  inputs.take_memory("the film", film_bytes(scene, how));
  inputs.take_memory("the paths from lights of a sample", bytes_of_light_paths(scene));
  const RenderResult result = abbe::render(scene, how);
  inputs.give_back_memory(film_bytes(scene, how) + bytes_of_light_paths(scene));
  display.finish();
  for (const std::string& loss : left_out(scene, result.stats)) warn(meter, loss);
  return {meter, scene.render.integrator, read_meter(meter, result.film, scene.exposure_s), result.stats};
}

// Null where nothing is known.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json();
}

double half_interval(const Film::Average& value) {
  return abbe::half_interval(value.standard_error, value.degrees_of_freedom, kLevel);
}

Json json_of(const Film::Average& value, const char* unit) {
  const bool known = value.degrees_of_freedom > 0;
  return {{"value", value.mean},
          {"unit", unit},
          {"standard_error", known ? Json(value.standard_error) : Json()},
          {"half_interval_95", number(half_interval(value))}};
}

Json cells_json(const Measured& measured) {
  const auto list = [&](Film::Average LightReading::*which) {
    Json values = Json::array();
    for (const LightReading& cell : measured.reading.cells) values.push_back((cell.*which).mean);
    return values;
  };
  return {{"columns", measured.meter.cells[0]},
          {"rows", measured.meter.cells[1]},
          {"radiant", list(&LightReading::radiant)},
          {"luminous", list(&LightReading::luminous)},
          {"photons", list(&LightReading::photons)}};
}

Json spectrum_json(const Measured& measured) {
  Json told{{"wavelength_nm", Json::array()}, {"per_nm", Json::array()}, {"standard_error", Json::array()}};
  for (int bin = 0; bin < measured.meter.spectrum->count; ++bin) {
    const Film::Average& value = measured.reading.spectrum[static_cast<std::size_t>(bin)];
    told["wavelength_nm"].push_back(measured.meter.spectrum->center_nm(bin));
    told["per_nm"].push_back(value.mean);
    told["standard_error"].push_back(value.degrees_of_freedom > 0 ? Json(value.standard_error) : Json());
  }
  return told;
}

Json json_of(const Measured& measured) {
  const Units& units = units_of(measured.meter);
  const LightReading& whole = measured.reading.whole;
  Json told{{"name", measured.meter.name},
            {"measures", kMeterQuantityNames.at(static_cast<std::size_t>(measured.meter.quantity))},
            {"radiant", json_of(whole.radiant, units.radiant)},
            {"luminous", json_of(whole.luminous, units.luminous)},
            {"photons", json_of(whole.photons, units.photons)}};
  if (!measured.reading.cells.empty()) told["cells"] = cells_json(measured);
  if (measured.meter.spectrum) told["spectrum"] = spectrum_json(measured);
  told["integrator"] = integrator_name(measured.integrator);
  told["samples"] = measured.stats.samples_per_pixel;
  told["wall_s"] = measured.stats.wall_s;
  return told;
}

std::string in_words(const Film::Average& value, const char* unit) {
  const double half = half_interval(value);
  const std::string interval = std::isfinite(half) ? fmt::format(" +- {:.2g}", half) : "";
  return fmt::format("{:.6g}{} {}", value.mean, interval, unit);
}

void print_text(const Measured& measured) {
  const Units& units = units_of(measured.meter);
  const LightReading& whole = measured.reading.whole;
  fmt::print("{}  {}  {}  {}  {}\n", measured.meter.name,
             kMeterQuantityNames.at(static_cast<std::size_t>(measured.meter.quantity)),
             in_words(whole.radiant, units.radiant), in_words(whole.luminous, units.luminous),
             in_words(whole.photons, units.photons));
  const std::vector<LightReading>& cells = measured.reading.cells;
  if (cells.empty()) return;
  const auto [least, greatest] =
      std::minmax_element(cells.begin(), cells.end(),
                          [](const auto& a, const auto& b) { return a.luminous.mean < b.luminous.mean; });
  fmt::print("  {} x {} cells from {:.6g} to {:.6g} {}, the least {:.3g} of the mean\n",
             measured.meter.cells[0], measured.meter.cells[1], least->luminous.mean, greatest->luminous.mean,
             units.luminous, least->luminous.mean / whole.luminous.mean);
}

std::string spectra_table(const std::vector<Measured>& all) {
  std::string text = "meter,from_nm,to_nm,per_nm,standard_error,unit\n";
  for (const Measured& measured : all) {
    for (std::size_t i = 0; i < measured.reading.spectrum.size(); ++i) {
      const SpectralBins& bins = *measured.meter.spectrum;
      const double from = bins.from_nm + static_cast<double>(i) * bins.step_nm;
      const Film::Average& value = measured.reading.spectrum[i];
      text +=
          fmt::format("{},{},{},{},{},{} per nm\n", csv_cell(measured.meter.name), from, from + bins.step_nm,
                      value.mean, value.standard_error, units_of(measured.meter).radiant);
    }
  }
  return text;
}

void check_spectra(const MeterOptions& options, const std::vector<const Meter*>& meters) {
  if (options.spectra.empty()) return;
  require_extension(options.spectra, {".csv"});
  if (std::none_of(meters.begin(), meters.end(), [](const Meter* m) { return m->spectrum.has_value(); }))
    throw Error(ErrorCode::usage, "--spectra", "none of these meters has a spectrum");
}

}  // namespace

int meter(const MeterOptions& options) {
  Inputs inputs(options.max_memory_bytes);
  Diagnostics diagnostics(options.strict ? Strictness::strict : Strictness::lenient);
  const MeteredScene scene =
      accepted(load_meters(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
  const std::vector<const Meter*> meters = chosen(scene, options.meters);
  check_spectra(options, meters);
  require_distinct(std::array{options.spectra}, inputs.files());
  const InterruptWatch watch;
  std::vector<Measured> all;
  for (const Meter* one : meters) {
    if (watch.stop()) break;
    all.push_back(measure(scene, *one, options, watch, inputs, all.empty()));
    if (!options.json) print_text(all.back());
  }
  if (options.json) {
    Json told = Json::array();
    for (const Measured& measured : all) told.push_back(json_of(measured));
    print({{"meters", told}}, true);
  }
  if (!options.spectra.empty()) write_atomically(options.spectra, spectra_table(all));
  if (watch.stop()) return kSignalExit + watch.signal();
  const auto dropped = [](const Measured& measured) { return measured.stats.nonfinite_samples > 0; };
  return options.strict && std::any_of(all.begin(), all.end(), dropped)
             ? static_cast<int>(ErrorCode::internal)
             : 0;
}

}  // namespace abbe::cli
