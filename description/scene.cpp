#include "description/scene.h"

#include <array>

#include <fmt/format.h>

#include "description/checks.h"
#include "io/schema/write.h"
#include "scene/colors.h"
#include "scene/extent.h"
#include "scene/shapes/placed.h"
#include "sensor/response/coverage.h"

namespace abbe::spec {

using namespace schema;

static Fields fields(Tag<Output>) {
  return describe(
      "output", "What is written, relative to the working directory.",
      {field("image", &Output::image, "The film as an EXR file."),
       field("display", &Output::display, "The picture as a PNG, JPEG or TIFF file."),
       field("exposure", &Output::exposure, {0, 1e30, true, false},
             "Film value shown as diffuse white, chosen from the image when absent."),
       field("white", &Output::white, white(),
             "What is shown as white: the name of a light, else of an illuminant or its file, or "
             "chromaticity coordinates [x, y]; the light that exposes the film most when absent.")});
}

Kind units() {
  return word<Unit>("unit of length", {"m", "cm", "mm", "um", "in"});
}

double metres(Unit unit) {
  constexpr std::array kMetres{1.0, 1e-2, 1e-3, 1e-6, 0.0254};
  return kMetres.at(static_cast<std::size_t>(unit));
}

Fields fields(Tag<Scene>) {
  return describe(
      "Abbe scene", "Lengths are in `units`, wavelengths in nm.",
      {field("$schema", &Scene::schema, "Where editors find this schema."),
       field("abbe", &Scene::version, {kFormatVersion, kFormatVersion}, "Version of the scene format."),
       defaulted("units", &Scene::units, units(), "Unit of length."), field("camera", &Scene::camera),
       field("sensor", &Scene::sensor, "The pixels, and what they count; required with a camera."),
       defaulted("meters", &Scene::meters, by_name<Meter>("an object of meters by name", 0),
                 "What measures light, by name, for `abbe meter`."),
       defaulted("materials", &Scene::materials, materials(), "Materials by name."),
       defaulted("objects", &Scene::objects, by_name<Object>("an object of objects by name", 0),
                 "Shapes by name, for instances to place."),
       defaulted("shapes", &Scene::shapes, list<Shape>("shapes", 0), "What is there."),
       defaulted("lights", &Scene::lights, list<Light>("lights", 0), "What shines."),
       field("render", &Scene::render), field("output", &Scene::output)},
      {"camera", "meters"});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

OutputSettings build(const spec::Output& said, LoadContext& context, const Scene& scene) {
  OutputSettings output{said.image.value_or(""), said.display.value_or(""), said.exposure, {}};
  if (!said.white) return output;
  WhiteNames names = white_names(scene.lights, film_observer_of(scene));
  names.illuminant = [&context](const schema::Located<std::string>& name) {
    return context.table(name.value, name.where);
  };
  output.white = abbe::build(*said.white, names, context.diagnostics);
  if (has_colors(scene)) return output;
  context.diagnostics.warning(said.white->where,
                              "a white without effect: the sensor has neither three channels nor a spectrum");
  output.white.reset();
  return output;
}

// Of a scene of which nothing has been left out for a fault.
void require_camera(const spec::Scene& said, LoadContext& context) {
  if (!said.camera)
    context.diagnostics.error(said.where, "the scene has meters alone, for abbe meter: it has no camera");
  else if (!said.sensor)
    context.diagnostics.error(said.where, "missing key \"sensor\"");
}

void build_sensor(const spec::Scene& said, LoadContext& context, Scene& scene) {
  if (!context.diagnostics.has_errors()) require_camera(said, context);
  Sensor sensor;
  const bool probe = said.camera && std::holds_alternative<spec::Probe>(said.camera->kind);
  if (said.sensor) {
    sensor = build(*said.sensor, probe, context);
    scene.sensor_text = to_text(schema::write(*said.sensor));
    if (said.sensor->shutter) context.open_s = said.sensor->shutter->open_s;
    context.span_s = sensor.exposure_s * sensor.shutter.span();
  }
  if (said.camera)
    if (const auto camera = build(*said.camera, sensor, context)) scene.camera = *camera;
  if (said.camera && said.camera->motion) set_moving(*said.camera->motion, scene.camera, context);
  scene.exposure_s = sensor.exposure_s;
  scene.shutter = sensor.shutter;
  scene.readout = sensor.readout;
  scene.fill_factor = sensor.fill_factor;
  scene.mosaic = std::move(sensor.mosaic);
  scene.spectral = sensor.spectral;
  scene.channels = std::move(sensor.channels);
  for (Channel& channel : scene.channels) limit_angles(channel, least_film_cosine(scene.camera));
}

// A meter sees what moves for as long as the first row of the sensor does.
void set_meter(const spec::Scene& said, const Meter& meter, LoadContext& context, Scene& scene) {
  if (said.sensor) scene.exposure_s = said.sensor->exposure_s;
  if (said.sensor && said.sensor->shutter) context.open_s = said.sensor->shutter->open_s;
  context.span_s = scene.exposure_s;
  scene.camera = camera_of(meter);
  scene.channels = channels_of(meter);
}

// Exposures of channels that follow each other see what moves at different times.
void check_exposures(const spec::Scene& said, const LoadContext& context, const Scene& scene) {
  if (context.motions.empty()) return;
  for (const Channel& channel : scene.channels)
    if (channel.exposure_ratio != 1)
      context.diagnostics.error(
          said.sensor->where,
          fmt::format("where something moves all channels have one exposure time (got {} s of "
                      "channel \"{}\", allowed {} s)",
                      channel.exposure_ratio * scene.exposure_s, channel.name, scene.exposure_s));
}

void set_placement(Placement& at, const Imath::M44d& to_world) {
  at.to_world = to_world;
  at.to_prototype = to_world.inverse();
}

// Moves what there is so that (0, 0, 0), where floats are finest, is where they are to be; everything up to
// here is in double.
void recentre(Scene& scene, const LoadContext& context) {
  scene.origin_m = extent_of(scene.camera, scene.shapes).origin;
  for (ShapeInstance& instance : scene.shapes)
    std::visit([&](auto& shape) { shift(shape, -scene.origin_m); }, instance.shape);
  for (const auto& at : context.placements) {
    set_placement(*at, at->to_world * Imath::M44d().setTranslation(-scene.origin_m));
    at->described_origin -= scene.origin_m;
  }
  for (const auto& motion : context.motions) motion->recentre(scene.origin_m);
  for (Material& material : scene.materials)
    if (auto* medium = std::get_if<MediumMaterial>(&material.model); medium && medium->filling.grid) {
      medium->filling.grid->from -= scene.origin_m;
      medium->filling.grid->to -= scene.origin_m;
    }
  translate(scene.camera, -scene.origin_m);
}

}  // namespace

std::vector<Meter> build_meters(const spec::Scene& said, LoadContext& context) {
  context.unit_m = spec::metres(said.units);
  return build(said.meters, context);
}

Scene build(const spec::Scene& said, LoadContext& context, const Meter* meter) {
  Scene scene{};
  scene.unit_m = context.unit_m = spec::metres(said.units);
  // Before the lights, which may be sampled by what they expose, and whose tables must cover it.
  if (meter != nullptr)
    set_meter(said, *meter, context, scene);
  else
    build_sensor(said, context, scene);
  context.ends.needed = needed_by(scene.channels);
  if (meter == nullptr) context.ends.channels = scene.channels;
  build_materials(said.materials, context, scene);
  build_objects(said.objects, context, scene);
  build_shapes(said.shapes, context, scene);
  const LampSurfaces surfaces = build_lamp_surfaces(said.lights, context, scene);
  if (!context.diagnostics.has_errors()) recentre(scene, context);
  build_lights(said.lights, surfaces, context, scene);
  if (said.render) scene.render = build(*said.render, context.unit_m, context.diagnostics);
  if (said.output && meter == nullptr) scene.output = build(*said.output, context, scene);
  if (meter == nullptr) (void)build_meters(said, context);
  check_exposures(said, context, scene);
  if (context.diagnostics.has_errors()) return scene;
  check_validity(said.materials, context, scene);
  check_lamps(context, scene);
  check_precision(meter == nullptr ? said.camera->where : said.where, context, scene);
  if (scene.lights.empty())
    context.diagnostics.error_if_strict(said.where, "no light: the image will be black");
  return scene;
}

}  // namespace abbe::description
