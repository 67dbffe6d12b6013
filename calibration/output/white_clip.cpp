#include "calibration/output/white_clip.h"

#include <algorithm>
#include <limits>

#include "spectral/rgb.h"

namespace abbe {

void clip_to_white(Image& planes, const std::vector<std::string>& channels, const Matrix3& to_xyz_d65,
                   const std::vector<double>& saturation) {
  const std::array<double, 3> neutral = multiply(to_xyz_d65.inverse(true), unit_xyz(kD65));
  double brightest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < neutral.size(); ++k) {
    if (!(neutral[k] > 0 && saturation[k] > 0)) return;
    brightest = std::min(brightest, saturation[k] / neutral[k]);
  }
  for (ImageChannel& channel : planes.channels) {
    const auto found = std::find(channels.begin(), channels.end(), channel.name);
    if (found == channels.end()) continue;
    const auto highest =
        static_cast<float>(brightest * neutral[static_cast<std::size_t>(found - channels.begin())]);
    for (float& value : channel.values) value = std::min(value, highest);
  }
}

}  // namespace abbe
