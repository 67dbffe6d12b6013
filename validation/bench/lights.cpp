#include "validation/bench/lights.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace abbe {
namespace {

// Fractional part of i times an irrational number: a sequence of low discrepancy in [0, 1).
double fractional_part(int i, double number) {
  const double turns = i * number;
  return turns - std::floor(turns);
}

}  // namespace

std::string make_lights(int rows) {
  constexpr std::array<const char*, 3> kSpectra{"A", "D65", "FL11"};
  const double step = 38.0 / rows;
  std::string lights;
  for (int i = 0; i < rows * rows; ++i) {
    const int row = i / rows;
    const double x = -19 + step * (i % rows + fractional_part(i, 0.6180339887));
    const double y = 5.9 - 2 * fractional_part(i, 0.7548776662);
    const double z = -19 + step * (row + fractional_part(i, 0.5698402910));
    const double strength = std::pow(30, fractional_part(i, 0.4142135624));
    const std::string shape =
        i % 8 == 0 ? fmt::format(
                         R"("spot": {{"at": [{}, {}, {}], "direction": [{}, -1, {}], "half_angle_deg": 30}})",
                         x, y, z, fractional_part(i, 0.3) - 0.5, fractional_part(i, 0.7) - 0.5)
        : i % 8 == 4
            ? fmt::format(R"("sphere": {{"center": [{}, {}, {}], "radius": 0.01}})", x, y, z)
            : fmt::format(
                  R"("quad": {{"corner": [{}, {}, {}], "edge_u": [0.02, 0, 0], "edge_v": [0, 0, 0.02]}})", x,
                  y, z);
    lights += fmt::format(R"({}{{{}, "emission": {{"illuminant": "{}", "luminous_flux_lm": {}}}}})",
                          i == 0 ? "" : ",", shape, kSpectra[static_cast<std::size_t>(i % 3)], strength);
  }
  return "[" + lights + "]";
}

}  // namespace abbe
