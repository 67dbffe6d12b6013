#include "develop/develop.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "develop/film_file.h"
#include "develop/radiance.h"
#include "io/text.h"
#include "python/arguments.h"
#include "python/errors.h"
#include "python/film.h"
#include "python/gil.h"
#include "python/job.h"
#include "python/json.h"
#include "python/module.h"
#include "python/numbers.h"
#include "python/scene.h"
#include "results/spectral.h"
#include "results/white.h"
#include "sensor/film/recorded_attributes.h"

namespace abbe::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

constexpr const char* kWhere = "film";  // name of the film in messages
constexpr const char* kReadout = "/readout";

/// A film after readout, and the sensor that read it out.
struct Developed {
  FilmSensor sensor;
  DevelopedFilm planes;
};

FilmSensor sensor_of(const Image& film, const py::object& readout, const std::optional<White>& white) {
  std::vector<Override> overrides;
  if (!readout.is_none()) overrides.push_back({kReadout, to_text(to_json(readout, kReadout)), "readout"});
  Diagnostics diagnostics;
  const auto xy = white ? std::optional(white->xy) : std::nullopt;
  FilmSensor sensor = accepted(read_film_sensor(film, kWhere, overrides, {}, xy, diagnostics), diagnostics);
  if (white) sensor.white_name = white->name;
  require_planes(film, sensor, kWhere);
  return sensor;
}

// Exposes the sensor of another scene to the radiance of a spectral film.
ExposedFilm observed(const FilmHandle& film, SceneHandle& sensor_scene, const py::object& readout,
                     const std::optional<std::string>& white) {
  abbe::Scene scene = sensor_scene.scene();
  resolve_white(scene, sensor_scene.name(), film.image(), white, "white");
  Diagnostics diagnostics;
  Image image = expose_radiances(scene, spectral_image(film.image(), kWhere), kWhere, diagnostics);
  check(diagnostics);
  FilmSensor sensor = sensor_of(image, readout, std::nullopt);
  return {std::move(image), std::move(sensor)};
}

ExposedFilm exposed(const FilmHandle& film, SceneHandle* sensor_scene, const py::object& readout,
                    const std::optional<std::string>& white) {
  const Image& image = film.image();
  if (is_spectral(image) && sensor_scene != nullptr) return observed(film, *sensor_scene, readout, white);
  if (sensor_scene != nullptr)
    refuse_argument("scene",
                    "only a spectral film can be viewed by a scene's sensor; this film has its own sensor");
  const auto requested = white ? std::optional(requested_white(*white, image, "white")) : std::nullopt;
  if (is_spectral(image) && !readout.is_none())
    refuse_argument("readout", "a spectral film has no sensor to read out; `scene` supplies one");
  if (!is_spectral(image)) return {image, sensor_of(image, readout, requested)};
  ExposedFilm observed = observed_film(spectral_image(image, kWhere), kWhere, {},
                                       requested ? std::optional(requested->xy) : std::nullopt);
  if (requested) observed.sensor.white_name = requested->name;
  return observed;
}

Developed develop_film(const FilmHandle& film, const py::object& readout, const py::object& white,
                       std::optional<Whole<std::int64_t>> seed, SceneHandle* scene) {
  require_seed(seed);
  const auto requested =
      white.is_none() ? std::nullopt : std::optional(to_text(to_json(white, kWhitePointer)));
  ExposedFilm source = exposed(film, scene, readout, requested);
  if (seed && !source.sensor.readout)
    refuse_argument("seed", "the film has no readout, so that there is no noise to seed");
  const std::uint64_t noise = seed ? static_cast<std::uint64_t>(*seed) : render_seed(source.film);
  const GilReleased released;
  DevelopedFilm planes = develop(source, noise);
  return {std::move(source.sensor), std::move(planes)};
}

