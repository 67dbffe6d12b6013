#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "scene/scene.h"
#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

// Draws the unit, the size and the center of the scene.
void draw_scale_and_position(Drawing& drawing) {
  struct Unit {
    const char* name;
    double metres;
  };
  const Unit unit = one_of(drawing, {Unit{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"in", 0.0254}});
  drawing.scene["units"] = unit.name;
  drawing.unit_m = unit.metres;
  drawing.size = decades(drawing, 1e-2, 1e5);
  if (chance(drawing, 0.5))
    for (double& x : drawing.center) x = drawing.size * signed_decades(drawing, 1e-3, 1e3);
}

Json cross(const Json& a, const Json& b) {
  const auto x = [](const Json& v, std::size_t i) { return v[i % 3].get<double>(); };
  Json c = Json::array();
  for (std::size_t i = 0; i < 3; ++i) c.push_back(x(a, i + 1) * x(b, i + 2) - x(a, i + 2) * x(b, i + 1));
  return c;
}

Json probe(Drawing& drawing) {
  const Json at = draw_position(drawing, 0.6);
  const double radius = drawing.size * decades(drawing, 1e-4, 0.2);
  const int kind = integer(drawing, 0, 4);
  if (kind <= 1) return {{"at", at}, {"normal", draw_direction(drawing)}};
  if (kind == 2) return {{"disc", {{"center", at}, {"normal", draw_direction(drawing)}, {"radius", radius}}}};
  if (kind == 3)
    return {{"sphere",
             {{"center", at}, {"radius", radius}, {"facing", one_of(drawing, {"outwards", "inwards"})}}}};
  Json edge_u = Json::array();
  for (int axis = 0; axis < 3; ++axis) edge_u.push_back(drawing.size * signed_decades(drawing, 1e-4, 0.2));
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
  Json lens{{"prescription", one_of(drawing, {"achromat", "cooke_triplet", "double_gauss", "fisheye",
                                              "landscape", "tessar"})}};
  if (chance(drawing, 0.6))
    lens["focus_distance"] =
        chance(drawing, 0.3) ? Json("infinity") : Json(decades(drawing, 1, 100) / drawing.unit_m);
  if (chance(drawing, 0.5)) lens["f_number"] = decades(drawing, 10, 64);  // all of them can be opened to f/10
  if (chance(drawing, 0.3)) lens["focus"] = "paraxial";
  if (chance(drawing, 0.2)) lens["ghosts"] = true;
  add_blades(drawing, lens);
  return lens;
}

// A thin lens no larger than a tenth of the box.
Json thin_lens(Drawing& drawing) {
  const double focal_length = drawing.size * decades(drawing, 1e-4, 0.1);
  Json lens{{"focal_length", focal_length}, {"f_number", decades(drawing, 0.5, 64)}};
  lens["focus_distance"] =
      chance(drawing, 0.2) ? Json("infinity") : Json(focal_length * decades(drawing, 1.001, 1e4));
  add_blades(drawing, lens);
  return lens;
}

// Sets the pixel pitch for a film of the given length along its longer side.
void set_pitch(Drawing& drawing, double film_um) {
  Json& sensor = drawing.scene["sensor"];
  sensor["pixel_pitch_um"] = std::min(
      1e6, film_um / std::max(sensor["resolution"][0].get<int>(), sensor["resolution"][1].get<int>()));
}

// A spectrum with some power in the visible range.
Json spectrum(Drawing& drawing, double max_value) {
  Json curve{{"sum", {draw_curve(drawing, max_value), {{"band", {520, 580}}, {"value", 0.01 * max_value}}}}};
  if (chance(drawing, 0.2)) curve = max_value;
  if (chance(drawing, 0.2))
    curve = {{"lines",
              {{{"nm", 546.1}, {"width_nm", decades(drawing, 1e-3, 1)}, {"power", max_value}},
               {{"nm", uniform(drawing, 400, 700)},
                {"width_nm", decades(drawing, 1e-3, 10)},
                {"power", max_value}}}}};
  if (drawing.closed) curve = {{"product", {curve, {{"band", {300, kMaxInside_nm}}}}}};
  return curve;
}

Json relative_emission(Drawing& drawing) {
  if (drawing.closed) return {{"spectrum", spectrum(drawing, 1)}};
  const int kind = integer(drawing, 0, 3);
  if (kind == 0) return {{"blackbody_K", decades(drawing, 1500, 1e6)}};
  if (kind == 1) return {{"daylight_K", uniform(drawing, 4000, 25000)}};
  if (kind == 2) return {{"spectrum", spectrum(drawing, 1)}};
  return {{"illuminant", one_of(drawing, {"A", "D65", "E", "FL11", "LED-B3"})}};
}

