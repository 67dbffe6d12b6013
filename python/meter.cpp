#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "film/measure_meter.h"
#include "film/rendered_film.h"
#include "film/shortcomings.h"
#include "python/arguments.h"
#include "python/arrays.h"
#include "python/errors.h"
#include "python/job.h"
#include "python/json.h"
#include "python/lock.h"
#include "python/numbers.h"
#include "python/render.h"
#include "python/request.h"
#include "python/scene.h"
#include "python/text.h"
#include "validation/statistics/students_interval.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double error_of(const Film::Average& value) {
  return value.degrees_of_freedom > 0 ? value.standard_error : kUnknown;
}

py::dict figure(const Film::Average& value, const char* unit) {
  py::dict told;
  told["value"] = value.mean;
  told["unit"] = unit;
  told["standard_error"] = known(error_of(value));
  told["half_interval_95"] =
      known(half_interval(value.standard_error, value.degrees_of_freedom, kMeterLevel));
  return told;
}

// `f` of each element, as an array of that shape.
template <typename T, typename F>
py::array_t<double> array_of(const std::vector<T>& elements, const std::vector<py::ssize_t>& shape, F f) {
  py::array_t<double> array(shape);
  double* to = array.mutable_data();
  for (const T& element : elements) *to++ = f(element);
  return array;
}

py::dict cells_of(const MeterMeasurement& measured) {
  const auto& [columns, rows] = measured.meter.cells;
  const std::vector<py::ssize_t> shape{rows, columns};
  py::dict told;
  const auto tell = [&](const std::string& name, Film::Average LightReading::*which) {
    const auto& cells = measured.reading.cells;
    told[py::str(name)] = array_of(cells, shape, [&](const LightReading& c) { return (c.*which).mean; });
    told[py::str(name + "_standard_error")] =
        array_of(cells, shape, [&](const LightReading& c) { return error_of(c.*which); });
  };
  tell("radiant", &LightReading::radiant);
  tell("luminous", &LightReading::luminous);
  tell("photons", &LightReading::photons);
  return told;
}

py::dict spectrum_of(const MeterMeasurement& measured) {
  const SpectralBins& bins = *measured.meter.spectrum;
  std::vector<double> centers_nm;
  for (int bin = 0; bin < bins.count; ++bin) centers_nm.push_back(bins.center_nm(bin));
  const std::vector<py::ssize_t> shape{bins.count};
  const auto& values = measured.reading.spectrum;
  py::dict told;
  told["wavelength_nm"] = array_of(centers_nm, shape, [](double nm) { return nm; });
  told["per_nm"] = array_of(values, shape, [](const Film::Average& value) { return value.mean; });
  told["standard_error"] = array_of(values, shape, error_of);
  return told;
}

py::dict told_of(const MeterMeasurement& measured) {
  const MeterUnits& units = units_of(measured.meter.quantity);
  const LightReading& whole = measured.reading.whole;
  py::dict told;
  told["name"] = measured.meter.name;
  told["measures"] = kMeterQuantityNames.at(static_cast<std::size_t>(measured.meter.quantity));
  told["radiant"] = figure(whole.radiant, units.radiant);
  told["luminous"] = figure(whole.luminous, units.luminous);
  told["photons"] = figure(whole.photons, units.photons);
  if (!measured.reading.cells.empty()) told["cells"] = cells_of(measured);
  if (measured.meter.spectrum) told["spectrum"] = spectrum_of(measured);
  told["integrator"] = integrator_name(measured.integrator);
  told["seed"] = measured.seed;
  told["samples"] = measured.stats.samples_per_pixel;
  told["half_noise_samples"] = py::none();
  if (measured.stats.error.few_samples) told["half_noise_samples"] = *measured.stats.error.few_samples;
  told["hidden_noise"] = py::none();
  if (measured.stats.error.hidden_noise > 0) told["hidden_noise"] = measured.stats.error.hidden_noise;
  return told;
}

// What the call says otherwise than the scene, which its loader checks.
std::vector<Override> settings_of(const Request& request, const py::object& integrator) {
  std::vector<Override> settings;
  if (request.spp) settings.push_back({"/render/samples", fmt::format("{}", *request.spp), "spp"});
  if (request.seed) settings.push_back({"/render/seed", fmt::format("{}", *request.seed), "seed"});
  if (!integrator.is_none()) {
    const char* const pointer = "/render/integrator";
    settings.push_back({pointer, to_text(to_json(integrator, pointer)), "integrator"});
  }
  return settings;
}

