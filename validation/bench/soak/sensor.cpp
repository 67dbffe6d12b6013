#include <fmt/format.h>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

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
  Random& random = drawing.random;
  Json stack = Json::array();
  for (int i = integer(random, 1, 2); i > 0; --i) {
    Json glass{{"sum", {draw_curve(drawing, 0.5), {{"band", {480, 600}}, {"value", 0.1}}}}};
    if (drawing.closed) glass = {{"product", {glass, {{"band", {300, kMaxInside_nm}}}}}};
    if (chance(random, 0.5))
      stack.push_back({{"transmittance", glass}, {"effective_index", decades(random, 1, 10)}});
    else
      stack.push_back(glass);
  }
  return stack;
}

Json polariser(Drawing& drawing) {
  Random& random = drawing.random;
  Json sheet{{"angle_deg", chance(random, 0.3) ? 90 : uniform(random, -360, 360)}};
  if (chance(random, 0.5)) sheet["extinction_ratio"] = decades(random, 1, 1e9);
  if (chance(random, 0.3)) sheet["transmittance"] = uniform(random, 0.1, 1);
  return sheet;
}

// Channels of a moving scene have one common exposure. Probes do not measure polarisation.
Json channels(Drawing& drawing) {
  Random& random = drawing.random;
  Json all;
  for (int i = integer(random, 1, 4); i > 0; --i) {
    Json& channel = all[fmt::format("c{}", i)];
    if (drawing.signed_response || chance(random, 0.7)) {
      channel = channel_curve(drawing);
      continue;
    }
    channel = {{"filters", filters(drawing)}};
    if (!drawing.moves) channel["exposure_s"] = decades(random, 1e-6, kMaxExposure_s);
    if (!drawing.uses_probe && chance(random, 0.3)) channel["polariser"] = polariser(drawing);
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
  Random& random = drawing.random;
  const int kind = drawing.closed || drawing.signed_response ? 0 : integer(random, 0, 6);
  if (kind <= 2) {
    sensor["channels"] = channels(drawing);
    sensor["response"] = one_of(random, {"energy", "quantum"});
    if (!drawing.closed && chance(random, 0.3)) add_mosaic(random, sensor);
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

Json shutter(Drawing& drawing) {
  Random& random = drawing.random;
  Json shutter{{"open_s", drawing.open_s}};
  if (chance(random, 0.3)) {
    shutter["transmission"] = {{0, uniform(random, 0, 1)}, {uniform(random, 0.1, 0.9), 1}, {1, 0}};
  } else if (chance(random, 0.5)) {
    shutter["rise_s"] = drawing.exposure_s * uniform(random, 0, 0.5);
    shutter["fall_s"] = drawing.exposure_s * uniform(random, 0, 0.5);
  }
  if (chance(random, 0.5)) shutter["row_delay_s"] = drawing.exposure_s * decades(random, 1e-3, 10);
  return shutter;
}

// The sensor measures the Stokes vector of each channel, or one polariser covers all channels.
void measure_polarisation(Drawing& drawing, Json& sensor) {
  const bool behind_polarisers =
      sensor.contains("channels") && sensor["channels"].dump().find("polariser") != std::string::npos;
  if (behind_polarisers) return;
  if (!sensor.contains("mosaic") && chance(drawing.random, 0.5))
    sensor["stokes"] = true;
  else if (!sensor.contains("spectral"))
    sensor["polariser"] = polariser(drawing);
}

}  // namespace

void draw_sensor(Drawing& drawing) {
  Random& random = drawing.random;
  Json sensor;
  sensor["resolution"] = {static_cast<int>(decades(random, 1, 40)), static_cast<int>(decades(random, 1, 40))};
  draw_response(drawing, sensor);
  sensor["exposure_s"] = drawing.exposure_s;
  if (drawing.moves || chance(random, 0.1)) sensor["shutter"] = shutter(drawing);
  sensor["fill_factor"] = uniform(random, 0.01, 1);
  if (!drawing.closed && !sensor.contains("spectral") && chance(random, 0.2)) {
    sensor["lens_transmission"] = uniform(random, 0.1, 1);
    sensor["filters"] = filters(drawing);
  }
  if (!drawing.uses_probe && chance(random, 0.2)) measure_polarisation(drawing, sensor);
  drawing.scene["sensor"] = sensor;
}

}  // namespace abbe::soak
