#include "python/film.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "develop/develop.h"
#include "develop/film_file.h"
#include "develop/radiance.h"
#include "io/exr.h"
#include "io/picture.h"
#include "io/text.h"
#include "python/arguments.h"
#include "python/errors.h"
#include "python/gil.h"
#include "python/module.h"
#include "python/numbers.h"
#include "results/rendered_film.h"
#include "sensor/film/film_planes.h"
#include "sensor/film/recorded_attributes.h"

namespace abbe::python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

// Band centers of a spectral film in ascending order; empty for other films. It reads only the layout of the
// image, without values.
std::vector<double> band_centers_nm(const Image& image) {
  std::vector<double> centers_nm;
  if (!is_spectral(image)) return centers_nm;
  Image layout{image.width, image.height, {}, image.metadata};
  for (const ImageChannel& channel : image.channels) layout.channels.push_back({channel.name, {}});
  for (const SpectralBand& band : spectral_image(std::move(layout), "film").bands)
    centers_nm.push_back(band.center_nm);
  return centers_nm;
}

py::object wavelengths(const FilmHandle& film) {
  const std::vector<double> centers_nm = band_centers_nm(film.image());
  if (centers_nm.empty()) return py::none();
  return py::array_t<double>(static_cast<py::ssize_t>(centers_nm.size()), centers_nm.data());
}

py::object spectrum(const FilmHandle& film, Whole<int> column, Whole<int> row) {
  const int x = column;
  const int y = row;
  const Image& image = film.image();
  if (!is_spectral(image))
    refuse_argument("spectrum", "the film's sensor is not spectral: it has channels instead of wavelengths");
  if (x < 0 || y < 0 || x >= image.width || y >= image.height)
    refuse_argument("spectrum", "no such pixel (got {}, {}, allowed up to {}, {})", x, y, image.width - 1,
                    image.height - 1);
  const auto bands = static_cast<py::ssize_t>(band_centers_nm(image).size());
  return film.array()[py::make_tuple(y, x, py::slice(0, bands, 1))];
}

FilmHandle film_of_file(const fs::path& path) {
  const GilReleased released;
  if (extension_of(path) == kPartExtension) return FilmHandle(read_part(path));
  return FilmHandle(read_film(path));
}

ExposedFilm exposed(const Image& film) {
  constexpr const char* kWhere = "film";
  if (is_spectral(film)) return observed_film(spectral_image(film, kWhere), kWhere, {}, {});
  Diagnostics diagnostics;
  std::optional<FilmSensor> sensor =
      read_film_sensor(film, kWhere, {}, {}, recorded_white(film), diagnostics);
  require_no_errors(diagnostics);
  sensor->readout.reset();  // the expected exposure, without noise
  return {film, *std::move(sensor)};
}

Image display_picture(const FilmSensor& sensor, const Image& calibrated) {
  require_display(sensor);
  const Image planes = display_planes(sensor, calibrated);
  return (*sensor.display)(planes, 1 / display_white(sensor, planes)).image;
}

// Result of `make` for the sensor of a film and its expected exposure, without sensor noise. Throws
// InvalidInput if the film does not describe its sensor.
template <typename Make>
auto of_exposure(const FilmHandle& film, Make make) {
  const ExposedFilm source = exposed(film.image());
  return make(source.sensor, develop(source, 0).calibrated);
}

// Writes the format of the extension: the sums, the image or the display picture.
void write_film(const FilmHandle& film, const fs::path& path) {
  require_extension(path, {".exr", kPartExtension, ".png", ".jpg", ".tif"});
  const bool is_part = extension_of(path) == kPartExtension;
  if (is_part && !film.part())
    throw Error(ErrorCode::usage, path.string(),
                "the film was read from an image: only a film with its exact sums can be written as a part");
  if (!is_part && extension_of(path) != ".exr")
    return write_picture(path, of_exposure(film, display_picture));
  const Image* const image = is_part ? nullptr : &film.image();
  const GilReleased released;
  if (is_part)
    write_part(path, film.part()->identity, film.part()->result, film.part()->areas);
  else
    write_exr(path, *image);
}

// One input of `merge`: a Python film, or the path of a part, with a name for messages.
struct MergeInput {
  const RenderPart* film;  // nullptr for a path
  fs::path name;

  [[nodiscard]] PartHeader header() const {
    return film != nullptr ? header_of(*film) : read_part_header(name);
  }
  void add_to(RenderPart& sum) const {
    if (film != nullptr)
      merge(sum, *film, name);
    else
      merge(sum, read_part(name), name);
  }
};

