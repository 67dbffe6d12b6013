#include "description/scene.h"

#include <array>

#include <fmt/format.h>

#include "description/checks.h"
#include "io/schema/write.h"
#include "scene/shapes/shape.h"
#include "scene/white.h"
#include "scene/working_range.h"
#include "sensor/response/table_range.h"

namespace abbe::spec {

using namespace schema;

static Fields fields(Tag<Output>) {
  return describe(
      "output", "Output files, relative to the working directory.",
      {field("image", &Output::image, "The film as an EXR file."),
       field("display", &Output::display, "The picture as a PNG, JPEG or TIFF file."),
       field("exposure", &Output::exposure, {0, 1e30, true, false},
             "Film value shown as diffuse white; chosen from the image if absent."),
       field("white", &Output::white, white(),
             "Reference white of the picture: the name of a light, else of an illuminant or its file, or "
             "chromaticity coordinates [x, y]. If absent, the light that exposes the film most.")});
}

ValueType units() {
  return enumeration<Unit>("unit of length", {"m", "cm", "mm", "um", "in"});
}

double metres(Unit unit) {
  constexpr std::array kMetres{1.0, 1e-2, 1e-3, 1e-6, 0.0254};
  return kMetres.at(static_cast<std::size_t>(unit));
}

Fields fields(Tag<Scene>) {
  return describe(
      "Abbe scene", "Lengths are in `units`, wavelengths in nm.",
      {field("$schema", &Scene::schema, "Location of this schema, for editors."),
       field("abbe", &Scene::version, {kFormatVersion, kFormatVersion}, "Version of the scene format."),
       defaulted("units", &Scene::units, units(), "Unit of length."), field("camera", &Scene::camera),
       field("sensor", &Scene::sensor, "The sensor; required with a camera."),
       defaulted("meters", &Scene::meters, by_name<Meter>("an object of meters by name", 0),
                 "Light meters by name, for `abbe meter`."),
       defaulted("materials", &Scene::materials, materials(), "Materials by name."),
       defaulted("objects", &Scene::objects, by_name<Object>("an object of objects by name", 0),
                 "Objects by name, for instances."),
       defaulted("shapes", &Scene::shapes, list<Shape>("shapes", 0), "Shapes of the scene."),
       defaulted("lights", &Scene::lights, list<Light>("lights", 0), "Lights of the scene."),
       field("render", &Scene::render), field("output", &Scene::output)},
      {"camera", "meters"});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

OutputSettings build(const spec::Output& spec, LoadContext& context, const Scene& scene) {
  OutputSettings output{spec.image.value_or(""), spec.display.value_or(""), spec.exposure, {}};
  if (!spec.white) return output;
  WhiteNames names = white_names(scene.lights, film_observer_of(scene));
  names.illuminant = [&context](const schema::Located<std::string>& name) {
    return context.table(name.value, name.where);
  };
  output.white = abbe::build(*spec.white, names, context.diagnostics);
  if (has_colors(scene)) return output;
  context.diagnostics.warning(spec.white->where,
                              "white has no effect: the sensor has neither three channels nor a spectrum");
  output.white.reset();
  return output;
}

void build_sensor(const spec::Scene& spec, LoadContext& context, Scene& scene) {
  // Earlier errors may be the reason why a key is missing.
  if (!context.diagnostics.has_errors() && !spec.camera)
    context.diagnostics.error(spec.where, "the scene has meters but no camera: use abbe meter");
  else if (!context.diagnostics.has_errors() && !spec.sensor)
    context.diagnostics.error(spec.where, "missing key \"sensor\"");
  Sensor sensor;
  const bool probe = spec.camera && std::holds_alternative<spec::Probe>(spec.camera->kind);
  if (spec.sensor) {
    sensor = build(*spec.sensor, probe, context);
    scene.sensor_text = to_text(schema::write(*spec.sensor));
    if (spec.sensor->shutter) context.open_s = spec.sensor->shutter->open_s;
    context.span_s = sensor.exposure_s * sensor.shutter.span();
  }
  if (spec.camera)
    if (const auto camera = build(*spec.camera, sensor, context)) scene.camera = *camera;
  if (spec.camera && spec.camera->motion) set_moving(*spec.camera->motion, scene.camera, context);
  scene.exposure_s = sensor.exposure_s;
  scene.shutter = sensor.shutter;
  scene.readout = sensor.readout;
  scene.fill_factor = sensor.fill_factor;
  scene.mosaic = std::move(sensor.mosaic);
  scene.spectral = sensor.spectral;
  scene.channels = std::move(sensor.channels);
  for (Channel& channel : scene.channels) limit_angles(channel, min_film_cosine(scene.camera));
}

// A meter is exposed to motion for as long as the first row of the sensor.
void set_meter(const spec::Scene& spec, const Meter& meter, LoadContext& context, Scene& scene) {
  if (spec.sensor) scene.exposure_s = spec.sensor->exposure_s;
  if (spec.sensor && spec.sensor->shutter) context.open_s = spec.sensor->shutter->open_s;
  context.span_s = scene.exposure_s;
  scene.camera = camera_of(meter);
  scene.channels = channels_of(meter);
}

// Exposures of channels follow each other in time, so in a scene with motion they must be equal.
void check_exposures(const spec::Scene& spec, const LoadContext& context, const Scene& scene) {
  if (context.motions.empty()) return;
  for (const Channel& channel : scene.channels)
    if (channel.exposure_ratio != 1)
      context.diagnostics.error(
          spec.sensor->where,
          fmt::format("in a scene with motion all channels must have the same exposure time (got {} s of "
                      "channel \"{}\", allowed {} s)",
                      channel.exposure_ratio * scene.exposure_s, channel.name, scene.exposure_s));
}

// Translates the scene so that its working range is centered on the origin, where single precision resolves
// best. Until here all coordinates are in double precision.
void recentre(Scene& scene, const LoadContext& context) {
  scene.origin_m = working_range_of(scene.camera, scene.shapes).origin;
  for (ShapeInstance& instance : scene.shapes)
    std::visit([&](auto& shape) { shift(shape, -scene.origin_m); }, instance.shape);
  for (const auto& at : context.placements) {
    at->to_world = at->to_world * Imath::M44d().setTranslation(-scene.origin_m);
    at->to_prototype = at->to_world.inverse();
    at->described_origin -= scene.origin_m;
  }
  for (const auto& motion : context.motions) motion->recentre(scene.origin_m);
  for (Material& material : scene.materials)
    if (auto* medium = std::get_if<MediumMaterial>(&material.model); medium && medium->interior_medium.grid) {
      medium->interior_medium.grid->from -= scene.origin_m;
      medium->interior_medium.grid->to -= scene.origin_m;
    }
  translate(scene.camera, -scene.origin_m);
}

}  // namespace

std::vector<Meter> build_meters(const spec::Scene& spec, LoadContext& context) {
  context.unit_m = spec::metres(spec.units);
  return build(spec.meters, context);
}

Scene build(const spec::Scene& spec, LoadContext& context, const Meter* meter) {
  Scene scene{};
  scene.unit_m = context.unit_m = spec::metres(spec.units);
  // The sensor precedes the lights: they may be sampled by what they expose, and their tables must cover its
  // range.
  if (meter != nullptr)
    set_meter(spec, *meter, context, scene);
  else
    build_sensor(spec, context, scene);
  context.coverage.needed = needed_by(scene.channels);
  if (meter == nullptr) context.coverage.channels = scene.channels;
  build_materials(spec.materials, context, scene);
  build_objects(spec.objects, context, scene);
  build_shapes(spec.shapes, context, scene);
  const AreaLightShapes surfaces = build_area_light_shapes(spec.lights, context, scene);
  if (!context.diagnostics.has_errors()) recentre(scene, context);
  build_lights(spec.lights, surfaces, context, scene);
  if (spec.render) scene.render = build(*spec.render, context.unit_m, context.diagnostics);
  if (spec.output && meter == nullptr) scene.output = build(*spec.output, context, scene);
  if (meter == nullptr) (void)build_meters(spec, context);
  check_exposures(spec, context, scene);
  if (context.diagnostics.has_errors()) return scene;
  check_validity(spec.materials, context, scene);
  check_lights(context, scene);
  check_precision(meter == nullptr ? spec.camera->where : spec.where, context, scene);
  if (scene.lights.empty())
    context.diagnostics.error_if_strict(spec.where, "no light: the image will be black");
  return scene;
}

}  // namespace abbe::description