Json unpolarised_emission(Drawing& drawing, const std::string& kind) {
  // A point or spot light produces the same irradiance at the distance of a scene's size as the others do.
  const double distance = kind == "point" ? drawing.size * drawing.unit_m : 1;
  const double amount = drawing.brightness * decades(drawing, 1e-3, 1e3) * distance * distance;
  if (chance(drawing, 0.4))
    return {{"spectrum", chance(drawing, 0.05) ? Json(0) : spectrum(drawing, amount)}};
  Json emission = relative_emission(drawing);
  const bool photometric = chance(drawing, 0.5);
  if (kind == "area" || kind == "environment")
    emission[photometric ? "luminance" : "radiance"] = amount;
  else if (kind == "point")
    emission[photometric ? "luminous_intensity" : "intensity"] = amount;
  else
    emission[photometric ? "illuminance" : "irradiance"] = amount;
  return emission;
}

Json area_light(Drawing& drawing) {
  const double r = drawing.size * decades(drawing, 1e-5, 0.2);
  Json light;
  const int kind = integer(drawing, 0, 2);
  if (kind == 0)
    light["sphere"] = {{"center", draw_position(drawing, 0.7)}, {"radius", r}};
  else if (kind == 1)
    light["disc"] = {
        {"center", draw_position(drawing, 0.7)}, {"normal", draw_direction(drawing)}, {"radius", r}};
  else
    light["quad"] = {{"corner", draw_position(drawing, 0.7)},
                     {"edge_u", {0, r, 0}},
                     {"edge_v", {r * decades(drawing, 1e-3, 1), r * uniform(drawing, -1, 1), 0}}};
  light["emission"] = draw_emission(drawing, "area");
  maybe_animate(drawing, light);
  if (!light.contains("sphere") && chance(drawing, 0.5)) light["two_sided"] = true;
  const DrawnMaterial& drawn = one_of(drawing, drawing.materials);
  if (!drawn.has_interior && chance(drawing, 0.4)) light["material"] = drawn.name;
  return light;
}

Json point_or_spot_light(Drawing& drawing) {
  Json light;
  if (chance(drawing, 0.5))
    light["point"] = {{"at", draw_position(drawing, 0.7)}};
  else
    light["spot"] = {{"at", draw_position(drawing, 0.7)},
                     {"direction", draw_direction(drawing)},
                     {"half_angle_deg", decades(drawing, 0.1, 180)}};
  light["emission"] = draw_emission(drawing, "point");
  maybe_animate(drawing, light);
  return light;
}

Json distant_light(Drawing& drawing) {
  Json light;
  if (chance(drawing, 0.5)) {
    light["directional"] = {{"towards", draw_direction(drawing)}};
    light["emission"] = draw_emission(drawing, "directional");
  } else {
    light["sun"] = {{"towards", draw_direction(drawing)},
                    {"angular_diameter_deg", decades(drawing, 0.01, 60)}};
    light["emission"] = draw_emission(drawing, "sun");
  }
  return light;
}

Json environment(Drawing& drawing) {
  Json light{{"environment", Json::object()}, {"emission", draw_emission(drawing, "environment")}};
  if (chance(drawing, 0.4))
    light["environment"] = {{"image", draw_image(drawing, {"R", "G", "B"}, 0, 1)},
                            {"up", draw_direction(drawing)},
                            {"rotate_deg", uniform(drawing, -360, 360)}};
  return light;
}

// Light that must not enter the box.
Json outside_light(Drawing& drawing) {
  const Json emission{
      {"spectrum", {{"band", {kMaxInside_nm + 50, 1100}}, {"value", 1e3 * drawing.brightness}}}};
  if (chance(drawing, 0.7)) return {{"environment", Json::object()}, {"emission", emission}};
  return {{"sun", {{"towards", draw_direction(drawing)}, {"angular_diameter_deg", 60}}},
          {"emission", emission}};
}

// Channels of a closed box have no response at the wavelengths of the light outside.
Json channel_curve(Drawing& drawing) {
  Json curve = draw_curve(drawing, 1);
  if (drawing.closed) curve = {{"product", {curve, {{"band", {300, kMaxInside_nm}}}}}};
  // Ensures some response whatever the drawn curve is.
  curve = {{"sum", {curve, {{"band", {500, 560}}, {"value", 0.01}}}}};
  if (!drawing.signed_response) return curve;
  return {{"sum", {curve, {{"scale", -1}, {"of", {{"band", {550, 700}}}}}}}};
}

