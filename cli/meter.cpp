#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "cli/answer.h"
#include "cli/command_options.h"
#include "cli/output_files.h"
#include "cli/progress.h"
#include "io/atomic_file.h"
#include "io/text.h"
#include "results/measure_meter.h"
#include "results/rendered_film.h"
#include "results/scene_warnings.h"
#include "validation/statistics.h"

namespace abbe::cli {
namespace {

struct MeterOptions : SamplingOptions {
  std::filesystem::path scene;
  std::vector<std::string> meters;
  std::filesystem::path spectra;
  bool json = false;
};

abbe::RenderOptions render_options_of(const MeterOptions& options, const InterruptWatch& watch,
                                      ProgressDisplay& display) {
  abbe::RenderOptions render_options = options.render;
  render_options.stop = &watch.stop();
  if (!options.quiet) render_options.progress = [&display](const Progress& progress) { display(progress); };
  return render_options;
}

// Renders the scene of one meter with progress on stderr, and reads the meter.
MeterMeasurement measure(Scene scene, const Meter& meter, const MeterOptions& options,
                         const InterruptWatch& watch, Inputs& inputs) {
  set_sampling(options, scene.render);
  ProgressDisplay display;
  if (!options.quiet) display.prepare();
  const auto render_and_finish = [&display](const Scene& metered_scene,
                                            const abbe::RenderOptions& render_options) {
    RenderResult result = abbe::render(metered_scene, render_options);
    display.finish();
    return result;
  };
  const auto clear_and_warn = [&display](const std::string& sentence) {
    display.clear();
    warn(sentence);
  };
  return measure_meter(std::move(scene), meter, render_options_of(options, watch, display),
                       {render_and_finish, clear_and_warn, "--error", options.strict}, inputs);
}

// Half width of Student's interval; not finite without degrees of freedom, which JSON writes as null.
double half_interval_95(const Film::Average& value) {
  return abbe::half_interval(value.standard_error, value.degrees_of_freedom, kMeterConfidence);
}

Json error_of(const Film::Average& value) {
  return value.degrees_of_freedom > 0 ? Json(value.standard_error) : Json();
}

Json json_of(const Film::Average& value, const char* unit) {
  return {{"value", value.mean},
          {"unit", unit},
          {"standard_error", error_of(value)},
          {"half_interval_95", half_interval_95(value)}};
}

Json cells_json(const MeterMeasurement& measured) {
  Json answer{{"columns", measured.meter.cells[0]}, {"rows", measured.meter.cells[1]}};
  const auto list = [&](const std::string& name, Film::Average LightReading::*quantity) {
    for (const LightReading& cell : measured.reading.cells) {
      answer[name].push_back((cell.*quantity).mean);
      answer[name + "_standard_error"].push_back(error_of(cell.*quantity));
    }
  };
  list("radiant", &LightReading::radiant);
  list("luminous", &LightReading::luminous);
  list("photons", &LightReading::photons);
  return answer;
}

Json spectrum_json(const MeterMeasurement& measured) {
  Json answer{{"wavelength_nm", Json::array()}, {"per_nm", Json::array()}, {"standard_error", Json::array()}};
  for (int bin = 0; bin < measured.meter.spectrum->count; ++bin) {
    const Film::Average& value = measured.reading.spectrum[static_cast<std::size_t>(bin)];
    answer["wavelength_nm"].push_back(measured.meter.spectrum->center_nm(bin));
    answer["per_nm"].push_back(value.mean);
    answer["standard_error"].push_back(error_of(value));
  }
  return answer;
}

Json json_of(const MeterMeasurement& measured) {
  const MeterUnits& units = units_of(measured.meter.quantity);
  const LightReading& whole = measured.reading.whole;
  Json answer{{"name", measured.meter.name},
              {"measures", kMeterQuantityNames.at(static_cast<std::size_t>(measured.meter.quantity))},
              {"radiant", json_of(whole.radiant, units.radiant)},
              {"luminous", json_of(whole.luminous, units.luminous)},
              {"photons", json_of(whole.photons, units.photons)}};
  if (!measured.reading.cells.empty()) answer["cells"] = cells_json(measured);
  if (measured.meter.spectrum) answer["spectrum"] = spectrum_json(measured);
  answer["integrator"] = integrator_name(measured.integrator);
  answer["seed"] = measured.seed;
  answer["samples"] = measured.stats.samples_per_pixel;
  const RelativeError& error = measured.stats.error;
  answer["half_noise_samples"] = or_null(error.few_samples);
  answer["hidden_noise"] = error.hidden_noise > 0 ? Json(error.hidden_noise) : Json();
  if (measured.stats.interrupted) answer["interrupted"] = true;
  answer["wall_s"] = measured.stats.wall_s;
  return answer;
}

std::string value_text(const Film::Average& value, const char* unit) {
  const double half = half_interval_95(value);
  const std::string interval = std::isfinite(half) ? fmt::format(" +- {:.2g}", half) : "";
  return fmt::format("{:.6g}{} {}", value.mean, interval, unit);
}

void print_text(const MeterMeasurement& measured) {
  const MeterUnits& units = units_of(measured.meter.quantity);
  const LightReading& whole = measured.reading.whole;
  fmt::print("{}  {}  {}  {}  {}\n", measured.meter.name,
             kMeterQuantityNames.at(static_cast<std::size_t>(measured.meter.quantity)),
             value_text(whole.radiant, units.radiant), value_text(whole.luminous, units.luminous),
             value_text(whole.photons, units.photons));
  const std::vector<LightReading>& cells = measured.reading.cells;
  if (cells.empty()) return;
  std::vector<double> cell_values;
  for (const LightReading& cell : cells) cell_values.push_back(cell.luminous.mean);
  const auto [min_value, max_value] = std::ranges::minmax_element(cell_values);
  const double sum = std::accumulate(cell_values.begin(), cell_values.end(), 0.0);
  fmt::print("  {} x {} cells from {:.6g} to {:.6g} {}{}\n", measured.meter.cells[0], measured.meter.cells[1],
             *min_value, *max_value, units.luminous,
             sum > 0 ? fmt::format(", minimum / mean {:.3g}",
                                   *min_value * static_cast<double>(cell_values.size()) / sum)
                     : "");
}

std::string spectra_table(const std::vector<MeterMeasurement>& all) {
  std::string text = "meter,from_nm,to_nm,per_nm,standard_error,unit\n";
  for (const MeterMeasurement& measured : all) {
    for (std::size_t i = 0; i < measured.reading.spectrum.size(); ++i) {
      const SpectralBins& bins = *measured.meter.spectrum;
      const double from = bins.from_nm + static_cast<double>(i) * bins.step_nm;
      const Film::Average& value = measured.reading.spectrum[i];
      const bool known = value.degrees_of_freedom > 0;
      text += fmt::format(
          "{},{},{},{},{},{} per nm\n", csv_cell(measured.meter.name), from, from + bins.step_nm, value.mean,
          known ? fmt::format("{}", value.standard_error) : "", units_of(measured.meter.quantity).radiant);
    }
  }
  return text;
}

void check_spectra(const MeterOptions& options, const std::vector<const Meter*>& meters) {
  if (options.spectra.empty()) return;
  require_extension(options.spectra, {".csv"});
  if (std::ranges::none_of(meters, [](const Meter* m) { return m->spectrum.has_value(); }))
    throw Error(ErrorCode::usage, "--spectra", "none of these meters has a spectrum");
  require_writable(options.spectra);
}

// Reads the meters one after the other. The memory, the files and the warnings of their scene are counted and
// reported once.
std::vector<MeterMeasurement> measure_all(const MeteredScene& metered,
                                          const std::vector<const Meter*>& meters,
                                          const MeterOptions& options, const InterruptWatch& watch,
                                          Inputs& inputs) {
  std::vector<MeterMeasurement> all;
  for (const Meter* meter : meters) {
    if (watch.stop()) break;
    Diagnostics diagnostics(options.strict ? Strictness::strict : Strictness::lenient);
    std::optional<Scene> scene = scene_of(metered, *meter, diagnostics, all.empty() ? &inputs : nullptr);
    if (all.empty() || !scene) scene = accepted(std::move(scene), diagnostics);
    if (all.empty()) {
      require_distinct(std::array{options.spectra}, inputs.files());
      warn(coincidence_warning(*scene), options.strict);
    }
    all.push_back(measure(*std::move(scene), *meter, options, watch, inputs));
    if (!options.json) print_text(all.back());
  }
  return all;
}

int meter(const MeterOptions& options) {
  Inputs inputs(options.max_memory_bytes);
  Diagnostics diagnostics(options.strict ? Strictness::strict : Strictness::lenient);
  const MeteredScene scene =
      accepted(load_meters(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
  const std::vector<const Meter*> meters = chosen_meters(scene, options.meters, "--only");
  check_spectra(options, meters);
  const InterruptWatch watch;
  const std::vector<MeterMeasurement> all = measure_all(scene, meters, options, watch, inputs);
  if (watch.stop())
    print_message(fmt::format("interrupted: {} of {} meters were read", all.size(), meters.size()));
  if (options.json) {
    Json answer = Json::array();
    for (const MeterMeasurement& measured : all) answer.push_back(json_of(measured));
    print({{"meters", answer}}, true);
  }
  const auto has_spectrum = [](const MeterMeasurement& measured) {
    return !measured.reading.spectrum.empty();
  };
  if (!options.spectra.empty() && std::ranges::any_of(all, has_spectrum))
    write_atomically(options.spectra, spectra_table(all));
  if (watch.stop()) return kSignalExit + watch.signal();
  const auto has_dropped_samples = [](const MeterMeasurement& measured) {
    return measured.stats.nonfinite_samples > 0;
  };
  return options.strict && std::ranges::any_of(all, has_dropped_samples)
             ? static_cast<int>(ErrorCode::internal)
             : 0;
}

}  // namespace

void add_meter(CLI::App& app, Command& command) {
  const Subcommand<MeterOptions> sub(app, "meter", "Measure light with the meters of a scene", command,
                                     meter);
  CLI::App& options = *sub.app;
  add_scene(options, sub->scene);
  add_value(options, "--only", sub->meters, "Name of a meter to read; may be repeated (default: all)", "NAME")
      ->allow_extra_args(false);
  add_value(options, "--spectra", sub->spectra,
            "Table to write with the spectra of those meters that record one", "FILE.csv");
  add_samples(options, *sub.options,
              "Samples per sub-area of a meter, which has at least 1024 of them (default: the scene's)",
              "the largest relative standard error of a meter's radiant, luminous and photon values",
              " for each meter");
  add_integrator(options, *sub.options);
  add_overrides(options, sub.options);
  add_max_memory(options, sub.options);
  options.add_flag("--strict", sub->strict,
                   "Reject a scene with a warning that means a wrong reading (exit code 3); exit with 70 if "
                   "any sample was discarded");
  options.add_flag("--quiet", sub->quiet, "Print warnings and errors only, no progress and no notes");
  add_json(options, sub->json);
}

}  // namespace abbe::cli
