#include <algorithm>
#include <array>
#include <vector>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

// While the shutter of some row may be open, or before and after.
double moment(Drawing& drawing) {
  return drawing.opens_s + drawing.exposure_s * uniform(drawing.random, -1, 3);
}

}  // namespace

void let_move(Drawing& drawing, Json& what) {
  Random& random = drawing.random;
  if (!drawing.moves || !chance(random, 0.4)) return;
  std::vector<double> times;
  for (int i = integer(random, 1, 3); i > 0; --i) times.push_back(moment(drawing));
  std::sort(times.begin(), times.end());
  // Rotations are about the origin, from which the box is far unless it is around it.
  const bool turns = drawing.middle == std::array<double, 3>{0, 0, 0} && chance(random, 0.5);
  const Json axis = draw_direction(drawing);
  for (const double time : times) {
    Json keyframe{{"time_s", time}};
    if (turns) keyframe["rotate"] = {{"axis", axis}, {"deg", uniform(random, -20, 20)}};
    Json away = Json::array();
    for (int i = 0; i < 3; ++i) away.push_back(drawing.size * decades(random, 1e-6, 0.05));
    keyframe["translate"] = away;
    what["motion"]["keyframes"].push_back(keyframe);
  }
}

}  // namespace abbe::soak
