#include <algorithm>
#include <array>
#include <vector>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

// A time during the exposure of some row, or before or after it.
double keyframe_time(Drawing& drawing) {
  return drawing.open_s + drawing.exposure_s * uniform(drawing.random, -1, 3);
}

}  // namespace

void maybe_animate(Drawing& drawing, Json& object) {
  Random& random = drawing.random;
  if (!drawing.moves || !chance(random, 0.4)) return;
  std::vector<double> times;
  for (int i = integer(random, 1, 3); i > 0; --i) times.push_back(keyframe_time(drawing));
  std::sort(times.begin(), times.end());
  // Rotations are about the origin. Only a box around the origin stays near its position.
  const bool turns = drawing.center == std::array<double, 3>{0, 0, 0} && chance(random, 0.5);
  const Json axis = draw_direction(drawing);
  for (const double time : times) {
    Json keyframe{{"time_s", time}};
    if (turns) keyframe["rotate"] = {{"axis", axis}, {"deg", uniform(random, -20, 20)}};
    Json offset = Json::array();
    for (int i = 0; i < 3; ++i) offset.push_back(drawing.size * decades(random, 1e-6, 0.05));
    keyframe["translate"] = offset;
    object["motion"]["keyframes"].push_back(keyframe);
  }
}

}  // namespace abbe::soak
