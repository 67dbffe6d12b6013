#include "develop/develop.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "develop/film_file.h"
#include "develop/radiance.h"
#include "film/spectral.h"
#include "film/white.h"
#include "io/extension.h"
#include "python/arguments.h"
#include "python/develop.h"
#include "python/errors.h"
#include "python/film.h"
#include "python/json.h"
#include "python/lock.h"
#include "python/numbers.h"
#include "python/picture.h"
#include "python/request.h"
#include "python/scene.h"
#include "sensor/film/recorded_white.h"

namespace abbe::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

constexpr const char* kWhere = "film";  // what messages call the film
constexpr const char* kReadout = "/readout";

/// A film that was read out, with the sensor that did.
struct Developed {
  FilmSensor sensor;
  DevelopedFilm planes;

  [[nodiscard]] Image picture() const { return display_picture(sensor, planes.calibrated); }
};

std::vector<std::string> names_of(const Image& image, const std::string& prefix) {
  std::vector<std::string> names;
  for (const ImageChannel& channel : image.channels)
    if (channel.name.starts_with(prefix)) names.push_back(channel.name);
  return names;
}

py::object array_of(const Image& image, std::vector<std::string> planes, const std::string& prefix = "") {
  for (std::string& name : planes) name = prefix + name;
  return planes_of(image, planes);
}

FilmSensor sensor_of(const Image& film, const py::object& readout, const std::optional<White>& white) {
  std::vector<Override> overrides;
  if (!readout.is_none()) overrides.push_back({kReadout, to_text(to_json(readout, kReadout)), "readout"});
  Diagnostics diagnostics;
  const auto xy = white ? std::optional(white->xy) : std::nullopt;
  FilmSensor sensor = accepted(film_sensor(film, kWhere, overrides, {}, xy, diagnostics), diagnostics);
  if (white) sensor.white_name = white->name;
  require_planes(film, sensor, kWhere);
  return sensor;
}

// What the sensor of another scene sees of radiances.
ExposedFilm seen(const FilmHandle& film, SceneHandle& looker, const py::object& readout,
                 const std::optional<std::string>& white) {
  abbe::Scene scene = looker.scene();
  settle_white(scene, looker.name(), film.image(), white, "white");
  Diagnostics diagnostics;
  Image image = seen_by(scene, spectral_image(film.image(), kWhere), kWhere, diagnostics);
  check(diagnostics);
  FilmSensor sensor = sensor_of(image, readout, std::nullopt);
  return {std::move(image), std::move(sensor)};
}

ExposedFilm exposed(const FilmHandle& film, SceneHandle* looker, const py::object& readout,
                    const std::optional<std::string>& white) {
  const Image& image = film.image();
  if (is_spectral(image) && looker != nullptr) return seen(film, *looker, readout, white);
  if (looker != nullptr)
    throw Error(ErrorCode::usage, "scene", "only a spectral film takes a sensor: this one has its own");
  const auto asked = white ? std::optional(asked_white(*white, image, "white")) : std::nullopt;
  if (is_spectral(image) && !readout.is_none())
    throw Error(ErrorCode::usage, "readout",
                "a spectral film has no sensor to read out: `scene` gives it one");
  if (!is_spectral(image)) return {image, sensor_of(image, readout, asked)};
  ExposedFilm seen = observed_film(spectral_image(image, kWhere), kWhere, {},
                                   asked ? std::optional(asked->xy) : std::nullopt);
  if (asked) seen.sensor.white_name = asked->name;
  return seen;
}

Developed develop_film(const FilmHandle& film, const py::object& readout, const py::object& white,
                       std::optional<Whole<std::int64_t>> seed, SceneHandle* scene) {
  require_seed(seed);
  const auto asked = white.is_none() ? std::nullopt : std::optional(to_text(to_json(white, kWhitePointer)));
  ExposedFilm source = exposed(film, scene, readout, asked);
  if (seed && !source.sensor.readout)
    throw Error(ErrorCode::usage, "seed", "the film has no read-out whose noise it could draw");
  const std::uint64_t noise = seed ? static_cast<std::uint64_t>(*seed) : render_seed(source.film);
  const Released released;
  DevelopedFilm planes = develop(source, noise);
  return {std::move(source.sensor), std::move(planes)};
}