void write_developed(const Developed& developed, const fs::path& path) {
  require_developed_extension(path);
  if (extension_of(path) == ".exr")
    return write_parts(path, developed.planes, display_planes(developed.sensor, developed.planes.calibrated),
                       developed.sensor);
  if (!developed.sensor.readout)
    refuse_argument(path.string(), "the film has no readout and therefore no digital numbers");
  if (const auto dark = unequal_dark_signals_warning(developed.sensor)) warn(*dark);
  write_raw(path, developed.planes, developed.sensor);
}

py::list figures(const Developed& developed) {
  py::list all;
  const std::vector<PlaneFigures> planes = plane_figures(developed.sensor, developed.planes);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const PlaneFigures& plane = planes[i];
    py::dict result;
    result["plane"] = developed.sensor.planes.at(i);
    result["mean"] = plane.mean;
    result["render_error"] = plane.render_error;
    if (developed.sensor.readout) {
      result["photon_noise_e"] = plane.noise.photon_e;
      result["dark_noise_e"] = plane.noise.dark_e;
      result["read_noise_e"] = plane.noise.read_e;
      result["row_noise_e"] = plane.noise.row_e;
      result["quantisation_noise_e"] = plane.noise.quantisation_e;
      result["sensor_noise_e"] = plane.noise.total_e;
      result["saturated_share"] = plane.saturated_fraction;
    }
    all.append(result);
  }
  return all;
}

}  // namespace

void add_develop(py::module_& module) {
  py::class_<Developed> developed(
      module, "Developed",
      "A film after readout: an array of rows, columns and planes for each step from light to digital "
      "numbers. Steps that the film's sensor lacks are None.");
  forbid_bare_new(developed);
  developed.def_property_readonly(
      "planes", [](const Developed& d) { return d.sensor.planes; }, "The names of the planes of the arrays.");
  const auto add_array = [&](const char* name, Image DevelopedFilm::*step, const char* prefix,
                             const char* text) {
    const auto array = [step, prefix](const Developed& d) {
      std::vector<std::string> names = d.sensor.planes;
      for (std::string& plane : names) plane = prefix + plane;
      return planes_of(d.planes.*step, names);
    };
    developed.def_property_readonly(name, array, text);
  };
  add_array("exposure", &DevelopedFilm::exposure, "", "The film values before readout.");
  add_array("electrons", &DevelopedFilm::electrons, "",
            "The expected number of photoelectrons of each pixel.");
  add_array("codes", &DevelopedFilm::codes, "", "The digital numbers, with all noise.");
  add_array("saturated", &DevelopedFilm::codes, "Saturated.", "1 where a pixel saturated, 0 elsewhere.");
  add_array("calibrated", &DevelopedFilm::calibrated, "",
            "The exposure estimated from the digital numbers; without a readout the exposure itself.");
  developed
      .def_property_readonly("figures", figures,
                             "A list of dicts, one for each plane: its mean, the error of the render (None "
                             "if unknown), and the noise of the sensor, in electrons if there is a readout.")
      .def(
          "picture", [](const Developed& d) { return picture_array(d.sensor, d.planes.calibrated); },
          "Returns the picture on an sRGB display, as code values in [0, 1]. Raises UsageError if no "
          "display can show the sensor's channels.")
      .def("write", write_developed, py::arg("path"),
           "Writes the digital numbers to a 16-bit .tif or .png, or all planes to an .exr with parts. Raises "
           "OutputError.")
      .def("_repr_png_", [](const Developed& d) { return png_of(d.sensor, d.planes.calibrated); });
  module.def("develop", develop_film, py::arg("film"), py::kw_only(), py::arg("readout") = py::none(),
             py::arg("white") = py::none(), py::arg("seed") = py::none(), py::arg("scene") = py::none(),
             "Reads a film out without rendering: adds noise, converts to digital numbers, and estimates the "
             "exposure from these.\n\n`readout` replaces the readout of the sensor, as a dict with the keys "
             "of `help(\"sensor/readout\")`. `white` is the white of pictures, as `output/white` of a scene. "
             "`seed` is that of the readout noise, by default that of the render. The sensor of `scene` can "
             "view a spectral film.");
}

}  // namespace abbe::python
