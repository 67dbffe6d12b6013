#include <array>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "film/white.h"
#include "python/develop.h"
#include "python/errors.h"
#include "python/film.h"
#include "python/json.h"
#include "python/scene.h"
#include "sensor/film/recorded_white.h"
#include "validation/statistics/chart_difference.h"
#include "validation/statistics/common_part.h"
#include "validation/statistics/image_difference.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

// The pixels that films with crops or gaps have in common.
void tell_part(const std::vector<Crop>& part, py::dict& told) {
  std::vector<std::array<int, 4>> areas;
  for (const Crop& area : part) areas.push_back({area.x0, area.y0, area.x1, area.y1});
  if (areas.size() == 1)
    told["crop"] = areas.front();
  else
    told["areas"] = areas;
}

py::dict compare(const FilmHandle& film, const FilmHandle& reference, const py::object& white) {
  std::optional<Chromaticity> asked;
  if (!white.is_none())
    asked = asked_white(to_text(to_json(white, kWhitePointer)),
                        recorded_white(reference.image()) ? reference.image() : film.image(), "white")
                .xy;
  const std::vector<Crop> part = common_part(film.image(), reference.image());
  const bool is_whole = part.front() == Crop{0, 0, film.image().width, film.image().height};
  const Comparison found =
      is_whole ? compare_images(film.image(), reference.image(), asked)
               : compare_images(part_of(film.image(), part), part_of(reference.image(), part), asked);
  if (const auto untold = channel_of_untold_unit(film.image(), reference.image()))
    warn(fmt::format("only one of the films tells the unit of channel {}", *untold));
  if (const auto uncompared = uncompared_channels(film.image(), reference.image())) warn(*uncompared);
  py::dict told;
  if (!is_whole) tell_part(part, told);
  told["relMSE"] = found.rel_mse;
  told["rmse"] = found.rmse;
  told["mean_ratio"] = found.mean_ratio;
  const auto color = [&](double ColorDifference::*figure) {
    return found.color ? py::object(py::float_((*found.color).*figure)) : py::object(py::none());
  };
  told["dE00_mean"] = color(&ColorDifference::mean);
  told["dE00_p95"] = color(&ColorDifference::p95);
  told["dE00_max"] = color(&ColorDifference::max);
  return told;
}

py::list measure(const SceneHandle& scene, const FilmHandle& film, const FilmHandle* reference) {
  py::list patches;
  const Image* other = reference != nullptr ? &reference->image() : nullptr;
  for (const PatchDifference& patch : compare_chart(scene.scene(), film.image(), other, DeltaE::cie2000)) {
    py::dict told;
    told["patch"] = patch.name;
    told["pixels"] = patch.pixels;
    told["Lab"] = patch.image;
    told["reference_Lab"] = patch.reference;
    told["dE00"] = patch.delta_e;
    patches.append(told);
  }
  return patches;
}

}  // namespace

void add_compare(py::module_& module) {
  module.def(
      "compare", compare, py::arg("film"), py::arg("reference"), py::kw_only(), py::arg("white") = py::none(),
      "Returns how far a film is from a reference, as a dict with the keys of `abbe compare --json`: "
      "relative "
      "and absolute errors, the ratio of means, and CIEDE2000 over the pixels, None where colours are not "
      "known; of films with crops or gaps, `crop` or `areas` are the pixels that both have. Warns where one "
      "film alone tells its unit, and of channels that one film alone has, which are not compared. Raises "
      "InputError for films of different size or "
      "unit.");
  module.def("measure", measure, py::arg("scene"), py::arg("film"), py::arg("reference") = py::none(),
             "Reads the first chart of a scene out of a film of it: a dict for each patch, with its L*a*b*, "
             "that of the "
             "chart's own spectra (or of a reference film), and CIEDE2000 between them. Raises InputError "
             "for a scene "
             "without a chart.");
}

}  // namespace abbe::python