void write_developed(const Developed& developed, const fs::path& path) {
  require_developed_extension(path);
  if (extension_of(path) == ".exr")
    return write_parts(path, developed.planes, display_planes(developed.sensor, developed.planes.calibrated),
                       developed.sensor);
  if (!developed.sensor.readout)
    throw Error(ErrorCode::usage, path.string(), "the film has no read-out to make codes with");
  if (const auto dark = own_dark_signals(developed.sensor)) warn(*dark);
  write_raw(path, developed.planes, developed.sensor);
}

py::list figures(const Developed& developed) {
  py::list all;
  const std::vector<PlaneFigures> planes = plane_figures(developed.sensor, developed.planes);
  for (std::size_t i = 0; i < planes.size(); ++i) {
    const PlaneFigures& plane = planes[i];
    py::dict told;
    told["plane"] = developed.sensor.planes.at(i);
    told["mean"] = plane.mean;
    told["render_error"] = plane.render_error;
    if (developed.sensor.readout) {
      told["photon_noise_e"] = plane.noise.photon_e;
      told["dark_noise_e"] = plane.noise.dark_e;
      told["read_noise_e"] = plane.noise.read_e;
      told["row_noise_e"] = plane.noise.row_e;
      told["quantisation_noise_e"] = plane.noise.quantisation_e;
      told["sensor_noise_e"] = plane.noise.total_e;
      told["saturated_share"] = plane.saturated_share;
    }
    all.append(told);
  }
  return all;
}

py::object picture_array(const Developed& developed) {
  const Image picture = developed.picture();
  return planes_of(picture, names_of(picture, ""));
}

}  // namespace

void add_develop(py::module_& module) {
  py::class_<Developed> developed(
      module, "Developed",
      "A film that was read out: arrays of rows, columns and planes for each step from light to "
      "numbers; what the film's sensor does not have is None.");
  forbid_bare_new(developed);
  developed
      .def_property_readonly(
          "planes", [](const Developed& d) { return d.sensor.planes; },
          "The names of the planes of the arrays.")
      .def_property_readonly(
          "exposure", [](const Developed& d) { return array_of(d.planes.exposure, d.sensor.planes); },
          "The film values that were read out.")
      .def_property_readonly(
          "electrons", [](const Developed& d) { return array_of(d.planes.electrons, d.sensor.planes); },
          "The electrons that each pixel expects from light.")
      .def_property_readonly(
          "codes", [](const Developed& d) { return array_of(d.planes.codes, d.sensor.planes); },
          "The digital numbers, with all noise.")
      .def_property_readonly(
          "saturated",
          [](const Developed& d) { return array_of(d.planes.codes, d.sensor.planes, "Saturated."); },
          "1 where a pixel saturated, 0 elsewhere.")
      .def_property_readonly(
          "calibrated", [](const Developed& d) { return array_of(d.planes.calibrated, d.sensor.planes); },
          "What the digital numbers say of the exposure; without a read-out the exposure itself.")
      .def_property_readonly(
          "figures", figures,
          "For each plane a dict of its mean, the error of the render, None where it is not known, and the "
          "noise of the sensor, in electrons where there is a read-out.")
      .def("picture", picture_array,
           "Returns the result as an sRGB display shows it, code values in [0, 1]. Raises UsageError where "
           "no display can show what the sensor sees.")
      .def(
          "write", write_developed, py::arg("path"),
          "Writes the codes to a 16-bit .tif or .png, or all planes to an .exr of parts. Raises OutputError.")
      .def("_repr_png_", [](const Developed& d) { return png_of(d.sensor, d.planes.calibrated); });
  module.def("develop", develop_film, py::arg("film"), py::kw_only(), py::arg("readout") = py::none(),
             py::arg("white") = py::none(), py::arg("seed") = py::none(), py::arg("scene") = py::none(),
             "Reads a film out without rendering: noise, digital numbers, and what these say.\n\n`readout` "
             "replaces the "
             "sensor's, as a dict with the keys of `help(\"sensor/readout\")`; `white` is what pictures show "
             "as white, "
             "as `output/white` of a scene; `seed` is that of the noise of a read-out, by default the "
             "render's. At a "
             "spectral film the "
             "sensor of `scene` may look.");
}

}  // namespace abbe::python
