#include "python/scene.h"

#include <system_error>
#include <variant>

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "description/load.h"
#include "io/schema/documentation.h"
#include "io/schema/write.h"
#include "python/arguments.h"
#include "python/errors.h"
#include "python/gil.h"
#include "python/json.h"
#include "python/module.h"
#include "results/white.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/threads.h"

namespace abbe::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

// Name of a scene without a file in messages.
constexpr const char* kDict = "dict";

// Keywords over a file act as `--set` does in the command, so that films record the same hash.
std::vector<Override> overrides_of(const py::dict& keywords) {
  const JsonValue all = to_json(keywords);
  std::vector<Override> overrides;
  for (const auto& [name, value] : std::get<JsonValue::Object>(all.value))
    overrides.push_back({"/" + escaped_key(name), to_text(value), name});
  return overrides;
}

// The text of a scene given in Python, so that messages can quote lines.
std::shared_ptr<const SourceText> text_of(const py::object& source, const py::dict& keywords) {
  py::dict all;
  all["abbe"] = spec::kFormatVersion;  // only files must state it
  if (!source.is_none())
    for (const auto& [key, value] : py::dict(source)) all[key] = value;
  for (const auto& [key, value] : keywords) all[key] = value;
  return std::make_shared<const SourceText>(SourceText{kDict, to_lines(to_json(all), kJsonWidth)});
}

// Help text of the class, with the keywords from the table of the scene's keys.
std::string class_text() {
  std::string text =
      "A scene, ready to render.\n\nScene(path) reads a scene file. Scene(dict) takes the content of such a "
      "file; files that it names are relative to `folder`, by default the current one, which only a dict may "
      "have. Keywords are keys at the top level of the scene and replace those of the file or dict. Invalid "
      "input raises abbe.SceneError or abbe.InputError, whose `diagnostics` list all errors.\n\nKeywords:\n";
  const schema::Fields* const root = &schema::fields_of<spec::Scene>();
  for (const schema::Key& key : schema::keys_of({&root, 1}))
    text += fmt::format("  {}: {} ({})\n", key.name, key.meaning(), key.allowed());
  return text + "\nabbe.help(\"camera\") describes the values of a key.";
}

py::str repr_of_scene(const SceneHandle& handle) {
  const abbe::Scene& scene = handle.scene();
  return decoded(fmt::format("<abbe.Scene {}: {} x {} pixels, {} shapes, {} lights>", handle.name().string(),
                             scene.camera.width, scene.camera.height, scene.shapes.size(),
                             scene.lights.size()));
}

}  // namespace

SceneSource source_of(const py::object& source, const py::object& folder, const py::dict& keywords) {
  if (py::isinstance<py::dict>(source) || source.is_none())
    return {kDict, text_of(source, keywords),
            folder.is_none() ? fs::path() : argument<fs::path>(folder, "folder", "a path")};
  if (!folder.is_none())
    refuse_argument(
        "folder", "applies only to files that a dict names; those of a scene file are relative to that file");
  std::vector<Override> overrides = overrides_of(keywords);
  return {argument<fs::path>(source, "source", "a path or a dict"), {}, {}, std::move(overrides)};
}

SceneHandle::SceneHandle(const py::object& source, const py::object& folder, const py::dict& keywords) {
  source_ = source_of(source, folder, keywords);
  name_ = source_.name;
  Diagnostics diagnostics;
  std::optional<abbe::Scene> scene;
  {
    const GilReleased released;
    scene = source_.text ? load_scene(source_.text, source_.folder, source_.overrides, diagnostics, &inputs_,
                                      &scene_spec_)
                         : load_scene(source_.name, source_.overrides, diagnostics, &inputs_, &scene_spec_);
  }
  scene_ = accepted(std::move(scene), diagnostics);
  std::error_code error;
  fs::path& path = source_.text ? source_.folder : source_.name;
  path = fs::current_path(error) / path;
}

const abbe::Scene& SceneHandle::with_white(int threads) {
  const std::scoped_lock lock(mutex_);
  if (has_white_) return scene_;
  abbe::Scene resolved = scene_;
  const IntegratorChoice choice = choose_integrator(resolved, thread_count(threads));
  resolved.render.integrator = choice.integrator;
  resolve_white(resolved, name(), thread_count(threads), choice.guides);
  const GilAcquired gil;  // for threads that read the scene meanwhile
  scene_.render.integrator = resolved.render.integrator;
  scene_.output = std::move(resolved.output);
  guiding_data_ = choice.guides;
  has_white_ = true;
  return scene_;
}

void add_scene(py::module_& module) {
  static const std::string kText = class_text();
  py::class_<SceneHandle, std::shared_ptr<SceneHandle>> scene(module, "Scene", kText.c_str());
  forbid_bare_new(scene);
  scene
      .def(py::init([](const py::object& source, const py::object& folder, const py::kwargs& keywords) {
             return std::make_shared<SceneHandle>(source, folder, keywords);
           }),
           py::arg("source") = py::none(), py::kw_only(), py::arg("folder") = py::none(),
           "Reads a scene from a path or a dict. Keywords replace keys at the top level.")
      .def(
          "to_dict", [](const SceneHandle& s) { return to_python(schema::write(s.scene_spec())); },
          "Returns the scene as a dict that describes the same scene, without values that equal their "
          "defaults.")
      .def_property_readonly(
          "width", [](const SceneHandle& s) { return s.scene().camera.width; },
          "The film's columns of pixels.")
      .def_property_readonly(
          "height", [](const SceneHandle& s) { return s.scene().camera.height; },
          "The film's rows of pixels.")
      .def_property_readonly(
          "channels", [](const SceneHandle& s) { return s.scene().film_planes(); },
          "The names of the film's planes.")
      .def_property_readonly(
          "samples", [](const SceneHandle& s) { return s.scene().render.samples; },
          "The samples per pixel, unless the arguments of `render` replace them.")
      .def_property_readonly(
          "seed", [](const SceneHandle& s) { return s.scene().render.seed; },
          "The seed of the random numbers, unless the arguments of `render` replace it.")
      .def("__repr__", repr_of_scene);
  module.def(
      "help", [](const std::string& key) { return schema::help(schema::fields_of<spec::Scene>(), key); },
      py::arg("key") = "",
      "Returns the meaning, range and default of a key of scenes, as `abbe help scene KEY` prints them.");
}

}  // namespace abbe::python
