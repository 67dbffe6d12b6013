#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

constexpr int kMostPaths = 600'000;
constexpr int kMostSamples = 10'000;

// What a channel of a closed box counts lies below the wavelengths of the light beyond it.
Json channel_curve(Drawing& drawing) {
  Json curve = draw_curve(drawing, 1);
  if (drawing.closed) curve = {{"product", {curve, {{"band", {300, kInsideBelow}}}}}};
  // Some response somewhere, however the curve was drawn.
  curve = {{"sum", {curve, {{"band", {500, 560}}, {"value", 0.01}}}}};
  if (!drawing.signed_response) return curve;
  return {{"sum", {curve, {{"scale", -1}, {"of", {{"band", {550, 700}}}}}}}};
}

Json filters(Drawing& drawing) {
  Random& random = drawing.random;
  Json stack = Json::array();
  for (int i = integer(random, 1, 2); i > 0; --i) {
    Json glass{{"sum", {draw_curve(drawing, 0.5), {{"band", {480, 600}}, {"value", 0.1}}}}};
    if (drawing.closed) glass = {{"product", {glass, {{"band", {300, kInsideBelow}}}}}};
    if (chance(random, 0.5))
      stack.push_back({{"transmittance", glass}, {"effective_index", decades(random, 1, 10)}});
    else
      stack.push_back(glass);
  }
  return stack;
}

Json channels(Drawing& drawing) {
  Random& random = drawing.random;
  Json all;
  for (int i = integer(random, 1, 4); i > 0; --i) {
    Json& channel = all[fmt::format("c{}", i)];
    if (drawing.signed_response || chance(random, 0.7))
      channel = channel_curve(drawing);
    else
      channel = {{"filters", filters(drawing)}, {"exposure_s", decades(random, 1e-6, 1e3)}};
  }
  if (drawing.closed) all[kOutsideChannel] = {{"band", {kInsideBelow + 50, 1100}}};
  return all;
}

// Each channel has a place, in a pattern of two columns.
void lay_mosaic(Random& random, Json& sensor) {
  std::vector<std::string> names;
  for (const auto& [name, unused] : sensor["channels"].items()) names.push_back(name);
  for (std::size_t i = 0; i < names.size(); ++i)
    sensor["mosaic"].push_back({names[i], one_of(random, names)});
}

void count(Drawing& drawing, Json& sensor) {
  Random& random = drawing.random;
  const int kind = drawing.closed || drawing.signed_response ? 0 : integer(random, 0, 6);
  if (kind <= 2) {
    sensor["channels"] = channels(drawing);
    sensor["response"] = one_of(random, {"energy", "quantum"});
    if (!drawing.closed && chance(random, 0.3)) lay_mosaic(random, sensor);
  } else if (kind == 3) {
    sensor["camera"] = one_of(random, {"Canon_EOS_5D_Mark_II", "Nikon_D5100", "Sony_ILCE-9"});
  } else if (kind == 4) {
    const double from = uniform(random, 350, 700);
    const double step = decades(random, 1, 50);
    sensor["spectral"] = {
        {"from_nm", from}, {"to_nm", from + step * integer(random, 2, 8)}, {"step_nm", step}};
  } else {
    sensor["observer"] = one_of(random, {"1931", "1964"});
  }
}

}  // namespace

void draw_sensor(Drawing& drawing) {
  Random& random = drawing.random;
  Json sensor;
  sensor["resolution"] = {static_cast<int>(decades(random, 1, 40)), static_cast<int>(decades(random, 1, 40))};
  count(drawing, sensor);
  sensor["exposure_s"] = decades(random, 1e-6, 1e3);
  sensor["fill_factor"] = uniform(random, 0.01, 1);
  if (!drawing.closed && !sensor.contains("spectral") && chance(random, 0.2)) {
    sensor["lens_transmission"] = uniform(random, 0.1, 1);
    sensor["filters"] = filters(drawing);
  }
  drawing.scene["sensor"] = sensor;
}

namespace {

Json cross(const Json& a, const Json& b) {
  const auto x = [](const Json& v, std::size_t i) { return v[i % 3].get<double>(); };
  Json c = Json::array();
  for (std::size_t i = 0; i < 3; ++i) c.push_back(x(a, i + 1) * x(b, i + 2) - x(a, i + 2) * x(b, i + 1));
  return c;
}

Json probe(Drawing& drawing) {
  const Json at = draw_place(drawing, 0.6);
  if (chance(drawing.random, 0.5)) return {{"at", at}, {"normal", draw_direction(drawing)}};
  Json edge_u = Json::array();
  for (int axis = 0; axis < 3; ++axis)
    edge_u.push_back(drawing.size * decades(drawing.random, 1e-4, 0.2) * one_of(drawing.random, {-1, 1}));
  Json edge_v = cross(edge_u, {drawing.size, 0.3 * drawing.size, -0.1 * drawing.size});
  for (Json& length : edge_v) length = length.get<double>() / drawing.size;
  return {{"quad", {{"corner", at}, {"edge_u", edge_u}, {"edge_v", edge_v}}}};
}

}  // namespace

void draw_camera(Drawing& drawing) {
  Random& random = drawing.random;
  Json& camera = drawing.scene["camera"];
  if (chance(random, 0.1)) {
    camera["irradiance_probe"] = probe(drawing);
    return;
  }
  camera["from"] = draw_place(drawing, 0.7);
  camera["to"] = chance(random, 0.8) && !drawing.targets.empty() ? one_of(random, drawing.targets)
                                                                 : draw_place(drawing, 0.5);
  camera["up"] = {uniform(random, -1, 1), uniform(random, -1, 1), decades(random, 0.1, 10)};
  const double fov_deg = chance(random, 0.8) ? decades(random, 5, 120) : decades(random, 0.05, 170);
  if (chance(random, 0.6)) {
    camera["pinhole"] = {{"fov_deg", fov_deg}, {"f_number", decades(random, 0.5, 1e3)}};
    return;
  }
  // A lens no larger than a tenth of the box, of a film as large as the view asks.
  const double focal_length = drawing.size * decades(random, 1e-4, 0.1);
  const double film_um = 2e6 * drawing.unit_m * focal_length * std::tan(fov_deg * std::numbers::pi / 360);
  Json& sensor = drawing.scene["sensor"];
  sensor["pixel_pitch_um"] = std::min(
      1e6, film_um / std::max(sensor["resolution"][0].get<int>(), sensor["resolution"][1].get<int>()));
  camera["thin_lens"] = {{"focal_length", focal_length}, {"f_number", decades(random, 0.5, 64)}};
  camera["thin_lens"]["focus_distance"] =
      chance(random, 0.2) ? Json("infinity") : Json(focal_length * decades(random, 1.001, 1e4));
}

void draw_render(Drawing& drawing) {
  Random& random = drawing.random;
  const Json& resolution = drawing.scene["sensor"]["resolution"];
  const int pixels = resolution[0].get<int>() * resolution[1].get<int>();
  Json& render = drawing.scene["render"];
  render["integrator"] = one_of(random, {"auto", "auto", "path", "light", "bdpt"});
  render["samples"] =
      static_cast<int>(std::min(kMostSamples, kMostPaths / pixels) * decades(random, 0.001, 1) + 1);
  render["seed"] = integer(random, 0, 1 << 30);
  const bool plays = chance(random, 0.8);
  if (!plays || chance(random, 0.5))
    render["max_depth"] = static_cast<int>(decades(random, 1, plays ? 1000 : 60));
  render["roulette_depth"] = plays ? integer(random, 0, 12) : -1;
}

}  // namespace abbe::soak
