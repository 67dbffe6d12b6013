#include <algorithm>
#include <cmath>
#include <numbers>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

Json cross(const Json& a, const Json& b) {
  const auto x = [](const Json& v, std::size_t i) { return v[i % 3].get<double>(); };
  Json c = Json::array();
  for (std::size_t i = 0; i < 3; ++i) c.push_back(x(a, i + 1) * x(b, i + 2) - x(a, i + 2) * x(b, i + 1));
  return c;
}

Json probe(Drawing& drawing) {
  Random& random = drawing.random;
  const Json at = draw_position(drawing, 0.6);
  const double radius = drawing.size * decades(random, 1e-4, 0.2);
  switch (integer(random, 0, 4)) {
    case 0:
    case 1:
      return {{"at", at}, {"normal", draw_direction(drawing)}};
    case 2:
      return {{"disc", {{"center", at}, {"normal", draw_direction(drawing)}, {"radius", radius}}}};
    case 3:
      return {{"sphere",
               {{"center", at}, {"radius", radius}, {"facing", one_of(random, {"outwards", "inwards"})}}}};
    default:
      break;
  }
  Json edge_u = Json::array();
  for (int axis = 0; axis < 3; ++axis) edge_u.push_back(drawing.size * signed_decades(random, 1e-4, 0.2));
  Json edge_v = cross(edge_u, {drawing.size, 0.3 * drawing.size, -0.1 * drawing.size});
  for (Json& length : edge_v) length = length.get<double>() / drawing.size;
  return {{"quad", {{"corner", at}, {"edge_u", edge_u}, {"edge_v", edge_v}}}};
}

// True if the scene suits a lens system. Lenses have their real size and focus at 1 m to 100 m. Their rims,
// up to 5 cm from the axis, must stay inside the walls; a camera is at least 0.3 of the box size away from
// these. Spectral sensors do not support lens systems.
bool holds_a_lens(const Drawing& drawing) {
  const double size_m = drawing.size * drawing.unit_m;
  return size_m > 0.2 && size_m < 1e3 && !drawing.scene["sensor"].contains("spectral");
}

void add_blades(Random& random, Json& lens) {
  if (!chance(random, 0.3)) return;
  lens["blades"] = integer(random, 3, 32);
  if (chance(random, 0.5)) lens["blade_rotation_deg"] = uniform(random, -360, 360);
}

Json lens_system(Drawing& drawing) {
  Random& random = drawing.random;
  Json lens{{"prescription", one_of(random, {"achromat", "cooke_triplet", "double_gauss", "fisheye",
                                             "landscape", "tessar"})}};
  if (chance(random, 0.6))
    lens["focus_distance"] =
        chance(random, 0.3) ? Json("infinity") : Json(decades(random, 1, 100) / drawing.unit_m);
  if (chance(random, 0.5)) lens["f_number"] = decades(random, 10, 64);  // all of them can be opened to f/10
  if (chance(random, 0.3)) lens["focus"] = "paraxial";
  if (chance(random, 0.2)) lens["ghosts"] = true;
  add_blades(random, lens);
  return lens;
}

// A thin lens no larger than a tenth of the box.
Json thin_lens(Drawing& drawing) {
  Random& random = drawing.random;
  const double focal_length = drawing.size * decades(random, 1e-4, 0.1);
  Json lens{{"focal_length", focal_length}, {"f_number", decades(random, 0.5, 64)}};
  lens["focus_distance"] =
      chance(random, 0.2) ? Json("infinity") : Json(focal_length * decades(random, 1.001, 1e4));
  add_blades(random, lens);
  return lens;
}

// Sets the pixel pitch for a film of the given length along its longer side.
void set_pitch(Drawing& drawing, double film_um) {
  Json& sensor = drawing.scene["sensor"];
  sensor["pixel_pitch_um"] = std::min(
      1e6, film_um / std::max(sensor["resolution"][0].get<int>(), sensor["resolution"][1].get<int>()));
}

}  // namespace

void draw_camera(Drawing& drawing) {
  Random& random = drawing.random;
  Json& camera = drawing.scene["camera"];
  if (drawing.uses_probe) {
    camera["irradiance_probe"] = probe(drawing);
    if (chance(random, 0.3)) camera["irradiance_probe"]["acceptance_deg"] = decades(random, 0.01, 90);
    return;
  }
  camera["from"] = draw_position(drawing, 0.7);
  camera["to"] = chance(random, 0.8) && !drawing.targets.empty() ? one_of(random, drawing.targets)
                                                                 : draw_position(drawing, 0.5);
  camera["up"] = {uniform(random, -1, 1), uniform(random, -1, 1), decades(random, 0.1, 10)};
  if (chance(random, 0.2)) camera["roll_deg"] = uniform(random, -360, 360);
  maybe_animate(drawing, camera);
  const double fov_deg = chance(random, 0.8) ? decades(random, 5, 120) : decades(random, 0.05, 170);
  if (chance(random, 0.6)) {
    camera["pinhole"] = {{"fov_deg", fov_deg}, {"f_number", decades(random, 0.5, 1e3)}};
  } else if (holds_a_lens(drawing) && chance(random, 0.5)) {
    camera["lens_system"] = lens_system(drawing);
    set_pitch(drawing, decades(random, 1e3, 2e4));  // inside the image circle of the fisheye
  } else {
    camera["thin_lens"] = thin_lens(drawing);
    const double focal_um = 1e6 * drawing.unit_m * camera["thin_lens"]["focal_length"].get<double>();
    set_pitch(drawing, 2 * focal_um * std::tan(fov_deg * std::numbers::pi / 360));
  }
}

}  // namespace abbe::soak
