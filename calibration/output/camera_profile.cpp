#include "calibration/output/camera_profile.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "calibration/output/color_spaces.h"
#include "io/image.h"
#include "io/table.h"
#include "spectral/color_temperature.h"
#include "spectral/curve_use.h"
#include "spectral/library.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

constexpr int kOther = 255;
constexpr const char* kCie = "cie_";  // prefix of the names of the CIE's tables
constexpr std::array<std::pair<std::string_view, int>, 7> kStandard{
    {{"A", 17}, {"B", 18}, {"C", 19}, {"D55", 20}, {"D65", 21}, {"D75", 22}, {"D50", 23}}};

// Classes of fluorescent light in Exif, down to these temperatures: daylight, day white, cool white, white
// and warm white.
struct FluorescentClass {
  double min_kelvin;
  int number;
};
constexpr std::array<FluorescentClass, 5> kFluorescent{
    {{5700, 12}, {4600, 13}, {3800, 14}, {3250, 15}, {2600, 16}}};
constexpr double kMaxKelvin = 7100;

std::optional<Chromaticity> chromaticity_of(const std::string& name) {
  Diagnostics ignored;
  const auto light = load_illuminant(name, {}, ignored);
  return light ? std::optional(chromaticity(light->curve)) : std::nullopt;
}

int fluorescent_code(const Chromaticity& white) {
  const auto temperature = color_temperature(unit_xyz(white));
  if (!temperature || temperature->kelvin > kMaxKelvin) return kOther;
  for (const FluorescentClass& fluorescent : kFluorescent)
    if (temperature->kelvin >= fluorescent.min_kelvin) return fluorescent.number;
  return kOther;
}

}  // namespace

// ColorMatrix is the scaled inverse of `to_xyz`. ForwardMatrix undoes the balance, applies `to_xyz` and
// adapts the white to D50.
std::optional<DngMatrices> dng_matrices(const Matrix3& to_xyz, const XYZ& white) {
  const auto to_d50 = adaptation(white, dng_white());
  if (!to_d50 || !is_invertible(to_xyz)) return std::nullopt;
  Matrix3 color = to_xyz.inverse(true);
  const std::array<double, 3> camera_white = multiply(color, white);
  const auto [lowest, highest] = std::minmax_element(camera_white.begin(), camera_white.end());
  if (*lowest <= 0) return std::nullopt;
  color *= 1 / *highest;
  return DngMatrices{color, *to_d50 * to_xyz * diagonal(camera_white), multiply(color, white)};
}

std::optional<DngLight> dng_light(const CameraProfile& profile, const XYZ& white) {
  const auto temperature = color_temperature(white);
  if (profile.correction.model != CorrectionModel::linear || !temperature) return std::nullopt;
  const auto matrices = dng_matrices(linear_part(profile.correction) * diagonal(profile.gains), white);
  if (!matrices) return std::nullopt;
  return DngLight{profile.light, exif_light_source(profile.light), temperature->kelvin, matrices->color,
                  matrices->forward};
}

RawLight light_for(std::span<const std::string> channels, const RawLight& light) {
  RawLight ordered = light;
  const auto order = rgb_order(channels);
  for (std::size_t k = 0; order && k < 3; ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      ordered.color[3 * (*order)[k] + i] = light.color[3 * k + i];
      ordered.forward[3 * i + (*order)[k]] = light.forward[3 * i + k];
    }
  return ordered;
}

// The weight of the first matrix is (1/T - 1/T_2)/(1/T_1 - 1/T_2).
Matrix3 forward_between(const DngLight& first, const DngLight& second, double kelvin) {
  const double span = 1 / first.kelvin - 1 / second.kelvin;
  const double weight = span == 0 ? 1 : std::clamp((1 / kelvin - 1 / second.kelvin) / span, 0.0, 1.0);
  return first.forward * weight + second.forward * (1 - weight);
}

int exif_light_source(const std::string& name) {
  if (user_table_end(name) != std::string::npos) return kOther;
  Diagnostics ignored;
  const auto found = find_table(kIlluminantUse.folder, name, {}, ignored);
  const std::string table = found ? found->path.stem().string() : "";
  for (const auto& [standard, number] : kStandard)
    if (table == kCie + std::string(standard)) return number;
  const auto white = table.starts_with(kCie + std::string("FL")) ? chromaticity_of(name) : std::nullopt;
  return white ? fluorescent_code(*white) : kOther;
}

int exif_light_source(const Chromaticity& white) {
  constexpr int kFluorescentCount = 12;
  const auto is_of = [&](const std::string& name) {
    const auto xy = chromaticity_of(name);
    return xy && is_same_white(*xy, white);
  };
  for (const auto& [name, number] : kStandard)
    if (is_of(std::string(name))) return number;
  for (int i = 1; i <= kFluorescentCount; ++i)
    if (const std::string name = "FL" + std::to_string(i); is_of(name)) return exif_light_source(name);
  return kOther;
}

std::string sensitivities_json(const std::string& camera, std::span<const Channel> channels) {
  constexpr int kStep = 5;
  constexpr SumRange kRange = kVisibleRange;  // the range that those programs expect
  double greatest = 0;
  for (const Channel& channel : channels)
    for (int nm = kRange.low_nm; nm <= kRange.high_nm; nm += kStep)
      greatest = std::max(greatest, channel.weight(nm));
  nlohmann::ordered_json file;
  file["header"] = {{"schema_version", "1.0.0"},
                    {"manufacturer", ""},
                    {"model", camera},
                    {"description", "energy responses, the greatest of all being 1"},
                    {"license", ""}};
  auto& data = file["spectral_data"];
  data["units"] = "relative";
  for (const Channel& channel : channels) data["index"]["main"].push_back(channel.name);
  for (int nm = kRange.low_nm; nm <= kRange.high_nm; nm += kStep)
    for (const Channel& channel : channels)
      data["data"]["main"][std::to_string(nm)].push_back(channel.weight(nm) / greatest);
  return file.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace abbe
