#include "importers/pbrt/lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "importers/pbrt/spectra.h"
#include "importers/shared/lights.h"
#include "importers/shared/picture.h"
#include "spectral/colorimetry.h"

namespace abbe::importers::pbrt {
namespace {

using spec::Quantity;

const std::vector<std::string> kLightTypes{"distant", "goniometric", "infinite",
                                           "point",   "projection",  "spot"};
const LinearRgb kWhite{1, 1, 1};

// Emission spectrum of a light. pbrt normalises it to unit luminance and multiplies by "scale".
ImportedLightSpectrum light_spectrum(const Directive& light, std::string_view name, ImportState& state) {
  const double scale = light.parameters.number("scale", 1, state.importer);
  return light_spectrum_of(spectrum(light.parameters, name, kWhite, state), scale, light.where,
                           state.importer);
}

// Scales the emission to a photometric quantity that the parameter `name` requests, such as lumens or lux.
// `factor` converts it to the quantity of `emitted`.
void rescale(const Directive& light, std::string_view name, double factor, ImportedLightSpectrum& emitted,
             ImportState& state) {
  const double requested = light.parameters.number(name, 0, state.importer);
  if (requested > 0 && emitted.photometric) *emitted.photometric *= requested * factor;
}

Imath::V3d transformed(const Imath::V3d& p, const Imath::M44d& m) {
  return p * m;
}

void add_point(const Directive& light, const Imath::M44d& m, ImportState& state) {
  ImportedLightSpectrum emitted = light_spectrum(light, "I", state);
  rescale(light, "power", 1 / (4 * std::numbers::pi), emitted, state);
  const Imath::V3d at = transformed(light.parameters.point("from", {0, 0, 0}, state.importer), m);
  append_light(
      spec::PointLightSource{{at}, emission_of<spec::PointEmission, Quantity::luminous_intensity>(emitted)},
      light.where, state.importer);
}

void add_spot(const Directive& light, const Imath::M44d& m, ImportState& state) {
  const Parameters& p = light.parameters;
  ImportedLightSpectrum emitted = light_spectrum(light, "I", state);
  const double outer = p.number("coneangle", 30, state.importer);
  const double inner = outer - p.number("conedeltaangle", 5, state.importer);
  const double half_angle = hard_cone(inner, outer, Falloff::smooth_cosine, light.where, state.importer);
  const double solid_angle = 2 * std::numbers::pi * (1 - std::cos(half_angle * std::numbers::pi / 180));
  rescale(light, "power", 1 / solid_angle, emitted, state);
  const Imath::V3d from = transformed(p.point("from", {0, 0, 0}, state.importer), m);
  const Imath::V3d to = transformed(p.point("to", {0, 0, 1}, state.importer), m);
  append_light(spec::SpotLightSource{{from, to - from, half_angle},
                                     emission_of<spec::PointEmission, Quantity::luminous_intensity>(emitted)},
               light.where, state.importer);
}

void add_distant(const Directive& light, const Imath::M44d& m, ImportState& state) {
  ImportedLightSpectrum emitted = light_spectrum(light, "L", state);
  rescale(light, "illuminance", 1, emitted, state);
  const Imath::V3d from = transformed(light.parameters.point("from", {0, 0, 0}, state.importer), m);
  const Imath::V3d to = transformed(light.parameters.point("to", {0, 0, 1}, state.importer), m);
  spec::DirectionalLightSource directional;
  directional.source.towards = from - to;
  directional.emission = emission_of<spec::DirectionalLightEmission, Quantity::illuminance>(emitted);
  append_light(directional, light.where, state.importer);
}

// Emission spectrum of the mean of an environment image. Its pixels have equal solid angles, so the mean is
// that of the uniform environment. It is normalised if the light requests an illuminance. Nothing, after an
// error or a note, without a usable image.
std::optional<ImportedLightSpectrum> mean_light_spectrum(const Directive& light, const Parameter& file,
                                                         ImportState& state) {
  SceneImporter& importer = state.importer;
  auto colour = mean_colour(state.folder / file.texts.front(), file.where, importer);
  if (!colour) return std::nullopt;
  const double max_value = *std::ranges::max_element(*colour);
  if (!(max_value > 0)) {
    importer.note(light.where, "an environment image is black: dropped");
    return std::nullopt;
  }
  importer.note(light.where,
                "the equal-area layout of an environment image is not supported: replaced by a uniform "
                "environment of the mean colour");
  for (double& value : *colour) value /= max_value;
  const double scale = light.parameters.number("scale", 1, importer);
  ImportedLightSpectrum emitted = light_spectrum_of(*colour, scale * max_value, light.where, importer);
  if (light.parameters.number("illuminance", 0, importer) > 0)
    emitted.photometric = kLuminousEfficacy * scale;
  return emitted;
}

void add_infinite(const Directive& light, ImportState& state) {
  const Parameter* file = light.parameters.find("filename", {"string"}, state.importer);
  const std::optional<ImportedLightSpectrum> base =
      file ? mean_light_spectrum(light, *file, state) : std::optional(light_spectrum(light, "L", state));
  if (!base) return;
  ImportedLightSpectrum emitted = *base;
  rescale(light, "illuminance", 1 / std::numbers::pi, emitted, state);
  light.parameters.ignore({"portal"});
  spec::EnvironmentLightSource environment;
  environment.emission = emission_of<spec::EnvironmentLightEmission, Quantity::luminance>(emitted);
  environment.source.where = light.where;
  append_light(environment, light.where, state.importer);
}

}  // namespace

spec::Emission area_emission(const Directive& light, const std::vector<double>& faces, ImportState& state) {
  if (light.type != "diffuse")
    state.importer.diagnostics.error(
        light.where, unknown_name("area light", light.type, std::vector<std::string>{"diffuse"}));
  ImportedLightSpectrum emitted = light_spectrum(light, "L", state);
  const double power = light.parameters.number("power", 0, state.importer);
  if (!(power > 0) || !emitted.photometric)
    return emission_of<spec::AreaLightEmission, Quantity::luminance>(emitted);
  *emitted.photometric *= power * static_cast<double>(faces.size());
  constexpr double kSameArea = 1e-5;
  const auto [min_area, max_area] = std::ranges::minmax(faces);
  if (max_area - min_area > kSameArea * max_area)
    state.importer.note(light.where,
                        "\"power\" of pbrt applies to each face, so that faces of different areas differ in "
                        "radiance: Abbe spreads the power evenly");
  return emission_of<spec::AreaLightEmission, Quantity::luminous_flux>(emitted);
}

void add_light(const Directive& light, const Imath::M44d& to_world, ImportState& state) {
  if (light.type == "point") {
    add_point(light, to_world, state);
  } else if (light.type == "spot") {
    add_spot(light, to_world, state);
  } else if (light.type == "distant") {
    add_distant(light, to_world, state);
  } else if (light.type == "infinite") {
    add_infinite(light, state);
  } else if (std::ranges::find(kLightTypes, light.type) == kLightTypes.end()) {
    state.importer.diagnostics.error(light.where, unknown_name("light", light.type, kLightTypes));
  } else {
    state.importer.note(light.where, fmt::format("a light \"{}\" is not supported: dropped", light.type));
    return;
  }
  light.parameters.note_unused(fmt::format("light \"{}\"", light.type), state.importer);
}

}  // namespace abbe::importers::pbrt