std::vector<MergeInput> merge_inputs(const py::sequence& films) {
  if (py::isinstance<py::str>(films))  // a str is a sequence of characters
    throw py::type_error("films: expected a list of films or paths (got a str)");
  std::vector<MergeInput> all;
  for (std::size_t i = 0; i < films.size(); ++i) {
    const std::string name = fmt::format("films[{}]", i);
    if (!py::isinstance<FilmHandle>(films[i])) {
      all.push_back({nullptr, argument<fs::path>(films[i], name.c_str(), "a film or the path of a part")});
      continue;
    }
    const auto& part = films[i].cast<const FilmHandle&>().part();
    if (!part) refuse_argument(name, "was read from an image, which has no exact sums to add");
    all.push_back({&*part, name});
  }
  return all;
}

FilmHandle merge_films(const py::sequence& films, bool partial) {
  const std::vector<MergeInput> all = merge_inputs(films);
  if (all.empty()) throw Error(ErrorCode::usage, "merge", "needs one film or more");
  PartHeader whole = all.front().header();
  for (std::size_t i = 1; i < all.size(); ++i) merge(whole, all[i].header(), all[i].name);
  const SampledAreas absent = missing_samples(whole);
  if (!absent.empty() && !partial)
    throw Error(ErrorCode::input, "merge",
                fmt::format("{} of the render are missing; partial=True merges the others",
                            describe_samples(absent, whole.shape)));
  RenderPart sum = empty_part(whole);
  for (const MergeInput& one : all) one.add_to(sum);
  return FilmHandle(std::move(sum));
}

py::object stats(const FilmHandle& film) {
  if (!film.part()) return py::none();
  const RenderStats& stats = film.part()->result.stats;
  py::dict all;
  const bool ran_here = stats.wall_s > 0;  // parts and merged films record no cost
  all["wall_s"] = value_if(ran_here, stats.wall_s);
  all["cpu_s"] = value_if(ran_here, stats.cpu_s);
  all["threads"] = value_if(ran_here, stats.threads);
  all["samples_per_pixel"] = value_if(film.part()->areas.empty(), stats.samples_per_pixel);
  all["paths"] = stats.paths;
  all["rays"] = stats.rays;
  all["relative_error"] = finite_or_none(stats.error.median);
  all["frame_mean_error"] = finite_or_none(stats.error.frame_mean);
  all["half_noise_samples"] = stats.error.few_samples;
  all["nonfinite_samples"] = stats.nonfinite_samples;
  return all;
}

std::string repr_of_film(const FilmHandle& film) {
  return fmt::format("<abbe.Film: {} x {} pixels, {} channels>", film.image().width, film.image().height,
                     film.channels().size());
}

// Names in foreign files need not be UTF-8.
py::list channels_of(const FilmHandle& film) {
  py::list names;
  for (const std::string& name : film.channels()) names.append(decoded(name));
  return names;
}

py::dict metadata_of(const FilmHandle& film) {
  py::dict result;
  for (const auto& [name, value] : film.metadata()) result[decoded(name)] = decoded(value);
  return result;
}

void add_values(py::class_<FilmHandle, std::shared_ptr<FilmHandle>>& film) {
  film.def_property_readonly("array", &FilmHandle::array,
                             "The film's values as a read-only float32 array of rows, columns and channels, "
                             "equal to those in a file. The first access computes it from the exact sums; "
                             "later ones return the same array without a copy.")
      .def_property_readonly("variance", &FilmHandle::variance,
                             "The variance of each value, in the same shape; inf if it exceeds single "
                             "precision. None if the image does not record it, or if it is unknown because "
                             "some pixels have samples in fewer than two replicates.")
      .def_property_readonly("channels", channels_of, "The names of the channels, in the order of `array`.")
      .def_property_readonly("wavelengths", wavelengths,
                             "The centers of the bands of a spectral film in nm, in the order of `array`; "
                             "None for other films. Raises InputError for a spectral image in another unit "
                             "than W/(m^2 sr), or without bands of radiance.")
      .def("spectrum", spectrum, py::arg("x"), py::arg("y"),
           "Returns the radiance in each band at the pixel in column x and row y, in W/(m^2 sr), as a view "
           "of `array`. Raises UsageError for a film whose sensor is not spectral and for a pixel outside "
           "the film, and InputError as `wavelengths` does.");
}

}  // namespace

