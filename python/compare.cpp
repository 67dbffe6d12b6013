#include <array>
#include <vector>

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/errors.h"
#include "python/film.h"
#include "python/json.h"
#include "python/module.h"
#include "python/scene.h"
#include "report/chart_difference.h"
#include "report/image_difference.h"
#include "results/white.h"
#include "sensor/film/recorded_attributes.h"

namespace abbe::python {
namespace {

namespace py = pybind11;

// Adds the common area of films with crops or gaps.
void add_common_area(const std::vector<Crop>& part, py::dict& result) {
  std::vector<std::array<int, 4>> areas;
  for (const Crop& area : part) areas.push_back({area.x0, area.y0, area.x1, area.y1});
  if (areas.size() == 1)
    result["crop"] = areas.front();
  else
    result["areas"] = areas;
}

py::dict compare(const FilmHandle& film, const FilmHandle& reference, const py::object& white) {
  std::optional<Chromaticity> requested_xy;
  if (!white.is_none())
    requested_xy =
        requested_white(to_text(to_json(white, kWhitePointer)),
                        recorded_white(reference.image()) ? reference.image() : film.image(), "white")
            .xy;
  const std::vector<Crop> part = common_areas(film.image(), reference.image());
  const bool is_whole = part.front() == Crop{0, 0, film.image().width, film.image().height};
  const Comparison comparison = is_whole
                                    ? compare_images(film.image(), reference.image(), requested_xy)
                                    : compare_images(extract_areas(film.image(), part),
                                                     extract_areas(reference.image(), part), requested_xy);
  if (const auto undeclared = channel_with_undeclared_unit(film.image(), reference.image()))
    warn(fmt::format("only one of the films declares the unit of channel {}", *undeclared));
  if (const auto uncompared = uncompared_channels(film.image(), reference.image())) warn(*uncompared);
  py::dict result;
  if (!is_whole) add_common_area(part, result);
  result["relMSE"] = comparison.rel_mse;
  result["rmse"] = comparison.rmse;
  result["mean_ratio"] = comparison.mean_ratio;
  const auto color = [&](double ColorDifference::*figure) {
    return comparison.color ? py::object(py::float_((*comparison.color).*figure)) : py::object(py::none());
  };
  result["dE00_mean"] = color(&ColorDifference::mean);
  result["dE00_p95"] = color(&ColorDifference::p95);
  result["dE00_max"] = color(&ColorDifference::max);
  return result;
}

py::list measure(const SceneHandle& scene, const FilmHandle& film, const FilmHandle* reference) {
  py::list patches;
  const Image* other = reference != nullptr ? &reference->image() : nullptr;
  for (const PatchDifference& patch : compare_chart(scene.scene(), film.image(), other, DeltaE::cie2000)) {
    py::dict result;
    result["patch"] = patch.name;
    result["pixels"] = patch.pixels;
    result["Lab"] = patch.image;
    result["reference_Lab"] = patch.reference;
    result["dE00"] = patch.delta_e;
    patches.append(result);
  }
  return patches;
}

}  // namespace

void add_compare(py::module_& module) {
  module.def("compare", compare, py::arg("film"), py::arg("reference"), py::kw_only(),
             py::arg("white") = py::none(),
             "Compares a film with a reference. Returns a dict with the keys of `abbe compare --json`: "
             "relative and absolute errors, the ratio of means, and CIEDE2000 over the pixels, which is None "
             "if colours are unknown. For films with crops or gaps, `crop` or `areas` are the pixels that "
             "both have. Warns if only one film declares its unit, and of channels that only one film has, "
             "which are not compared. Raises InputError for films of different size or unit.");
  module.def("measure", measure, py::arg("scene"), py::arg("film"), py::arg("reference") = py::none(),
             "Measures the first chart of a scene in a film of that scene. Returns a list of dicts, one for "
             "each patch: its L*a*b*, that of the chart's own spectra (or of a reference film), and "
             "CIEDE2000 between them. Raises InputError for a scene without a chart.");
}

}  // namespace abbe::python
