#include "calibration/characterisation.h"

#include "io/error.h"
#include "io/table.h"
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
struct IndexSetting {
  Chart chart;
  Curve light;
};

const IndexSetting& index_setting() {
  static const IndexSetting setting = [] {
    Diagnostics diagnostics;
    IndexSetting made{shipped_chart("colorchecker24_iso17321-1"),
                      shipped(load_illuminant("D55", {}, diagnostics), "D55", diagnostics).curve};
    made.chart.patches.resize(kChromaticPatches);
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

}  // namespace abbe
