#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "python/arguments.h"
#include "python/errors.h"
#include "python/gil.h"
#include "python/job.h"
#include "python/json.h"
#include "python/module.h"
#include "python/numbers.h"
#include "python/scene.h"
#include "results/measure_meter.h"
#include "results/rendered_film.h"
#include "results/scene_warnings.h"
#include "validation/statistics.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

double error_of(const Film::Average& value) {
  return value.degrees_of_freedom > 0 ? value.standard_error : kUnknown;
}

py::dict figure(const Film::Average& value, const char* unit) {
  py::dict result;
  result["value"] = value.mean;
  result["unit"] = unit;
  result["standard_error"] = finite_or_none(error_of(value));
  result["half_interval_95"] =
      finite_or_none(half_interval(value.standard_error, value.degrees_of_freedom, kMeterConfidence));
  return result;
}

// Array of that shape with `f` of each element.
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
  py::dict result;
  const auto add_values = [&](const std::string& name, Film::Average LightReading::*which) {
    const auto& cells = measured.reading.cells;
    result[py::str(name)] = array_of(cells, shape, [&](const LightReading& c) { return (c.*which).mean; });
    result[py::str(name + "_standard_error")] =
        array_of(cells, shape, [&](const LightReading& c) { return error_of(c.*which); });
  };
  add_values("radiant", &LightReading::radiant);
  add_values("luminous", &LightReading::luminous);
  add_values("photons", &LightReading::photons);
  return result;
}

py::dict spectrum_of(const MeterMeasurement& measured) {
  const SpectralBins& bins = *measured.meter.spectrum;
  std::vector<double> centers_nm;
  for (int bin = 0; bin < bins.count; ++bin) centers_nm.push_back(bins.center_nm(bin));
  const std::vector<py::ssize_t> shape{bins.count};
  const auto& values = measured.reading.spectrum;
  py::dict result;
  result["wavelength_nm"] = array_of(centers_nm, shape, [](double nm) { return nm; });
  result["per_nm"] = array_of(values, shape, [](const Film::Average& value) { return value.mean; });
  result["standard_error"] = array_of(values, shape, error_of);
  return result;
}

py::dict dict_of(const MeterMeasurement& measured) {
  const MeterUnits& units = units_of(measured.meter.quantity);
  const LightReading& whole = measured.reading.whole;
  py::dict result;
  result["name"] = measured.meter.name;
  result["measures"] = kMeterQuantityNames.at(static_cast<std::size_t>(measured.meter.quantity));
  result["radiant"] = figure(whole.radiant, units.radiant);
  result["luminous"] = figure(whole.luminous, units.luminous);
  result["photons"] = figure(whole.photons, units.photons);
  if (!measured.reading.cells.empty()) result["cells"] = cells_of(measured);
  if (measured.meter.spectrum) result["spectrum"] = spectrum_of(measured);
  result["integrator"] = integrator_name(measured.integrator);
  result["seed"] = measured.seed;
  result["samples"] = measured.stats.samples_per_pixel;
  const RelativeError& error = measured.stats.error;
  result["half_noise_samples"] = error.few_samples;
  result["hidden_noise"] = value_if(error.hidden_noise > 0, error.hidden_noise);
  return result;
}

// Settings of the call that replace those of the scene; its loader checks them.
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
  if (names.empty()) refuse_argument("only", "names no meter (got [], allowed one or more, or None for all)");
  return names;
}

MeteredScene read_meters(const SceneSource& source, Inputs& inputs) {
  Diagnostics diagnostics;
  return accepted(source.text
                      ? load_meters(source.text, source.folder, source.overrides, diagnostics, &inputs)
                      : load_meters(source.name, source.overrides, diagnostics, &inputs),
                  diagnostics);
}

// Measures the chosen meters. The memory of the scene counts once, and its warnings are issued once. Requires
// that the caller does not hold the GIL.
std::vector<MeterMeasurement> measure(const SceneSource& source, const std::vector<std::string>& names,
                                      const RenderOptions& how, const py::object& progress) {
  Inputs inputs;
  const MeteredScene metered = read_meters(source, inputs);
  const auto render = [&](const abbe::Scene& scene, const RenderOptions& options) {
    return render_listening(scene, options, progress);
  };
  const MeterCallbacks caller{render, [](const std::string& text) { warn(text); }, "error"};
  std::vector<MeterMeasurement> all;
  for (const Meter* one : chosen_meters(metered, names, "only")) {
    Diagnostics diagnostics;
    std::optional<abbe::Scene> scene = scene_of(metered, *one, diagnostics, all.empty() ? &inputs : nullptr);
    if (all.empty() || !scene) scene = accepted(std::move(scene), diagnostics);
    if (all.empty())
      if (const auto hidden = coincidence_warning(*scene)) warn(*hidden);
    all.push_back(measure_meter(*std::move(scene), *one, how, caller, inputs));
  }
  return all;
}

py::dict meter(const py::object& scene, const py::object& only, const Request& request,
               const py::object& integrator, const py::object& progress) {
  require_valid(request);
  SceneSource source = py::isinstance<SceneHandle>(scene) ? scene.cast<const SceneHandle&>().source()
                                                          : source_of(scene, py::none(), {});
  for (Override& setting : settings_of(request, integrator)) source.overrides.push_back(std::move(setting));
  const std::vector<std::string> names = names_of(only);
  std::vector<MeterMeasurement> all;
  {
    const GilReleased released;
    all = measure(source, names, render_limits(request), progress);
  }
  py::dict result;
  for (const MeterMeasurement& measured : all) result[py::str(measured.meter.name)] = dict_of(measured);
  return result;
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
      "Measures the meters of a scene, given as a path, a dict or a Scene, with the results of `abbe meter`. "
      "A path or dict needs no camera.\n\nReturns a dict of dicts by the meters' names, in the scene's "
      "order, with the keys of `abbe meter --json` except `wall_s` and the `columns` and `rows` of cells. "
      "`radiant`, `luminous` and `photons` have `value`, `unit`, `standard_error` and `half_interval_95`, "
      "half the width of Student's 95 % interval, or None if that is unknown. `cells` are arrays of rows and "
      "columns if the meter has cells. `spectrum` has arrays over `wavelength_nm`, with nan for unknown "
      "errors. `only` names a meter, or several. `spp`, `seed` and `integrator` replace those of the scene. "
      "`threads`, `time` and `progress` are those of `render`, for each meter. `error` ends a render at that "
      "largest relative standard error of the three figures. Raises UsageError for a name that no meter has "
      "and for an empty list, and SceneError for a scene without meters.");
}

}  // namespace abbe::python
