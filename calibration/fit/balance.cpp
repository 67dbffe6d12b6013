#include "calibration/fit/balance.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "calibration/fit/correction_fit.h"
#include "io/diagnostics.h"
#include "io/error.h"
#include "sensor/film/patch.h"

namespace abbe {
namespace {

constexpr const char* kDiffuser = "perfect diffuser";
constexpr double kNeutralChroma = 5;

std::optional<std::size_t> find(const MeasuredPatches& measured, const std::string& name) {
  const auto found = std::find(measured.names.begin(), measured.names.end(), name);
  if (found == measured.names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - measured.names.begin());
}

// Throws Error{input} for a patch that the chart does not have. With a misspelt name it would count for
// nothing.
void require_known(const ChartTargets& chart, const MeasuredPatches& measured) {
  std::vector<std::string> known = chart.names;
  known.emplace_back(kDiffuser);
  for (const std::string& name : measured.names)
    if (std::find(known.begin(), known.end(), name) == known.end())
      throw Error(ErrorCode::input, "measured patches", unknown_name("patch", name, known));
}

// Measured patches in the order of the chart, without saturated ones.
BalancedPatches in_order(const ChartTargets& chart, const MeasuredPatches& measured) {
  BalancedPatches patches{{{}, {}, {}, chart.white}, {}};
  std::vector<std::string> missing;
  for (std::size_t c = 0; c < chart.names.size(); ++c) {
    const std::string& name = chart.names[c];
    const auto i = find(measured, name);
    if (!i) missing.push_back(name);
    if (!i || measured.saturated.contains(name)) continue;
    patches.colors.names.push_back(name);
    patches.colors.xyz.push_back(chart.xyz[c]);
    patches.colors.raw.push_back(measured.values[*i]);
    if (!measured.deviations.empty()) patches.deviations.push_back(measured.deviations[*i]);
  }
  if (!missing.empty())
    throw Error(ErrorCode::input, "measured patches", fmt::format("missing: {}", fmt::join(missing, ", ")));
  const std::size_t remaining = patches.colors.names.size();
  if (2 * remaining < chart.names.size())
    throw Error(
        ErrorCode::input, "measured patches",
        fmt::format("{} of {} have saturated pixels: expose less, or show the chart on more pixels where "
                    "defective ones exceed {:g} % of a patch",
                    chart.names.size() - remaining, chart.names.size(), 100 * kMaxDefectiveFraction));
  return patches;
}

// Matrix from XYZ to the camera's values with the least error; empty if the patches do not determine it.
std::optional<Matrix3> to_camera(const PatchColors& colors) {
  try {
    const Matrix3 to_xyz = least_squares_matrix(colors);
    if (is_invertible(to_xyz)) return to_xyz.inverse(true);
  } catch (const Error&) {
    // Too few colours.
  }
  return std::nullopt;
}

bool is_neutral(const XYZ& xyz, const XYZ& white) {
  const Lab lab = xyz_to_lab(xyz, white);
  return std::hypot(lab[1], lab[2]) < kNeutralChroma;
}

// Values of the perfect diffuser from the neutral patches; not finite if there are none.
Raw diffuser_by_neutrals(const PatchColors& colors) {
  const std::optional<Matrix3> camera = to_camera(colors);
  Raw sum{};
  double weight = 0;
  for (std::size_t i = 0; i < colors.xyz.size(); ++i) {
    const double y = colors.xyz[i][1];
    if (!(y > 0 && is_neutral(colors.xyz[i], colors.white))) continue;  // black patches carry no information
    const Raw grey = camera ? multiply(*camera, colors.white) : Raw{1, 1, 1};
    const Raw tinged = camera ? multiply(*camera, colors.xyz[i]) : Raw{y, y, y};
    for (std::size_t k = 0; k < 3; ++k) sum[k] += colors.raw[i][k] * y * (y * grey[k] / tinged[k]);
    weight += y * y;
  }
  for (double& v : sum) v /= weight;
  return sum;
}

}  // namespace

BalancedPatches balance(const ChartTargets& chart, const MeasuredPatches& measured) {
  require_known(chart, measured);
  BalancedPatches balanced = in_order(chart, measured);
  const auto diffuser = measured.saturated.contains(kDiffuser) ? std::nullopt : find(measured, kDiffuser);
  const Raw white = diffuser ? measured.values[*diffuser] : diffuser_by_neutrals(balanced.colors);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(std::isfinite(white[k]) && white[k] > 0))
      throw Error(
          ErrorCode::input, "measured patches",
          fmt::format("nothing to balance white on: neither a row \"{}\" nor neutral patches", kDiffuser));
    balanced.gains[k] = 1 / white[k];
    for (Raw& raw : balanced.colors.raw) raw[k] /= white[k];
    for (Raw& deviation : balanced.deviations) deviation[k] /= white[k];
  }
  return balanced;
}

}  // namespace abbe