FilmHandle::FilmHandle(RenderPart part) : part_(std::move(part)) {}

FilmHandle::FilmHandle(Image image) : image_(std::move(image)) {}

const Image& FilmHandle::image() const {
  if (!image_) image_ = film_image(*part_);
  return *image_;
}

std::vector<std::string> FilmHandle::channels() const {
  return plane_names(image());
}

py::object FilmHandle::array() const {
  if (!array_) array_ = planes_of(image(), channels());
  return array_;
}

py::object FilmHandle::variance() const {
  if (has_unknown_error(metadata())) return py::none();
  std::vector<std::string> names = channels();
  for (std::string& name : names) name = variance_of(name);
  if (!variance_) variance_ = planes_of(image(), names);
  return variance_;
}

py::object planes_of(const Image& image, const std::vector<std::string>& names) {
  std::vector<const ImageChannel*> planes;
  for (const std::string& name : names) planes.push_back(image.find(name));
  if (planes.empty() || std::find(planes.begin(), planes.end(), nullptr) != planes.end()) return py::none();
  py::array_t<float> array(
      {static_cast<std::size_t>(image.height), static_cast<std::size_t>(image.width), planes.size()});
  float* values = array.mutable_data();
  for (std::size_t pixel = 0; pixel < image.pixels(); ++pixel)
    for (const ImageChannel* plane : planes) *values++ = plane->values[pixel];
  array.attr("flags").attr("writeable") = false;
  return array;
}

void add_film(py::module_& module) {
  py::class_<FilmHandle, std::shared_ptr<FilmHandle>> film(
      module, "Film",
      "The film of a scene's sensor: values per pixel and channel with their variance, before sensor "
      "noise.\n\n`abbe.render` and `abbe.merge` return films with their exact sums, and Film.read reads them "
      "from files. Jupyter displays a film as a picture if it has one.");
  forbid_bare_new(film);
  add_values(film);
  film.def_static("read", film_of_file, py::arg("path"),
                  "Reads a film from an .abbepart, with its exact sums, or from an .exr. Raises InputError "
                  "for a file that is missing, damaged or not a film.")
      .def("write", write_film, py::arg("path"),
           "Writes the film to .exr with its variance, to .abbepart with its exact sums, or its display "
           "picture to .png, .jpg or .tif. The file equals that of `abbe render` and never appears "
           "half-written. Raises OutputError.")
      .def_property_readonly("metadata", metadata_of,
                             "The attributes of the film's file, as strings by name.")
      .def_property_readonly(
          "stats", stats,
          "Statistics of the render as a dict; None for a film that was read from an image. `wall_s`, "
          "`cpu_s` and `threads` are None for a film that was merged or read from a part. The errors are "
          "None in that case, and unless the render was given `error` or `progress`. `samples_per_pixel` is "
          "None if pixels differ in their samples; `metadata` then has the `areas`.")
      .def_property_readonly(
          "width", [](const FilmHandle& f) { return f.image().width; }, "The film's columns of pixels.")
      .def_property_readonly(
          "height", [](const FilmHandle& f) { return f.image().height; }, "The film's rows of pixels.")
      .def("__repr__", repr_of_film)
      .def(
          "picture", [](const FilmHandle& f) { return of_exposure(f, picture_array); },
          "Returns the picture of the film on an sRGB display: rows, columns, and R, G, B or grey, as code "
          "values in [0, 1]. Raises UsageError for a film that no display can show.")
      .def("_repr_png_", [](const FilmHandle& f) { return of_exposure(f, png_of); });
  module.def("merge", merge_films, py::arg("films"), py::kw_only(), py::arg("partial") = false,
             "Merges films of one render, or the .abbepart files at paths, to the film that a single render "
             "of all their samples would give, bit for bit. Raises InputError for films of different "
             "renders, for samples that two films share, and, unless `partial`, for missing samples.");
}

py::object picture_array(const FilmSensor& sensor, const Image& calibrated) {
  const Image picture = display_picture(sensor, calibrated);
  std::vector<std::string> names;
  for (const ImageChannel& channel : picture.channels) names.push_back(channel.name);
  return planes_of(picture, names);
}

py::object png_of(const FilmSensor& sensor, const Image& calibrated) {
  if (!sensor.display) return py::none();
  return py::bytes(encoded_picture(".png", display_picture(sensor, calibrated)));
}

}  // namespace abbe::python