std::vector<std::string> names_of(const py::object& only) {
  if (only.is_none()) return {};
  if (py::isinstance<py::str>(only)) return {encoded(only)};
  auto names = argument<std::vector<std::string>>(only, "only", "the name of a meter or a list of them");
  if (names.empty())
    throw Error(ErrorCode::usage, "only", "names no meter (got [], allowed one or more, or None for all)");
  return names;
}

SceneSource source_of_meters(const py::object& scene) {
  if (py::isinstance<SceneHandle>(scene)) return scene.cast<const SceneHandle&>().source();
  return source_of(scene, py::none(), {});
}

MeteredScene read_meters(const SceneSource& source, Inputs& inputs) {
  Diagnostics diagnostics;
  return accepted(source.text
                      ? load_meters(source.text, source.folder, source.overrides, diagnostics, &inputs)
                      : load_meters(source.name, source.overrides, diagnostics, &inputs),
                  diagnostics);
}

// Without Python's lock. What the scene holds besides its films is counted once, and so are its warnings
// told.
std::vector<MeterMeasurement> measure(const SceneSource& source, const std::vector<std::string>& names,
                                      const RenderOptions& how, const py::object& progress) {
  Inputs inputs;
  const MeteredScene metered = read_meters(source, inputs);
  const auto render = [&](const abbe::Scene& seen, const RenderOptions& asked) {
    return render_listening(seen, asked, progress);
  };
  const MeterCaller caller{render, [](const std::string& text) { warn(text); }, "error"};
  std::vector<MeterMeasurement> all;
  for (const Meter* one : chosen_meters(metered, names, "only")) {
    Diagnostics diagnostics;
    std::optional<abbe::Scene> scene = scene_of(metered, *one, diagnostics, all.empty() ? &inputs : nullptr);
    if (all.empty() || !scene) scene = accepted(std::move(scene), diagnostics);
    if (all.empty())
      for (const auto& hidden : {hidden_sheet(*scene), hidden_lamp(*scene)})
        if (hidden) warn(*hidden);
    all.push_back(measure_meter(*std::move(scene), *one, how, caller, inputs));
  }
  return all;
}

py::dict meter(const py::object& scene, const py::object& only, const Request& request,
               const py::object& integrator, const py::object& progress) {
  require_valid(request);
  SceneSource source = source_of_meters(scene);
  for (Override& setting : settings_of(request, integrator)) source.overrides.push_back(std::move(setting));
  const std::vector<std::string> names = names_of(only);
  std::vector<MeterMeasurement> all;
  {
    const Released released;
    all = measure(source, names, how_to_stop(request), progress);
  }
  py::dict told;
  for (const MeterMeasurement& measured : all) told[py::str(measured.meter.name)] = told_of(measured);
  return told;
}

}  // namespace

void add_meter(py::module_& module) {
  module.def(
      "meter",
      [](const py::object& scene, const py::object& only, std::optional<Whole<std::int64_t>> spp,
         std::optional<Whole<std::int64_t>> seed, Whole<std::int64_t> threads, std::optional<Real> error,
         std::optional<Real> time, const py::object& integrator, const py::object& progress) {
        return meter(scene, only, {spp, seed, threads, error, time}, integrator, progress);
      },
      py::arg("scene"), py::kw_only(), py::arg("only") = py::none(), py::arg("spp") = py::none(),
      py::arg("seed") = py::none(), py::arg("threads") = 0, py::arg("error") = py::none(),
      py::arg("time") = py::none(), py::arg("integrator") = py::none(), py::arg("progress") = py::none(),
      "Reads the meters of a scene, a path, a dict or a Scene, of the numbers that `abbe meter` gives; a "
      "path or "
      "dict needs no camera.\n\n"
      "Returns a dict of dicts by the meters' names, in the scene's order, with the keys of `abbe meter "
      "--json` but `wall_s`, and `columns` and `rows` of cells: "
      "`radiant`, `luminous` and `photons` have `value`, `unit`, `standard_error` and `half_interval_95`, "
      "half the "
      "width of Student's interval of 95 %, None where nothing is known; `cells` are arrays of rows and "
      "columns "
      "of a meter that has some, `spectrum` arrays over `wavelength_nm`, nan where an error is not known. "
      "`only` "
      "names a meter, or several. `spp`, `seed` and `integrator` replace what the scene says; `threads`, "
      "`time` "
      "and `progress` are those of `render`, for each meter, and `error` ends at the largest relative "
      "standard "
      "error of its three figures. Raises UsageError for a name that no meter has and for a list of none, "
      "SceneError for a scene "
      "without meters.");
}

}  // namespace abbe::python
