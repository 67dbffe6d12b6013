#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/picture.h"
#include "spectral/colorimetry.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"

// A scene in warm light, and the white that films of it record.

namespace abbe::test {

inline constexpr const char* kObserver = R"("observer": "1931")";
inline constexpr const char* kWideObserver = R"("observer": "1964")";
inline constexpr const char* kNikon = R"("camera": "Nikon_D5100")";
inline constexpr const char* kSpectral = R"("spectral": {"from_nm": 380, "to_nm": 780, "step_nm": 5})";

// A white dome in the background. A lamp with little power precedes it in the list of lights.
inline std::string lit_dome(const std::string& name, const std::string& sensor, const std::string& white = "",
                            const std::string& dome = "A") {
  return scratch()
      .write(name, fmt::format(R"({{"abbe": 1, "camera": {{"pinhole": {{"fov_deg": 40, "f_number": 8}},
        "from": [0, 0, 0], "to": [0, 0, 1], "up": [0, 1, 0]}},
        "sensor": {{"resolution": [24, 16], {}}},
        "materials": {{"grey": {{"diffuse": {{"reflectance": 0.5}}}}}},
        "lights": [{{"name": "faint", "point": {{"at": [0, 0, 1]}},
                     "emission": {{"illuminant": "D65", "luminous_intensity": 0.001}}}},
                   {{"name": "dome", "environment": {{}}, "emission": {{"illuminant": "{}", "luminance": 100}}}}],
        "shapes": [{{"sphere": {{"center": [0, 0, 5], "radius": 1}}, "material": "grey"}}],
        "render": {{"samples": 64}}, "output": {{{}}}}})",
                               sensor, dome, white.empty() ? "" : "\"white\": " + white))
      .string();
}

// Means of the code values of a picture, or of channels.
inline std::array<double, 3> means(const Image& picture) {
  std::array<double, 3> mean{};
  for (std::size_t k = 0; k < 3; ++k)
    for (const float v : picture.find(std::string(1, "RGB"[k]))->values)
      mean[k] += static_cast<double>(v) / static_cast<double>(picture.pixels());
  return mean;
}
// Ratio of red to blue.
inline double warmth(const std::string& picture) {
  const auto [r, g, b] = means(read_picture(picture));
  return r - b;
}

inline void expect_xy(const std::map<std::string, std::string>& metadata, const Chromaticity& xy,
                      double bound) {
  const std::string& told = metadata.at("white_xy");
  EXPECT_NEAR(std::stod(told), xy[0], bound) << told;
  EXPECT_NEAR(std::stod(told.substr(told.find(' '))), xy[1], bound) << told;
}

}  // namespace abbe::test
