#include <algorithm>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

Json table(Random& random, double max_value) {
  Json wavelengths = Json::array();
  Json values = Json::array();
  double nm = uniform(random, 300, 500);
  for (int i = integer(random, 2, 12); i > 0; --i) {
    wavelengths.push_back(nm);
    values.push_back(chance(random, 0.2) ? 0.0 : uniform(random, 0, max_value));
    nm += decades(random, 1e-3, 100);
  }
  return {
      {"table",
       {{"wavelength_nm", wavelengths}, {"values", values}, {"outside", one_of(random, {"clamp", "zero"})}}}};
}

Json band(Random& random, double max_value) {
  const double low = uniform(random, 300, 900);
  return {{"band", {low, std::min(1100.0, low + decades(random, 1e-3, 300))}},
          {"value", uniform(random, 0.1, 1) * max_value}};
}

Json gaussian(Random& random, double max_value) {
  return {{"gaussian",
           {{"center_nm", uniform(random, 380, 800)},
            {"fwhm_nm", decades(random, 1e-2, 300)},
            {"peak", uniform(random, 0.1, 1) * max_value}}}};
}

}  // namespace

Json draw_curve(Drawing& drawing, double max_value) {
  Random& random = drawing.random;
  switch (integer(random, 0, 6)) {
    case 0:
      return table(random, max_value);
    case 1:
      return band(random, max_value);
    case 2:
      return gaussian(random, max_value);
    case 3:
      return {{"product", {band(random, 1), gaussian(random, max_value)}}};
    case 4:
      return {{"sum", {table(random, max_value / 2), {{"scale", 0.5}, {"of", band(random, max_value)}}}}};
    default:
      return uniform(random, 0, max_value);
  }
}

Json draw_reflectance(Drawing& drawing, bool& varies) {
  Random& random = drawing.random;
  const int kind = integer(random, 0, 9);
  if (kind == 0) return one_of(random, {0, 1});
  if (kind <= 3) return "cornell_box_walls:" + std::string(one_of(random, {"red", "green", "white"}));
  if (kind >= 6) return draw_curve(drawing, 1);
  varies = true;
  Json texture{{"image", draw_image(drawing, {"R", "G", "B"}, 0, 1)}};
  if (kind == 4)
    texture["rgb"] = true;
  else
    texture["weights"] = {{"R", draw_curve(drawing, 0.5)}, {"B", draw_curve(drawing, 0.5)}};
  texture["filter"] = one_of(random, {"bilinear", "nearest"});
  texture["wrap"] = one_of(random, {"repeat", "clamp"});
  texture["scale"] = {decades(random, 0.01, 100), -decades(random, 0.01, 100)};
  texture["offset"] = {uniform(random, -9, 9), uniform(random, -9, 9)};
  return texture;
}

Json draw_direction(Drawing& drawing) {
  Random& random = drawing.random;
  Json direction = Json::array();
  const double length = decades(random, 1e-3, 1e3);
  for (int axis = 0; axis < 3; ++axis) direction.push_back(length * uniform(random, -1, 1));
  // Directions along an axis exercise special cases of frames and slabs.
  if (chance(random, 0.2)) direction[static_cast<std::size_t>(integer(random, 0, 1))] = 0;
  if (chance(random, 0.1)) direction = {0, 0, -length};
  return direction;
}

Json draw_position(Drawing& drawing, double extent) {
  Json position = Json::array();
  for (const double center : drawing.center)
    position.push_back(center + drawing.size * extent * uniform(drawing.random, -1, 1));
  return position;
}

}  // namespace abbe::soak