Json filters(Drawing& drawing) {
  Json stack = Json::array();
  for (int i = integer(drawing, 1, 2); i > 0; --i) {
    Json glass{{"sum", {draw_curve(drawing, 0.5), {{"band", {480, 600}}, {"value", 0.1}}}}};
    if (drawing.closed) glass = {{"product", {glass, {{"band", {300, kMaxInside_nm}}}}}};
    if (chance(drawing, 0.5))
      stack.push_back({{"transmittance", glass}, {"effective_index", decades(drawing, 1, 10)}});
    else
      stack.push_back(glass);
  }
  return stack;
}

Json polariser(Drawing& drawing) {
  Json sheet{{"angle_deg", chance(drawing, 0.3) ? 90 : uniform(drawing, -360, 360)}};
  if (chance(drawing, 0.5)) sheet["extinction_ratio"] = decades(drawing, 1, 1e9);
  if (chance(drawing, 0.3)) sheet["transmittance"] = uniform(drawing, 0.1, 1);
  return sheet;
}

// Channels of a moving scene have one common exposure. Probes do not measure polarisation.
Json channels(Drawing& drawing) {
  Json all;
  for (int i = integer(drawing, 1, 4); i > 0; --i) {
    Json& channel = all[fmt::format("c{}", i)];
    if (drawing.signed_response || chance(drawing, 0.7)) {
      channel = channel_curve(drawing);
      continue;
    }
    channel = {{"filters", filters(drawing)}};
    if (!drawing.moves) channel["exposure_s"] = decades(drawing, 1e-6, kMaxExposure_s);
    if (!drawing.uses_probe && chance(drawing, 0.3)) channel["polariser"] = polariser(drawing);
  }
  if (drawing.closed) all[kOutsideChannel] = {{"band", {kMaxInside_nm + 50, 1100}}};
  return all;
}

// Each channel appears in the pattern, which has two columns.
void add_mosaic(Random& random, Json& sensor) {
  std::vector<std::string> names;
  for (const auto& [name, unused] : sensor["channels"].items()) names.push_back(name);
  for (std::size_t i = 0; i < names.size(); ++i)
    sensor["mosaic"].push_back({names[i], one_of(random, names)});
}

void draw_response(Drawing& drawing, Json& sensor) {
  const int kind = drawing.closed || drawing.signed_response ? 0 : integer(drawing, 0, 6);
  if (kind <= 2) {
    sensor["channels"] = channels(drawing);
    sensor["response"] = one_of(drawing, {"energy", "quantum"});
    if (!drawing.closed && chance(drawing, 0.3)) add_mosaic(drawing, sensor);
  } else if (kind == 3) {
    sensor["camera"] = one_of(drawing, {"Canon_EOS_5D_Mark_II", "Nikon_D5100", "Sony_ILCE-9"});
  } else if (kind == 4) {
    const double from = uniform(drawing, 350, 700);
    const double step = decades(drawing, 1, 50);
    sensor["spectral"] = {
        {"from_nm", from}, {"to_nm", from + step * integer(drawing, 2, 8)}, {"step_nm", step}};
  } else {
    sensor["observer"] = one_of(drawing, {"1931", "1964"});
  }
}

Json shutter(Drawing& drawing) {
  Json shutter{{"open_s", drawing.open_s}};
  if (chance(drawing, 0.3)) {
    shutter["transmission"] = {{0, uniform(drawing, 0, 1)}, {uniform(drawing, 0.1, 0.9), 1}, {1, 0}};
  } else if (chance(drawing, 0.5)) {
    shutter["rise_s"] = drawing.exposure_s * uniform(drawing, 0, 0.5);
    shutter["fall_s"] = drawing.exposure_s * uniform(drawing, 0, 0.5);
  }
  if (chance(drawing, 0.5)) shutter["row_delay_s"] = drawing.exposure_s * decades(drawing, 1e-3, 10);
  return shutter;
}

// The sensor measures the Stokes vector of each channel, or one polariser covers all channels.
void measure_polarisation(Drawing& drawing, Json& sensor) {
  const bool behind_polarisers =
      sensor.contains("channels") && sensor["channels"].dump().find("polariser") != std::string::npos;
  if (behind_polarisers) return;
  if (!sensor.contains("mosaic") && chance(drawing, 0.5))
    sensor["stokes"] = true;
  else if (!sensor.contains("spectral"))
    sensor["polariser"] = polariser(drawing);
}

