#include "calibration/output/white_clip.h"

#include <algorithm>
#include <limits>

#include "spectral/rgb.h"

namespace abbe {

std::optional<std::array<double, 3>> brightest_neutral(const Matrix3& to_xyz_d65,
                                                       const std::vector<double>& saturation) {
  std::array<double, 3> neutral = multiply(to_xyz_d65.inverse(true), unit_xyz(kD65));
  double brightest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < neutral.size(); ++k) {
    if (!(neutral[k] > 0 && saturation[k] > 0)) return std::nullopt;
    brightest = std::min(brightest, saturation[k] / neutral[k]);
  }
  for (double& value : neutral) value *= brightest;
  return neutral;
}

void clip_to_white(Image& planes, const std::vector<std::string>& channels, const Matrix3& to_xyz_d65,
                   const std::vector<double>& saturation) {
  const auto white = brightest_neutral(to_xyz_d65, saturation);
  if (!white) return;
  for (ImageChannel& channel : planes.channels) {
    const auto found = std::find(channels.begin(), channels.end(), channel.name);
    if (found == channels.end()) continue;
    const auto highest = static_cast<float>((*white)[static_cast<std::size_t>(found - channels.begin())]);
    for (float& value : channel.values) value = std::min(value, highest);
  }
}

}  // namespace abbe
