#include "python/scene.h"

#include <system_error>
#include <variant>

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "description/load.h"
#include "description/scene_schema.h"
#include "film/white.h"
#include "io/schema/help.h"
#include "io/schema/keys.h"
#include "io/schema/write.h"
#include "python/arguments.h"
#include "python/errors.h"
#include "python/json.h"
#include "python/lock.h"
#include "python/text.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/threads.h"

namespace abbe::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

// What messages call a scene that no file holds.
constexpr const char* kDict = "dict";

const schema::Fields& scene_fields() {
  return schema::fields_of<spec::Scene>();
}

// Keywords over a file are what `--set` is to the command, so that films tell the same hash.
std::vector<Override> overrides_of(const py::dict& keywords) {
  const JsonValue all = to_json(keywords);
  std::vector<Override> overrides;
  for (const auto& [name, value] : std::get<JsonValue::Object>(all.value))
    overrides.push_back({"/" + escaped(name), to_text(value), name});
  return overrides;
}

// The text of a scene said in Python, so that complaints show the line concerned.
std::shared_ptr<const SourceText> text_of(const py::object& source, const py::dict& keywords) {
  py::dict all;
  all["abbe"] = spec::kFormatVersion;  // which only files need to tell
  if (!source.is_none())
    for (const auto& [key, value] : py::dict(source)) all[key] = value;
  for (const auto& [key, value] : keywords) all[key] = value;
  return std::make_shared<const SourceText>(SourceText{kDict, to_lines(to_json(all), kJsonWidth)});
}

// The keywords of the class, from the table of the scene's keys.
std::string class_text() {
  std::string text =
      "A scene, ready to render.\n\n"
      "Scene(path) reads a scene file; Scene(dict) takes what such a file would hold, and files it names are "
      "looked for in `folder`, by default the current one, which only a dict may have. Keywords are keys at "
      "the top of the scene and "
      "replace "
      "those of the file or dict. What is wrong is raised as abbe.SceneError or abbe.InputError, whose "
      "`diagnostics` tell all of it.\n\nKeywords:\n";
  const schema::Fields* const root = &scene_fields();
  for (const schema::Key& key : schema::keys_of({&root, 1}))
    text += fmt::format("  {}: {} ({})\n", key.name, key.meaning(), key.allowed());
  return text + "\nabbe.help(\"camera\") tells what may stand in them.";
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
    throw Error(ErrorCode::usage, "folder",
                "is where files that a dict names are looked for; those of a scene file are beside it");
  std::vector<Override> overrides = overrides_of(keywords);
  return {argument<fs::path>(source, "source", "a path or a dict"), {}, {}, std::move(overrides)};
}

SceneHandle::SceneHandle(const py::object& source, const py::object& folder, const py::dict& keywords) {
  source_ = source_of(source, folder, keywords);
  name_ = source_.name;
  Diagnostics diagnostics;
  std::optional<abbe::Scene> scene;
  {
    const Released released;
    scene = source_.text
                ? load_scene(source_.text, source_.folder, source_.overrides, diagnostics, &inputs_, &said_)
                : load_scene(source_.name, source_.overrides, diagnostics, &inputs_, &said_);
  }
  scene_ = accepted(std::move(scene), diagnostics);
  std::error_code gone;
  fs::path& place = source_.text ? source_.folder : source_.name;
  place = fs::current_path(gone) / place;
}

const abbe::Scene& SceneHandle::with_white(int threads) {
  const std::scoped_lock lock(mutex_);
  if (has_white_) return scene_;
  abbe::Scene settled = scene_;
  const IntegratorChoice choice = choose_integrator(settled, thread_count(threads));
  settled.render.integrator = choice.integrator;
  settle_white(settled, name(), thread_count(threads), choice.guides);
  const Held held;  // for those who read the scene meanwhile
  scene_.render.integrator = settled.render.integrator;
  scene_.output = std::move(settled.output);
  guides_ = choice.guides;
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
           "Reads a scene from a path or a dict; keywords replace keys at its top.")
      .def(
          "to_dict", [](const SceneHandle& s) { return to_python(schema::write(s.said())); },
          "Returns the scene as a dict that makes the same scene, without what is as by default.")
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
          "How many samples a pixel gets unless `render` is told otherwise.")
      .def_property_readonly(
          "seed", [](const SceneHandle& s) { return s.scene().render.seed; },
          "The seed of the random numbers unless `render` is told otherwise.")
      .def("__repr__", repr_of_scene);
  module.def(
      "help", [](const std::string& key) { return schema::help(scene_fields(), key); }, py::arg("key") = "",
      "Returns what a key of scenes means, its range and its default, as `abbe help scene KEY` prints it.");
}

}  // namespace abbe::python
