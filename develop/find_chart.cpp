#include "develop/find_chart.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "develop/linear_image.h"
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

constexpr double kOutlineFraction = 0.6;  // of a cell's edge: 0.7 of a patch that takes 0.86 of its cell

using Corners = std::array<Imath::V2d, 4>;

void require_convex(const Corners& corners) {
  int left = 0;
  int right = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Imath::V2d& corner = corners[(i + 1) % 4];
    const double turn = (corner - corners[i]).cross(corners[(i + 2) % 4] - corner);
    left += turn > 0 ? 1 : 0;
    right += turn < 0 ? 1 : 0;
  }
  if (right == 4)
    throw Error(ErrorCode::usage, "--corners",
                "these corners show the chart mirrored: give them clockwise in the picture, from the first "
                "patch along its row");
  if (left != 4)
    throw Error(ErrorCode::usage, "--corners",
                "expected the corners of a convex quadrilateral, in order around it");
}

/// The projective map from the unit square to a quadrilateral.
class Perspective {
 public:
  explicit Perspective(const Corners& p) : origin_(p[0]) {
    const Imath::V2d d1 = p[1] - p[2];
    const Imath::V2d d2 = p[3] - p[2];
    const Imath::V2d sum = p[0] - p[1] + p[2] - p[3];
    g_ = sum.cross(d2) / d1.cross(d2);
    h_ = d1.cross(sum) / d1.cross(d2);
    u_ = p[1] - p[0] + p[1] * g_;
    v_ = p[3] - p[0] + p[3] * h_;
  }
  [[nodiscard]] Imath::V2d operator()(double u, double v) const {
    return (u_ * u + v_ * v + origin_) / (g_ * u + h_ * v + 1);
  }

 private:
  Imath::V2d origin_, u_, v_;
  double g_, h_;
};

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

std::vector<PatchOutline> outlines_between(const Corners& corners, std::span<const std::string> names,
                                           std::size_t columns) {
  require_convex(corners);
  if (names.size() % columns != 0)
    throw Error(
        ErrorCode::usage, "--columns",
        fmt::format("got {}, which does not divide the chart's {} patches into rows", columns, names.size()));
  const Perspective at(corners);
  const auto rows = static_cast<double>((names.size() + columns - 1) / columns);
  const auto across = static_cast<double>(columns);
  std::vector<PatchOutline> outlines;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double u = static_cast<double>(i % columns) + 0.5;
    const double v = static_cast<double>(i / columns) + 0.5;
    const double half = kOutlineFraction / 2;
    const auto corner = [&](double du, double dv) { return at((u + du) / across, (v + dv) / rows); };
    outlines.push_back(
        {names[i], {corner(-half, -half), corner(half, -half), corner(half, half), corner(-half, half)}});
  }
  return outlines;
}

}  // namespace abbe
