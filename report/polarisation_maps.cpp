#include "report/polarisation_maps.h"

#include "report/color_map.h"

namespace abbe {
namespace {

Image degrees(const std::vector<PolarisationFigures>& pixels, double PolarisationFigures::*degree, int width,
              int height) {
  std::vector<double> values;
  values.reserve(pixels.size());
  for (const PolarisationFigures& pixel : pixels) values.push_back(pixel.*degree);
  return false_color(values, width, height, 0, 1);
}

Image angles(const std::vector<PolarisationFigures>& pixels, int width, int height) {
  Image image{width, height, {{"R", {}}, {"G", {}}, {"B", {}}}, {}};
  for (const PolarisationFigures& pixel : pixels) {
    const DisplayColor color = cyclic_color(pixel.angle_deg / 180, pixel.linear_degree);
    for (std::size_t c = 0; c < 3; ++c) image.channels[c].values.push_back(static_cast<float>(color[c]));
  }
  return image;
}

}  // namespace

std::vector<PolarisationMap> polarisation_maps(const std::vector<PolarisationFigures>& pixels,
                                               MeasuredStokes measured, int width, int height) {
  std::vector<PolarisationMap> maps;
  if (measured == MeasuredStokes::all)
    maps.push_back({kDegreeMap, degrees(pixels, &PolarisationFigures::degree, width, height)});
  maps.push_back({kLinearDegreeMap, degrees(pixels, &PolarisationFigures::linear_degree, width, height)});
  maps.push_back({kAngleMap, angles(pixels, width, height)});
  return maps;
}

}  // namespace abbe
