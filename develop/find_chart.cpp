#include "develop/find_chart.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "develop/chart_finder.h"
#include "io/error.h"
#include "io/module.h"
#include "sensor/readout/demosaic.h"

namespace abbe {
namespace {

const ChartFinder& chart_finder() {
  static const ChartFinder& finder = module_functions<ChartFinder>(
      ABBE_CHART_MODULE, kChartFinderSymbol, ModuleScope::own,
      "--corners find: the chart detector, which is part of Abbe if it was built with OpenCV,");
  return finder;
}

using Planes = std::array<const ImageChannel*, 3>;  // to use as red, green and blue

// Possible assignments of the image's channels to red, green and blue.
std::vector<Planes> rgb_assignments(const Image& image) {
  for (const auto& [r, g, b] : {std::array{"R", "G", "B"}, std::array{"X", "Y", "Z"}})
    if (image.find(r) != nullptr && image.find(g) != nullptr && image.find(b) != nullptr)
      return {{image.find(r), image.find(g), image.find(b)}};
  const auto& all = image.channels;
  const Planes rainbow{&all.front(), &all[all.size() / 2], &all.back()};
  if (all.size() == 1) return {rainbow};
  return {rainbow, {rainbow[2], rainbow[1], rainbow[0]}};
}

// The value that 1 % of the pixels exceed: the white of a chart, or of brighter surroundings.
float white_of(std::vector<float> values) {
  const auto white = values.end() - 1 - static_cast<std::ptrdiff_t>(values.size() / 100);
  std::nth_element(values.begin(), white, values.end());
  return *white;
}

// Scales each channel to its white and applies the gamma of a display.
ByteImage picture_of(const Image& image, const Planes& planes) {
  constexpr float kDisplayGamma = 2.2F;
  ByteImage picture{image.width, image.height, std::vector<std::array<std::uint8_t, 3>>(image.pixels())};
  for (std::size_t k = 0; k < 3; ++k) {
    const std::vector<float>& values = planes[k]->values;
    const float white = white_of(values);
    if (!(white > 0)) continue;
    for (std::size_t i = 0; i < values.size(); ++i)
      picture.pixels[i][k] = static_cast<std::uint8_t>(
          std::lround(255 * std::pow(std::clamp(values[i] / white, 0.0F, 1.0F), 1 / kDisplayGamma)));
  }
  return picture;
}

}  // namespace

std::array<Imath::V2d, 4> find_chart(const LinearImage& image) {
  const Image planes =
      image.mosaic ? demosaic(image.image, image.image.channels.front().name, *image.mosaic, image.channels)
                   : image.image;
  std::optional<FoundChart> best;
  for (const Planes& assignment : rgb_assignments(planes)) {
    const auto found = chart_finder().find(picture_of(planes, assignment));
    if (found && (!best || found->misfit < best->misfit)) best = found;
  }
  if (!best)
    throw Error(
        ErrorCode::input, "",
        "no ColorChecker was found: the picture must show all of it, in focus, with the frame between its "
        "patches; otherwise give --corners X,Y,X,Y,X,Y,X,Y");
  return best->corners;
}

}  // namespace abbe
