#include "description/doors/mitsuba/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "description/doors/mitsuba/spectra.h"
#include "description/doors/shared/lamps.h"
#include "description/doors/shared/placement.h"
#include "scene/lights/environment_image.h"

namespace abbe::doors::mitsuba {
namespace {

using Imath::M44d;
using Imath::V3d;
using spec::Quantity;

const std::vector<std::string> kLightTypes{"area",  "constant",  "directional", "directionalarea", "envmap",
                                           "point", "projector", "spot",        "sunsky"};

M44d placed(const Object& light, const World& world) {
  return light.transform("to_world") * world.upright;
}

V3d direction(const V3d& local, const M44d& m) {
  V3d to;
  m.multDirMatrix(local, to);
  return to;
}

void add_point(const Object& light, const World& world) {
  const V3d at = light.point("position", {0, 0, 0}) * placed(light, world);
  const auto emission =
      emission_of<spec::PointEmission, Quantity::luminous_intensity>(lamp(light, "intensity", world));
  add_lamp(spec::PointLamp{{at}, emission}, light.where(), world.door);
}

void add_spot(const Object& light, const World& world) {
  const M44d m = placed(light, world);
  const double cutoff = light.number("cutoff_angle", 20);
  const double beam = light.number("beam_width", 0.75 * cutoff);
  spec::SpotLamp spot;
  spot.source = {V3d(0, 0, 0) * m, direction({0, 0, 1}, m),
                 hard_cone(beam, cutoff, Falloff::linear_angle, light.where(), world.door)};
  spot.emission =
      emission_of<spec::PointEmission, Quantity::luminous_intensity>(lamp(light, "intensity", world));
  add_lamp(spot, light.where(), world.door);
}

void add_directional(const Object& light, const World& world) {
  const M44d m = placed(light, world);
  const V3d along = light.has("direction") ? direction(light.point("direction", {0, 0, 1}), world.upright)
                                           : direction({0, 0, 1}, m);
  spec::BeamLamp beam;
  beam.source.towards = -along;
  beam.emission = emission_of<spec::BeamEmission, Quantity::illuminance>(lamp(light, "irradiance", world));
  add_lamp(beam, light.where(), world.door);
}

void add_sky(const Object& light, const World& world) {
  spec::SkyLamp sky;
  sky.source.where = light.where();
  sky.emission = emission_of<spec::SkyEmission, Quantity::luminance>(lamp(light, "radiance", world));
  add_lamp(sky, light.where(), world.door);
}

// An image whose middle looks along z, with y up, before it is turned.
void add_sky_image(const Object& light, const World& world) {
  const auto path = world.folder / light.text("filename", "");
  if (!world.door.take_file(path, light.where())) return;
  const M44d m = placed(light, world);
  const V3d up = direction({0, 1, 0}, m).normalized();
  const V3d onwards = direction({0, 0, 1}, m).normalized();
  if (mirrors(m)) world.door.note(light.where(), "an environment's image is not mirrored here");
  const V3d reference = environment_frame(up, 0).forward;
  const double turn =
      std::atan2(reference.cross(onwards).dot(up), reference.dot(onwards)) * 180 / std::numbers::pi;
  spec::SkyImage image;
  image.file = {{world.door.name_of(path)}, light.where()};
  image.up = up;
  image.rotate_deg = turn;
  spec::SkyLamp sky;
  sky.source = {image, light.where()};
  const LampSpectrum white =
      lamp_of(LinearRgb{1, 1, 1}, light.number("scale", 1) * y_of_one(), light.where(), world.door);
  sky.emission = emission_of<spec::SkyEmission, Quantity::luminance>(white);
  add_lamp(sky, light.where(), world.door);
}

}  // namespace

spec::Emission area_emission(const Object& light, const World& world) {
  if (light.type() != "area")
    world.door.diagnostics.error(light.where(),
                                 unknown_name("area light", light.type(), std::vector<std::string>{"area"}));
  return emission_of<spec::LampEmission, Quantity::luminance>(lamp(light, "radiance", world));
}

void add_light(const Object& light, const World& world) {
  light.ignore({"sampling_weight"});
  const std::string& type = light.type();
  if (type == "point") {
    add_point(light, world);
  } else if (type == "spot") {
    add_spot(light, world);
  } else if (type == "directional") {
    add_directional(light, world);
  } else if (type == "constant") {
    add_sky(light, world);
  } else if (type == "envmap") {
    add_sky_image(light, world);
  } else if (std::ranges::find(kLightTypes, type) == kLightTypes.end()) {
    world.door.diagnostics.error(light.where(), unknown_name("emitter", type, kLightTypes));
  } else {
    world.door.note(light.where(), fmt::format("an emitter \"{}\" has no counterpart here: dropped", type));
    return;
  }
  light.note_unused();
}

}  // namespace abbe::doors::mitsuba
