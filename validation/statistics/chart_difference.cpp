#include "validation/statistics/chart_difference.h"

#include <numeric>

#include "calibration/output/color_spaces.h"
#include "scene/chart/readout.h"

namespace abbe {
namespace {

struct ChartFilm {
  std::vector<PatchReading> patches;
  std::vector<XYZ> xyz;
};

ChartFilm read_film(const Scene& scene, const Image& film) {
  const bool observer = film.find("X") != nullptr;
  const std::vector<std::string> channels =
      observer ? std::vector<std::string>{"X", "Y", "Z"} : std::vector<std::string>{"R", "G", "B"};
  ChartFilm read{read_patches(scene, scene.charts.front(), film, channels), {}};
  for (const PatchReading& patch : read.patches) {
    const XYZ values{patch.mean[0], patch.mean[1], patch.mean[2]};
    read.xyz.push_back(observer ? values : multiply(rgb_to_xyz(kRec709), values));
  }
  return read;
}

double sum_of_y(const std::vector<XYZ>& colors) {
  return std::accumulate(colors.begin(), colors.end(), 0.0,
                         [](double sum, const XYZ& xyz) { return sum + xyz[1]; });
}

Lab scaled_lab(XYZ xyz, double factor, const XYZ& white) {
  for (double& v : xyz) v *= factor;
  return xyz_to_lab(xyz, white);
}

}  // namespace

std::vector<PatchDifference> compare_chart(const Scene& scene, const Image& image, const Image* reference,
                                           DeltaE formula) {
  if (scene.charts.empty()) throw Error(ErrorCode::input, "", "the scene has no chart");
  if (scene.lights.empty()) throw Error(ErrorCode::input, "", "the scene has no light for its chart");
  const Curve& light = scene.lights.front().emission;
  const XYZ white = tristimulus(light, Curve(1), Observer::cie1931);
  const ChartFilm film = read_film(scene, image);
  std::vector<XYZ> integrated;
  for (const PatchReading& patch : film.patches)
    integrated.push_back(tristimulus(light, *patch.reflectance, Observer::cie1931));
  const std::vector<XYZ> other = reference != nullptr ? read_film(scene, *reference).xyz : integrated;
  const double factor = sum_of_y(integrated) / sum_of_y(reference != nullptr ? other : film.xyz);
  std::vector<PatchDifference> differences;
  for (std::size_t i = 0; i < film.patches.size(); ++i) {
    const Lab wanted = scaled_lab(other[i], reference != nullptr ? factor : 1, white);
    const Lab found = scaled_lab(film.xyz[i], factor, white);
    differences.push_back(
        {film.patches[i].name, film.patches[i].pixels, wanted, found, delta_e(formula, wanted, found)});
  }
  return differences;
}

}  // namespace abbe
