#include "transport/render/render.h"

#include <cmath>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/arguments.h"
#include "python/errors.h"
#include "python/film.h"
#include "python/gil.h"
#include "python/job.h"
#include "python/module.h"
#include "python/numbers.h"
#include "python/scene.h"
#include "results/rendered_film.h"
#include "results/scene_warnings.h"
#include "transport/render/pass.h"

namespace pybind11::detail {

/// Converts (first, last), or a Python range of step 1, to the samples first <= s < last. The ends may be any
/// whole numbers from 0 on. Throws Python's TypeError for other objects.
template <>
struct type_caster<abbe::SampleRange> {
  bool load(const handle& object, bool convert) {
    using End = abbe::python::Whole<std::uint64_t>;
    make_caster<std::pair<End, End>> pair;
    const bool is_bytes =
        isinstance<bytes>(object) || isinstance<bytearray>(object) || isinstance<memoryview>(object);
    if (is_bytes || !pair.load(ends_of(object), convert))
      throw type_error(fmt::format(
          "sample_range: expected (first, last), whole numbers from 0 on, or a range of step 1 (got {})",
          std::string(repr(object))));
    const auto [first, last] = cast_op<std::pair<End, End>>(pair);
    value = {first, last};
    return true;
  }

  PYBIND11_TYPE_CASTER(abbe::SampleRange, const_name("Union[Tuple[int, int], range]"));

 private:
  static object ends_of(const handle& samples) {
    if (!PyRange_Check(samples.ptr())) return reinterpret_borrow<object>(samples);
    const object step = samples.attr("step");
    if (!step.equal(int_(1))) return none();
    return make_tuple(samples.attr("start"), samples.attr("stop"));
  }
};

}  // namespace pybind11::detail

namespace abbe::python {
namespace {

namespace py = pybind11;

// A copy of the scene with the requested settings; nothing if they equal those of the scene.
std::optional<abbe::Scene> with_settings_of(const abbe::Scene& scene, const Request& request) {
  RenderSettings settings = scene.render;
  if (request.spp) settings.samples = static_cast<int>(*request.spp);
  if (request.seed) settings.seed = static_cast<std::uint64_t>(*request.seed);
  if (settings.samples == scene.render.samples && settings.seed == scene.render.seed) return std::nullopt;
  std::optional<abbe::Scene> copy = scene;
  copy->render = settings;
  return copy;
}

// Renders with the GIL released. Warnings are issued before and after the render.
FilmHandle render_scene(SceneHandle& handle, const Request& request, const py::object& progress) {
  require_valid(request);
  const GilReleased released;
  const abbe::Scene& scene_with_white = handle.with_white(static_cast<int>(request.threads));
  const std::optional<abbe::Scene> copy = with_settings_of(scene_with_white, request);
  const abbe::Scene& scene = copy ? *copy : scene_with_white;
  RenderOptions how = render_limits(request);
  how.measure_error = false;
  how.samples = request.samples;
  if (how.samples) {
    const auto [first, last] = *how.samples;
    require(first < last && last <= static_cast<std::uint64_t>(scene.render.samples), "sample_range",
            fmt::format("({}, {})", first, last), "first < last, up to the samples of the whole render");
  }
  how.guides = handle.guiding_data();
  Inputs inputs = handle.inputs();
  inputs.reserve_memory("the film", film_bytes(scene, how));
  inputs.reserve_memory("the paths from lights of a sample", bytes_of_light_paths(scene));
  FilmIdentity identity = identity_of(scene, handle.name(), how);
  for (const auto& warning : {ignored_polarisation_warning(scene), dark_camera_warning(scene),
                              coincidence_warning(scene), unsampled_light_warning(scene),
                              undertrained_warning(how.guides.get()), unused_settings_warning(scene)})
    if (warning) warn(*warning);
  RenderResult result = render_listening(scene, how, progress);
  if (how.target_error && !how.time_limit_s && !std::isfinite(result.stats.error.median))
    warn("a pilot found no light on the film, so that error had no effect");
  for (const std::string& warning : render_warnings(scene, result)) warn(warning);
  return FilmHandle(RenderPart{std::move(identity), std::move(result)});
}

}  // namespace

void add_render(py::module_& module) {
  py::class_<Progress> progress(module, "Progress", "The progress of a render.");
  forbid_bare_new(progress);
  progress
      .def_readonly("share", &Progress::fraction_done,
                    "The fraction of the work that is done, in [0, 1]; an estimate if a time or error limit "
                    "ends the render.")
      .def_readonly("samples", &Progress::samples, "The number of finished samples per pixel.")
      .def_readonly("rate", &Progress::rate,
                    "The samples per pixel that this run finishes per second, without its planning; 0 before "
                    "the first one.")
      .def_readonly("elapsed_s", &Progress::elapsed_s, "The time since the render began, in s.")
      .def_readonly("left_s", &Progress::left_s,
                    "The estimated remaining time, in s; NaN before there is an estimate.")
      .def_property_readonly(
          "error", [](const Progress& p) { return p.error.median; },
          "The median relative error of the illuminated values so far; infinite while it is unknown.")
      .def_readonly("error_samples", &Progress::error_samples,
                    "The number of samples per pixel from which `error` was estimated.");
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
      "Renders a scene and returns its film, with the same bits as `abbe render` for any number of "
      "threads.\n\n`spp` and `seed` replace those of the scene; `threads` is one per processor by default. "
      "`error` ends the render at that median relative error (0.01 for one percent), `time` after so many "
      "seconds, both at the end of a pass; both exclude `spp` and `sample_range`. `progress` is called after "
      "passes with a Progress, on the calling thread. `sample_range` (first, last), or range(first, last), "
      "renders only these samples, for `merge`. Other Python threads run meanwhile. Ctrl-C, and exceptions "
      "from `progress`, end the render after the current pass and are raised here.");
}

}  // namespace abbe::python