constexpr int kMaxPaths = 2'400'000;
constexpr int kMaxSceneSamples = 40'000;
constexpr double kMaxVertices = 6e8;
// Pairs of vertices, or of a vertex and a photon; they take minutes of CPU time at most.
constexpr double kMaxVertexPairs = 3e7;

// Draws the photon settings. Returns a lower bound of the photons per sample.
int draw_photons(Drawing& drawing, Json& render) {
  const int per_sample = static_cast<int>(decades(drawing, 1, 2e4));
  render["photons"]["per_sample"] = per_sample;
  if (chance(drawing, 0.5)) render["photons"]["radius"] = drawing.size * decades(drawing, 1e-4, 1);
  if (render["integrator"] == "photon-map") {
    render["photons"]["nearest"] = static_cast<int>(decades(drawing, 1, 1000));
    render["photons"]["final_gather"] = chance(drawing, 0.5);
  }
  return per_sample;
}

double depth_of(const Json& render) {
  constexpr int kUsualDepth = 100;
  return render.value("max_depth", kUsualDepth);
}

// Connections of two paths of n events may join any two events. Photon gathering may find each event of all
// photons from every event of a camera path.
double pairs_of_sample(const Json& render, int pixels, int photons) {
  const double depth = depth_of(render);
  return pixels * depth * (photons > 0 ? photons : depth);
}

void draw_strategies(Random& random, Json& render) {
  render["directions"] = one_of(random, {"bsdf", "cosine", "uniform"});
  render["lights"] = one_of(random, {"mis", "bsdf", "light"});
  if (render["lights"] == "mis") render["heuristic"] = one_of(random, {"balance", "power"});
}

}  // namespace

DrawnScene draw_scene(std::uint64_t seed, const std::filesystem::path& folder) {
  Drawing drawing;
  drawing.seed(seed);
  drawing.folder = folder;
  drawing.closed = chance(drawing, 0.3);
  drawing.signed_response = chance(drawing, 0.1);
  drawing.brightness = decades(drawing, 1e-15, 1e8);
  drawing.uses_probe = chance(drawing, 0.1);
  drawing.moves = chance(drawing, 0.3);
  drawing.open_s = drawing.moves ? uniform(drawing, -5, 5) : 0;
  drawing.exposure_s = decades(drawing, 1e-6, kMaxExposure_s);
  drawing.scene["abbe"] = 1;
  draw_scale_and_position(drawing);
  draw_materials(drawing);
  draw_shapes(drawing);
  draw_sensor(drawing);
  draw_camera(drawing);
  draw_lights(drawing);
  draw_render(drawing);
  const std::filesystem::path path = folder / fmt::format("soak_{}.json", seed);
  write_atomically(path, drawing.scene.dump(1) + "\n");
  return {path, drawing.closed, drawing.signed_response};
}

void draw_camera(Drawing& drawing) {
  Json& camera = drawing.scene["camera"];
  if (drawing.uses_probe) {
    camera["irradiance_probe"] = probe(drawing);
    if (chance(drawing, 0.3)) camera["irradiance_probe"]["acceptance_deg"] = decades(drawing, 0.01, 90);
    return;
  }
  camera["from"] = draw_position(drawing, 0.7);
  camera["to"] = chance(drawing, 0.8) && !drawing.targets.empty() ? one_of(drawing, drawing.targets)
                                                                  : draw_position(drawing, 0.5);
  camera["up"] = {uniform(drawing, -1, 1), uniform(drawing, -1, 1), decades(drawing, 0.1, 10)};
  if (chance(drawing, 0.2)) camera["roll_deg"] = uniform(drawing, -360, 360);
  maybe_animate(drawing, camera);
  const double fov_deg = chance(drawing, 0.8) ? decades(drawing, 5, 120) : decades(drawing, 0.05, 170);
  if (chance(drawing, 0.6)) {
    camera["pinhole"] = {{"fov_deg", fov_deg}, {"f_number", decades(drawing, 0.5, 1e3)}};
  } else if (holds_a_lens(drawing) && chance(drawing, 0.5)) {
    camera["lens_system"] = lens_system(drawing);
    set_pitch(drawing, decades(drawing, 1e3, 2e4));  // inside the image circle of the fisheye
  } else {
    camera["thin_lens"] = thin_lens(drawing);
    const double focal_um = 1e6 * drawing.unit_m * camera["thin_lens"]["focal_length"].get<double>();
    set_pitch(drawing, 2 * focal_um * std::tan(fov_deg * std::numbers::pi / 360));
  }
}

