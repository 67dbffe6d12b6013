#include "importers/mitsuba/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "importers/mitsuba/spectra.h"
#include "importers/shared/lights.h"
#include "importers/shared/placement.h"
#include "scene/lights/infinite_light.h"

namespace abbe::importers::mitsuba {
namespace {

using Imath::M44d;
using Imath::V3d;
using spec::Quantity;

const std::vector<std::string> kLightTypes{"area",  "constant",  "directional", "directionalarea", "envmap",
                                           "point", "projector", "spot",        "sunsky"};

M44d light_to_world(const Object& light, const ImportState& state) {
  return light.transform("to_world") * state.world_mirror;
}

V3d direction(const V3d& local, const M44d& m) {
  V3d to;
  m.multDirMatrix(local, to);
  return to;
}

void add_point(const Object& light, const ImportState& state) {
  const V3d at = light.point("position", {0, 0, 0}) * light_to_world(light, state);
  const auto emission = emission_of<spec::PointEmission, Quantity::luminous_intensity>(
      light_spectrum(light, "intensity", state));
  append_light(spec::PointLightSource{{at}, emission}, light.where(), state.importer);
}

void add_spot(const Object& light, const ImportState& state) {
  const M44d m = light_to_world(light, state);
  const double cutoff = light.number("cutoff_angle", 20);
  const double beam_width = light.number("beam_width", 0.75 * cutoff);
  spec::SpotLightSource spot;
  spot.source = {V3d(0, 0, 0) * m, direction({0, 0, 1}, m),
                 hard_cone(beam_width, cutoff, Falloff::linear_angle, light.where(), state.importer)};
  spot.emission = emission_of<spec::PointEmission, Quantity::luminous_intensity>(
      light_spectrum(light, "intensity", state));
  append_light(spot, light.where(), state.importer);
}

void add_directional(const Object& light, const ImportState& state) {
  const M44d m = light_to_world(light, state);
  const V3d along = light.has("direction")
                        ? direction(light.point("direction", {0, 0, 1}), state.world_mirror)
                        : direction({0, 0, 1}, m);
  spec::DirectionalLightSource directional;
  directional.source.towards = -along;
  directional.emission = emission_of<spec::DirectionalLightEmission, Quantity::illuminance>(
      light_spectrum(light, "irradiance", state));
  append_light(directional, light.where(), state.importer);
}

void add_environment(const Object& light, const ImportState& state) {
  spec::EnvironmentLightSource environment;
  environment.source.where = light.where();
  environment.emission = emission_of<spec::EnvironmentLightEmission, Quantity::luminance>(
      light_spectrum(light, "radiance", state));
  append_light(environment, light.where(), state.importer);
}

// Adds an environment map, whose center is along +z with +y up before its transform.
void add_environment_image(const Object& light, const ImportState& state) {
  const auto path = state.folder / light.text("filename", "");
  if (!state.importer.check_file(path, light.where())) return;
  const M44d m = light_to_world(light, state);
  const V3d up = direction({0, 1, 0}, m).normalized();
  const V3d forward = direction({0, 0, 1}, m).normalized();
  if (mirrors(m))
    state.importer.note(light.where(), "mirroring of an environment image is not supported: dropped");
  const V3d reference = environment_frame(up, 0).forward;
  const double turn =
      std::atan2(reference.cross(forward).dot(up), reference.dot(forward)) * 180 / std::numbers::pi;
  spec::EnvironmentImage image;
  image.file = {{state.importer.name_of(path)}, light.where()};
  image.up = up;
  image.rotate_deg = turn;
  spec::EnvironmentLightSource environment;
  environment.source = {image, light.where()};
  const ImportedLightSpectrum white = light_spectrum_of(
      LinearRgb{1, 1, 1}, light.number("scale", 1) * y_integral(), light.where(), state.importer);
  environment.emission = emission_of<spec::EnvironmentLightEmission, Quantity::luminance>(white);
  append_light(environment, light.where(), state.importer);
}

}  // namespace

spec::Emission area_emission(const Object& light, const ImportState& state) {
  if (light.type() != "area")
    state.importer.diagnostics.error(
        light.where(), unknown_name("area light", light.type(), std::vector<std::string>{"area"}));
  return emission_of<spec::AreaLightEmission, Quantity::luminance>(light_spectrum(light, "radiance", state));
}

void add_light(const Object& light, const ImportState& state) {
  light.ignore({"sampling_weight"});
  const std::string& type = light.type();
  if (type == "point") {
    add_point(light, state);
  } else if (type == "spot") {
    add_spot(light, state);
  } else if (type == "directional") {
    add_directional(light, state);
  } else if (type == "constant") {
    add_environment(light, state);
  } else if (type == "envmap") {
    add_environment_image(light, state);
  } else if (std::ranges::find(kLightTypes, type) == kLightTypes.end()) {
    state.importer.diagnostics.error(light.where(), unknown_name("emitter", type, kLightTypes));
  } else {
    state.importer.note(light.where(), fmt::format("an emitter \"{}\" is not supported: dropped", type));
    return;
  }
  light.note_unused();
}

}  // namespace abbe::importers::mitsuba
