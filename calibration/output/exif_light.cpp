#include "calibration/output/exif_light.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "calibration/output/color_spaces.h"
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

// Chromaticity of an illuminant by its name; empty for an unknown one.
std::optional<Chromaticity> chromaticity_of(const std::string& name) {
  Diagnostics ignored;
  const auto light = load_illuminant(name, {}, ignored);
  return light ? std::optional(chromaticity(light->curve)) : std::nullopt;
}

// Class of a fluorescent light by its colour temperature.
int fluorescent_code(const Chromaticity& white) {
  const auto temperature = color_temperature(unit_xyz(white));
  if (!temperature || temperature->kelvin > kMaxKelvin) return kOther;
  for (const FluorescentClass& fluorescent : kFluorescent)
    if (temperature->kelvin >= fluorescent.min_kelvin) return fluorescent.number;
  return kOther;
}

}  // namespace

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

}  // namespace abbe
