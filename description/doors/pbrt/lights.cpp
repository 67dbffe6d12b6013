#include "description/doors/pbrt/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "description/doors/pbrt/spectra.h"
#include "description/doors/shared/lamps.h"
#include "description/doors/shared/picture.h"
#include "spectral/colorimetry.h"

namespace abbe::doors::pbrt {
namespace {

using spec::Quantity;

const std::vector<std::string> kLightTypes{"distant", "goniometric", "infinite",
                                           "point",   "projection",  "spot"};
const LinearRgb kWhite{1, 1, 1};

// The lamp of a spectrum, which counts there by its shape times "scale".
LampSpectrum lamp(const Made& light, std::string_view name, World& world) {
  const double scale = light.parameters.number("scale", 1, world.door);
  return lamp_of(spectrum(light.parameters, name, kWhite, world), scale, light.where, world.door);
}

// A quantity that the light asks for in place of its own, as lumens or lux there.
void rescale(const Made& light, std::string_view name, double share, LampSpectrum& lamp, World& world) {
  const double asked = light.parameters.number(name, 0, world.door);
  if (asked > 0 && lamp.photometric) *lamp.photometric *= asked * share;
}

Imath::V3d moved(const Imath::V3d& p, const Imath::M44d& m) {
  return p * m;
}

void add_point(const Made& light, const Imath::M44d& m, World& world) {
  LampSpectrum sent = lamp(light, "I", world);
  rescale(light, "power", 1 / (4 * std::numbers::pi), sent, world);
  const Imath::V3d at = moved(light.parameters.point("from", {0, 0, 0}, world.door), m);
  add_lamp(spec::PointLamp{{at}, emission_of<spec::PointEmission, Quantity::luminous_intensity>(sent)},
           light.where, world.door);
}

void add_spot(const Made& light, const Imath::M44d& m, World& world) {
  const Parameters& p = light.parameters;
  LampSpectrum sent = lamp(light, "I", world);
  const double whole = p.number("coneangle", 30, world.door);
  const double full = whole - p.number("conedeltaangle", 5, world.door);
  const double half_angle = hard_cone(full, whole, Falloff::smooth_cosine, light.where, world.door);
  const double solid_angle = 2 * std::numbers::pi * (1 - std::cos(half_angle * std::numbers::pi / 180));
  rescale(light, "power", 1 / solid_angle, sent, world);
  const Imath::V3d from = moved(p.point("from", {0, 0, 0}, world.door), m);
  const Imath::V3d to = moved(p.point("to", {0, 0, 1}, world.door), m);
  add_lamp(spec::SpotLamp{{from, to - from, half_angle},
                          emission_of<spec::PointEmission, Quantity::luminous_intensity>(sent)},
           light.where, world.door);
}

void add_distant(const Made& light, const Imath::M44d& m, World& world) {
  LampSpectrum sent = lamp(light, "L", world);
  rescale(light, "illuminance", 1, sent, world);
  const Imath::V3d from = moved(light.parameters.point("from", {0, 0, 0}, world.door), m);
  const Imath::V3d to = moved(light.parameters.point("to", {0, 0, 1}, world.door), m);
  spec::BeamLamp beam;
  beam.source.towards = from - to;
  beam.emission = emission_of<spec::BeamEmission, Quantity::illuminance>(sent);
  add_lamp(beam, light.where, world.door);
}

// The lamp of an image's mean, which is that of the light from all sides, for its pixels are equal areas. It
// is normalised where the light asks for an illuminance. Nothing, after an error or a note, without such an
// image.
std::optional<LampSpectrum> mean_lamp(const Made& light, const Parameter& file, World& world) {
  Door& door = world.door;
  auto colour = mean_colour(world.folder / file.texts.front(), file.where, door);
  if (!colour) return std::nullopt;
  const double most = *std::ranges::max_element(*colour);
  if (!(most > 0)) {
    door.note(light.where, "an environment's image is black: dropped");
    return std::nullopt;
  }
  door.note(
      light.where,
      "an environment's image is laid out as equal areas there, which has no counterpart here: its mean "
      "from all sides");
  for (double& value : *colour) value /= most;
  const double scale = light.parameters.number("scale", 1, door);
  LampSpectrum sent = lamp_of(*colour, scale * most, light.where, door);
  if (light.parameters.number("illuminance", 0, door) > 0) sent.photometric = kLuminousEfficacy * scale;
  return sent;
}

void add_infinite(const Made& light, World& world) {
  const Parameter* file = light.parameters.find("filename", {"string"}, world.door);
  const std::optional<LampSpectrum> said =
      file ? mean_lamp(light, *file, world) : std::optional(lamp(light, "L", world));
  if (!said) return;
  LampSpectrum sent = *said;
  rescale(light, "illuminance", 1 / std::numbers::pi, sent, world);
  light.parameters.ignore({"portal"});
  spec::SkyLamp sky;
  sky.emission = emission_of<spec::SkyEmission, Quantity::luminance>(sent);
  sky.source.where = light.where;
  add_lamp(sky, light.where, world.door);
}

}  // namespace

spec::Emission area_emission(const Made& light, const std::vector<double>& faces, World& world) {
  if (light.type != "diffuse")
    world.door.diagnostics.error(light.where,
                                 unknown_name("area light", light.type, std::vector<std::string>{"diffuse"}));
  LampSpectrum sent = lamp(light, "L", world);
  const double power = light.parameters.number("power", 0, world.door);
  if (!(power > 0) || !sent.photometric) return emission_of<spec::LampEmission, Quantity::luminance>(sent);
  *sent.photometric *= power * static_cast<double>(faces.size());
  constexpr double kAlike = 1e-5;
  const auto [least, most] = std::ranges::minmax(faces);
  if (most - least > kAlike * most)
    world.door.note(
        light.where,
        "faces of different areas with a \"power\" each are not equally bright there: their power "
        "is spread evenly here");
  return emission_of<spec::LampEmission, Quantity::luminous_flux>(sent);
}

void add_light(const Made& light, const Imath::M44d& to_world, World& world) {
  if (light.type == "point") {
    add_point(light, to_world, world);
  } else if (light.type == "spot") {
    add_spot(light, to_world, world);
  } else if (light.type == "distant") {
    add_distant(light, to_world, world);
  } else if (light.type == "infinite") {
    add_infinite(light, world);
  } else if (std::ranges::find(kLightTypes, light.type) == kLightTypes.end()) {
    world.door.diagnostics.error(light.where, unknown_name("light", light.type, kLightTypes));
  } else {
    world.door.note(light.where, fmt::format("a light \"{}\" has no counterpart here: dropped", light.type));
    return;
  }
  light.parameters.note_unused(fmt::format("light \"{}\"", light.type), world.door);
}

}  // namespace abbe::doors::pbrt
