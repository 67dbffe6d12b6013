#include "calibration/chart/chart_corners.h"

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {
namespace {

constexpr double kOutlineFraction = 0.6;  // of a cell's edge: 0.7 of a patch that takes 0.86 of its cell

using Corners = std::array<Imath::V2d, 4>;

void require_convex(const Corners& corners) {
  int left = 0;
  int right = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double turn =
        (corners[(i + 1) % 4] - corners[i]).cross(corners[(i + 2) % 4] - corners[(i + 1) % 4]);
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
