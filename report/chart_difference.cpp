#include "report/chart_difference.h"

#include <numeric>

#include "calibration/output/display.h"
#include "report/image_difference.h"
#include "scene/chart/readout.h"
#include "sensor/film/recorded_attributes.h"
#include "transport/render/white.h"

namespace abbe {
namespace {

struct ChartFilm {
  std::vector<PatchReading> patches;
  std::optional<std::vector<XYZ>> xyz;
};

ChartFilm read_film(const Scene& scene, const Image& film, const Chromaticity& light) {
  const FilmColors colors = film_colors(film);
  ChartFilm read{read_patches(scene, scene.charts.front(), film, colors.channels), {}};
  if (!colors.to_xyz) return read;
  Matrix3 to_xyz = *colors.to_xyz;
  // Patches are compared under the scene's light, but the film's matrix adapts its white to D65. Undo that
  // adaptation.
  if (colors.adapted) to_xyz = white_adaptation(colors.white.value_or(light)).inverse(true) * to_xyz;
  read.xyz.emplace();
  for (const PatchReading& patch : read.patches)
    read.xyz->push_back(multiply(to_xyz, {patch.mean[0], patch.mean[1], patch.mean[2]}));
  return read;
}

double sum_of_y(const std::vector<XYZ>& colors) {
  return std::accumulate(colors.begin(), colors.end(), 0.0,
                         [](double sum, const XYZ& xyz) { return sum + xyz[1]; });
}

std::optional<Lab> scaled_lab(const std::optional<std::vector<XYZ>>& colors, std::size_t patch, double factor,
                              const XYZ& white) {
  if (!colors) return std::nullopt;
  XYZ xyz = (*colors)[patch];
  for (double& v : xyz) v *= factor;
  return xyz_to_lab(xyz, white);
}

}  // namespace

std::vector<PatchDifference> compare_chart(const Scene& scene, const Image& image, const Image* reference,
                                           DeltaE formula) {
  if (scene.charts.empty()) throw Error(ErrorCode::input, "", "the scene has no chart");
  if (scene.lights.empty()) throw Error(ErrorCode::input, "", "the scene has no light for its chart");
  const Observer observer = recorded_film_observer(image).observer;
  if (reference != nullptr && recorded_film_observer(*reference).observer != observer)
    throw Error(ErrorCode::input, "",
                "the colours of the films cannot be compared: only one film records the CIE 1964 observer");
  const Curve light = main_light(scene).spectrum.value();
  const XYZ white = tristimulus(light, Curve(1), observer);
  const ChartFilm film = read_film(scene, image, chromaticity(light));
  std::vector<XYZ> integrated;
  for (const PatchReading& patch : film.patches)
    integrated.push_back(tristimulus(light, *patch.reflectance, observer));
  const auto other = reference != nullptr ? read_film(scene, *reference, chromaticity(light)).xyz
                                          : std::optional(integrated);
  const auto& exposed = reference != nullptr ? other : film.xyz;
  if (exposed && !(sum_of_y(*exposed) > 0))
    throw Error(ErrorCode::input, scene.charts.front().name,
                "the film has no light in its patches: it needs the camera and the pixels of the scene");
  const double factor = exposed ? sum_of_y(integrated) / sum_of_y(*exposed) : 1;
  std::vector<PatchDifference> differences;
  for (std::size_t i = 0; i < film.patches.size(); ++i) {
    const auto wanted = scaled_lab(other, i, reference != nullptr ? factor : 1, white);
    const auto found = scaled_lab(film.xyz, i, factor, white);
    differences.push_back(
        {film.patches[i].name, film.patches[i].pixels, wanted, found,
         wanted && found ? std::optional(delta_e(formula, *wanted, *found)) : std::nullopt});
  }
  return differences;
}

}  // namespace abbe