Json draw_emission(Drawing& drawing, const std::string& kind) {
  Json emission = unpolarised_emission(drawing, kind);
  if (!chance(drawing, 0.15)) return emission;
  if (chance(drawing, 0.6))
    emission["polarised"]["axis"] = draw_direction(drawing);
  else
    emission["polarised"]["circular"] = one_of(drawing, {"left", "right"});
  if (chance(drawing, 0.5)) emission["polarised"]["degree"] = uniform(drawing, 0, 1);
  return emission;
}

void draw_lights(Drawing& drawing) {
  Json& lights = drawing.scene["lights"];
  lights = Json::array();
  for (int i = integer(drawing, 1, 3); i > 0; --i) {
    const double kind = uniform(drawing, 0, 1);
    lights.push_back(kind < 0.5                      ? area_light(drawing)
                     : drawing.closed || kind < 0.75 ? point_or_spot_light(drawing)
                                                     : distant_light(drawing));
  }
  if (drawing.closed)
    lights.push_back(outside_light(drawing));
  else if (chance(drawing, 0.5))
    lights.push_back(environment(drawing));
}

void draw_sensor(Drawing& drawing) {
  Json sensor;
  sensor["resolution"] = {static_cast<int>(decades(drawing, 1, 40)),
                          static_cast<int>(decades(drawing, 1, 40))};
  draw_response(drawing, sensor);
  sensor["exposure_s"] = drawing.exposure_s;
  if (drawing.moves || chance(drawing, 0.1)) sensor["shutter"] = shutter(drawing);
  sensor["fill_factor"] = uniform(drawing, 0.01, 1);
  if (!drawing.closed && !sensor.contains("spectral") && chance(drawing, 0.2)) {
    sensor["lens_transmission"] = uniform(drawing, 0.1, 1);
    sensor["filters"] = filters(drawing);
  }
  if (!drawing.uses_probe && chance(drawing, 0.2)) measure_polarisation(drawing, sensor);
  drawing.scene["sensor"] = sensor;
}

void draw_render(Drawing& drawing) {
  const Json& resolution = drawing.scene["sensor"]["resolution"];
  const int pixels = resolution[0].get<int>() * resolution[1].get<int>();
  Json& render = drawing.scene["render"];
  std::vector<std::string> integrators(kIntegratorNames.begin(), kIntegratorNames.end());
  integrators.insert(integrators.end(), {"auto", "auto", "path"});  // the usual ones more often
  const std::string integrator = one_of(drawing, integrators);
  render["integrator"] = integrator;
  if (integrator == "auto" && chance(drawing, 0.1)) render["consistent"] = true;
  if (integrator == "path" && chance(drawing, 0.2)) draw_strategies(drawing, render);
  const bool gathers = integrator == "sppm" || integrator == "ppm" || integrator == "photon-map";
  const int photons = gathers || integrator == "photon-brute" ? draw_photons(drawing, render) : 0;
  // Photon merging blurs the film, also across the edges of walls.
  if (gathers || integrator == "vcm" || render.contains("consistent")) drawing.closed = false;
  const double sample_fraction = decades(drawing, 0.001, 1);
  if (chance(drawing, 0.1)) render["polarisation"] = "off";
  render["seed"] = integer(drawing, 0, 1 << 30);
  const bool uses_roulette = chance(drawing, 0.8);
  const bool connects = integrator == "bdpt" || integrator == "vcm";
  if (connects || !uses_roulette || chance(drawing, 0.5))
    render["max_depth"] = static_cast<int>(decades(drawing, 1, uses_roulette && !connects ? 1000 : 60));
  render["roulette_depth"] = uses_roulette ? integer(drawing, 0, 12) : -1;
  const int paths = std::max(pixels, photons);
  double max_samples = std::min(kMaxSceneSamples, kMaxPaths / paths);
  max_samples = std::min(max_samples, kMaxVertices / (paths * depth_of(render)));
  if (connects || gathers)
    max_samples = std::min(max_samples, kMaxVertexPairs / pairs_of_sample(render, pixels, photons));
  render["samples"] = static_cast<int>(max_samples * sample_fraction + 1);
}

}  // namespace abbe::soak
