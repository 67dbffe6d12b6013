#include "transport/render/render.h"

#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "film/rendered_film.h"
#include "film/shortcomings.h"
#include "python/arguments.h"
#include "python/errors.h"
#include "python/film.h"
#include "python/job.h"
#include "python/lock.h"
#include "python/numbers.h"
#include "python/render.h"
#include "python/request.h"
#include "python/sample_range.h"
#include "python/scene.h"
#include "transport/render/collect.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

RenderOptions how_to_render(const Request& request, int stated) {
  RenderOptions how = how_to_stop(request);
  how.measure_error = false;
  if (!request.samples) return how;
  const auto [first, last] = *request.samples;
  require(first < last && last <= static_cast<std::uint64_t>(stated), "sample_range",
          fmt::format("({}, {})", first, last), "first < last, up to the samples of the whole render");
  how.samples = request.samples;
  return how;
}

// The scene with the settings asked for; a copy only where they are not its own.
std::optional<abbe::Scene> changed(const abbe::Scene& scene, const Request& request) {
  RenderSettings settings = scene.render;
  if (request.spp) settings.samples = static_cast<int>(*request.spp);
  if (request.seed) settings.seed = static_cast<std::uint64_t>(*request.seed);
  if (settings.samples == scene.render.samples && settings.seed == scene.render.seed) return std::nullopt;
  std::optional<abbe::Scene> copy = scene;
  copy->render = settings;
  return copy;
}

FilmHandle render_scene(SceneHandle& handle, const Request& request, const py::object& progress) {
  require_valid(request);
  const Released released;
  const abbe::Scene& own = handle.with_white(static_cast<int>(request.threads));
  const std::optional<abbe::Scene> copy = changed(own, request);
  const abbe::Scene& scene = copy ? *copy : own;
  RenderOptions how = how_to_render(request, scene.render.samples);
  how.guides = handle.guides();
  Inputs inputs = handle.inputs();
  inputs.take_memory("the film", film_bytes(scene, how));
  inputs.take_memory("the paths from lights of a sample", bytes_of_light_paths(scene));
  FilmIdentity identity = identity_of(scene, handle.name(), how);
  for (const auto& shortcoming :
       {unpolarised_measurement(scene), dark_camera(scene), hidden_sheet(scene), hidden_lamp(scene),
        lost_light(scene), rare_photons(how.guides.get()), unused_settings(scene)})
    if (shortcoming) warn(*shortcoming);
  RenderResult result = render_listening(scene, how, progress);
  if (how.target_error && !how.time_limit_s && !std::isfinite(result.stats.error.median))
    warn("a pilot found no light on the film: error had nothing to wait for");
  for (const std::string& loss : left_out(scene, result)) warn(loss);
  return FilmHandle(RenderPart{std::move(identity), std::move(result)});
}

}  // namespace

void add_render(py::module_& module) {
  py::class_<Progress> progress(module, "Progress", "How far a render has come.");
  forbid_bare_new(progress);
  progress
      .def_readonly("share", &Progress::share,
                    "The share of the work that is done, in [0, 1]; an estimate where time or error decides.")
      .def_readonly("samples", &Progress::samples, "How many samples of each pixel are finished.")
      .def_readonly("rate", &Progress::rate,
                    "How many samples of each pixel this run finishes in a second, without its planning; 0 "
                    "before its first.")
      .def_readonly("elapsed_s", &Progress::elapsed_s, "The time since the render began, in s.")
      .def_readonly("left_s", &Progress::left_s,
                    "An estimate of the time that is left, in s; NaN before there is one.")
      .def_property_readonly(
          "error", [](const Progress& p) { return p.error.median; },
          "The median relative error of the lit values so far; infinite while it is not known.")
      .def_readonly("error_samples", &Progress::error_samples,
                    "Of how many samples of each pixel `error` is.");
  module.def(
      "render",
      [](SceneHandle& scene, std::optional<Whole<std::int64_t>> spp, std::optional<Whole<std::int64_t>> seed,
         Whole<std::int64_t> threads, std::optional<Real> error, std::optional<Real> time,
         const py::object& progress, std::optional<SampleRange> samples) {
        return render_scene(scene, {spp, seed, threads, error, time, samples}, progress);
      },
      py::arg("scene"), py::kw_only(), py::arg("spp") = py::none(), py::arg("seed") = py::none(),
      py::arg("threads") = 0, py::arg("error") = py::none(), py::arg("time") = py::none(),
      py::arg("progress") = py::none(), py::arg("sample_range") = py::none(),
      "Renders a scene and returns its film, of the bits that `abbe render` gives, whatever the threads.\n\n"
      "`spp` and `seed` replace what the scene says; `threads` is one per processor unless given. `error` "
      "ends the "
      "render at that median relative error (0.01 for a percent), `time` after so many seconds, both at the "
      "end of "
      "a pass; neither goes with `spp` or `sample_range`. `progress` is called after passes with a Progress, "
      "on the calling thread. `sample_range` "
      "(first, last), or range(first, last), "
      "renders these samples only, for `merge`. Other threads of Python run meanwhile. Ctrl-C, and what "
      "`progress` "
      "raises, end the render after the pass that runs and are raised here.");
}

}  // namespace abbe::python
