#include "calibration/metrics/camera_quality.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "io/error.h"
#include "io/table.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"

namespace abbe {
namespace {

constexpr std::size_t kChromaticPatches = 18;  // the first three rows of the ColorChecker

template <typename T>
T shipped(std::optional<T> value, const std::string& name, const Diagnostics& diagnostics) {
  if (!value) throw Error(diagnostics.code(), name, diagnostics.text());
  return *std::move(value);
}

// Chart and light of the sensitivity index.
const std::pair<Chart, Curve>& index_setting() {
  static const std::pair<Chart, Curve> setting = [] {
    Diagnostics diagnostics;
    std::pair made{shipped_chart("colorchecker24_iso17321-1"),
                   shipped(load_illuminant("D55", {}, diagnostics), "D55", diagnostics).curve};
    made.first.patches.resize(kChromaticPatches);
    return made;
  }();
  return setting;
}

CameraQuality quality(const std::string& name, const std::vector<Channel>& channels, const Chart& chart,
                      const Curve& light) {
  const PatchColors colors = integrate(chart, channels, light);
  const std::size_t patches = colors.raw.size();
  CorrectionFit matrix = fit_correction(colors);
  CorrectionOptions root;
  root.model = CorrectionModel::root_polynomial_2;
  require_enough_patches(root.model, patches);
  return {name,
          std::move(matrix.start),
          std::move(matrix.errors),
          cross_validate(colors, {}, patches),
          fit_correction(colors, root).errors,
          cross_validate(colors, root, patches),
          sensitivity_index(channels)};
}

using Samples1nm = std::vector<double>;

Samples1nm sampled(const Curve& curve) {
  Samples1nm samples;
  for (int nm = SumRange{}.low_nm; nm <= SumRange{}.high_nm; ++nm) samples.push_back(curve(nm));
  return samples;
}

double dot(const Samples1nm& a, const Samples1nm& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

// Orthonormal basis of the space of the curves, by Gram-Schmidt with two passes per step against rounding.
std::vector<Samples1nm> basis_of(std::vector<Samples1nm> curves) {
  constexpr double kDependent = 1e-10;
  std::vector<Samples1nm> basis;
  for (Samples1nm& curve : curves) {
    const double whole = std::sqrt(dot(curve, curve));
    for (int pass = 0; pass < 2; ++pass)
      for (const Samples1nm& e : basis) {
        const double along = dot(curve, e);
        for (std::size_t i = 0; i < curve.size(); ++i) curve[i] -= along * e[i];
      }
    const double rest = std::sqrt(dot(curve, curve));
    if (!(rest > kDependent * whole)) continue;
    for (double& v : curve) v /= rest;
    basis.push_back(std::move(curve));
  }
  return basis;
}

double squared_projection(const Samples1nm& vector, const std::vector<Samples1nm>& basis) {
  double total = 0;
  for (const Samples1nm& e : basis) total += dot(vector, e) * dot(vector, e);
  return total;
}

}  // namespace

std::vector<CameraQuality> all_camera_qualities(const Chart& chart, const Curve& light) {
  std::vector<CameraQuality> all;
  for (const std::string& name : table_names("camera")) {
    if (name.find(':') != std::string::npos) continue;
    Diagnostics diagnostics;
    const std::vector<Channel> channels = shipped(load_camera(name, {}, diagnostics), name, diagnostics);
    if (channels.size() == 3) all.push_back(quality(name, channels, chart, light));
  }
  return all;
}

double sensitivity_index(const std::vector<Channel>& channels) {
  CorrectionOptions options;
  options.objective = Objective::delta_e_76;
  const auto& [chart, light] = index_setting();
  return 100 - 5.5 * fit_correction(integrate(chart, channels, light), options).errors.mean_76;
}

// The Vora value is the sum over an orthonormal basis e_i of the observer of |P e_i|^2/3, where P projects
// on the channels. The residual of a function f is (1 - |P f|^2/|f|^2)^(1/2).
CameraSpace camera_space(std::span<const Channel> channels) {
  if (channels.size() < 3)
    throw Error(ErrorCode::usage, "camera", "the Vora value and the Luther condition need three channels");
  std::vector<Samples1nm> responses;
  for (const Channel& channel : channels) responses.push_back(sampled(channel.weight));
  const std::vector<Samples1nm> camera = basis_of(std::move(responses));
  const ColorMatching& cmf = color_matching(Observer::cie1931);
  const std::vector<Samples1nm> observer{sampled(cmf.x), sampled(cmf.y), sampled(cmf.z)};
  CameraSpace result;
  for (const Samples1nm& e : basis_of(observer)) result.vora += squared_projection(e, camera) / 3;
  for (std::size_t i = 0; i < 3; ++i)
    result.luther[i] =
        std::sqrt(std::max(0.0, 1 - squared_projection(observer[i], camera) / dot(observer[i], observer[i])));
  return result;
}

}  // namespace abbe
