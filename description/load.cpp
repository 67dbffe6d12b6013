#include "description/load.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "description/camera.h"
#include "description/checks.h"
#include "description/light.h"
#include "description/material.h"
#include "description/render.h"
#include "description/sensor.h"
#include "description/shape.h"
#include "description/white.h"
#include "io/schema/read.h"
#include "io/standard_stream.h"
#include "io/text.h"
#include "materials/index/library.h"
#include "scene/colors.h"
#include "scene/extent.h"
#include "scene/shapes/placed.h"

namespace abbe {
namespace description {
namespace {

constexpr double kFormatVersion = 1;

// False for a scene of another version, whose other errors are not ours to tell.
bool check_version(ObjectReader& reader, LoadContext& context) {
  const JsonValue* json = reader.require("abbe");
  if (!json) return true;
  const auto version = read_number(*json, Range::any(), context.diagnostics);
  if (!version || *version == kFormatVersion) return true;
  const std::string_view what =
      *version > kFormatVersion ? "future version of the scene format" : "no version of the scene format";
  context.diagnostics.error(json->where,
                            fmt::format("{} (got {}, allowed {})", what, *version, kFormatVersion));
  return false;
}

void read_units(ObjectReader& reader, LoadContext& context) {
  constexpr std::array kMetres{1.0, 1e-2, 1e-3, 1e-6, 0.0254};
  const JsonValue* json = reader.find("units");
  if (!json) return;
  if (const auto unit =
          read_choice(*json, "unit of length", {"m", "cm", "mm", "um", "in"}, context.diagnostics))
    context.unit_m = kMetres.at(*unit);
}

std::optional<White> read_white(const JsonValue& json, LoadContext& context, const Scene& scene) {
  WhiteNames names = white_names(scene.lights, context.diagnostics);
  names.illuminant = [&context](const JsonValue& name) { return context.table(name); };
  return read_white(json, names, context.diagnostics);
}

OutputSettings read_output(const JsonValue& json, LoadContext& context, const Scene& scene) {
  OutputSettings output;
  ObjectReader reader(json, context.diagnostics);
  if (const auto path = reader.string("image")) output.image = *path;
  if (const auto path = reader.string("display")) output.display = *path;
  output.display_exposure = reader.number("exposure", {0, 1e30, true, false});
  if (const JsonValue* white = reader.find("white")) {
    output.white = read_white(*white, context, scene);
    if (!has_colors(scene)) {
      context.diagnostics.warning(
          white->where, "a white without effect: the sensor has neither three channels nor a spectrum");
      output.white.reset();
    }
  }
  reader.finish();
  return output;
}

// Moves the scene so that (0, 0, 0), where floats are finest, is where they are to be; everything up to here
// is in double.
void recentre(Scene& scene, LoadContext& context) {
  const std::vector<Imath::V3d>& light_positions = context.light_positions;
  scene.origin_m = extent_of(scene.camera, scene.shapes).origin;
  for (ShapeInstance& instance : scene.shapes)
    std::visit([&](auto& shape) { shift(shape, -scene.origin_m); }, instance.shape);
  for (const auto& at : context.placements)
    *at = placement(at->to_world * Imath::M44d().setTranslation(-scene.origin_m));
  for (Material& material : scene.materials)
    if (auto* medium = std::get_if<MediumMaterial>(&material.model); medium && medium->filling.grid) {
      medium->filling.grid->from -= scene.origin_m;
      medium->filling.grid->to -= scene.origin_m;
    }
  translate(scene.camera, -scene.origin_m);
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Imath::V3f at(light_positions[i] - scene.origin_m);
    if (auto* point = std::get_if<PointLight>(&scene.lights[i].kind)) point->position = at;
    if (auto* spot = std::get_if<SpotLight>(&scene.lights[i].kind)) spot->position = at;
  }
}

std::string hash(const SourceText& source, std::span<const Override> overrides, const LoadContext& context) {
  std::string all = sha256(source.text);
  for (const Override& o : overrides) all += sha256(o.pointer) + sha256(o.value);
  for (const std::filesystem::path& path : context.files) {
    std::ifstream stream(path, std::ios::binary);
    all += sha256(std::string(std::istreambuf_iterator<char>(stream), {}));
  }
  return sha256(all);
}

Scene read_scene(const JsonValue& root, LoadContext& context) {
  Scene scene{};
  ObjectReader reader(root, context.diagnostics);
  if (!check_version(reader, context)) return scene;
  read_units(reader, context);
  scene.unit_m = context.unit_m;
  const JsonValue* camera = reader.require("camera");
  Sensor sensor;
  if (const JsonValue* json = reader.require("sensor")) {
    if (const auto said = schema::read<spec::Sensor>(*json, context.diagnostics))
      sensor = build(*said, camera && camera->find("irradiance_probe"), context);
    scene.sensor_text = to_text(*json);
  }
  if (camera)
    if (const auto said = schema::read<spec::Camera>(*camera, context.diagnostics))
      if (const auto found = build(*said, sensor, context)) scene.camera = *found;
  scene.exposure_s = sensor.exposure_s;
  scene.readout = sensor.readout;
  scene.fill_factor = sensor.fill_factor;
  scene.mosaic = std::move(sensor.mosaic);
  scene.spectral = sensor.spectral;
  scene.channels = std::move(sensor.channels);  // before the lights, which may be sampled by what they expose
  for (Channel& channel : scene.channels) limit_angles(channel, least_film_cosine(scene.camera));
  // What is sound of them is built all the same, for its complaints.
  spec::Materials materials;
  std::vector<schema::Named<spec::Object>> objects;
  std::vector<spec::Shape> shapes;
  std::vector<spec::Light> lights;
  const auto read = [&](const char* key, const schema::Kind& kind, void* list) {
    if (const JsonValue* json = reader.find(key)) (void)schema::read(*json, kind, list, context.diagnostics);
  };
  read("materials", spec::materials(), &materials);
  build_materials(materials, context, scene);
  read("objects", spec::objects(), &objects);
  read("shapes", spec::shapes(), &shapes);
  read("lights", spec::lights(), &lights);
  build_objects(objects, context, scene);
  build_shapes(shapes, context, scene);
  build_lights(lights, context, scene);
  if (const JsonValue* json = reader.find("render"))
    if (const auto render = schema::read<spec::Render>(*json, context.diagnostics))
      scene.render = build(*render, context.diagnostics);
  if (const JsonValue* json = reader.find("output")) scene.output = read_output(*json, context, scene);
  reader.finish();
  if (context.diagnostics.has_errors()) return scene;
  check_validity(materials, context, scene);
  check_lamps(context, scene);
  if (scene.lights.empty())
    context.diagnostics.error_if_strict(root.where, "no light: the image will be black");
  return scene;
}

}  // namespace

std::optional<std::filesystem::path> LoadContext::file(const std::string& name, const SourcePosition& where) {
  if (name.find("://") != std::string::npos) {
    diagnostics.error(where, fmt::format("expected a file (got the URL \"{}\")", name), ErrorCode::input);
    return std::nullopt;
  }
  remember(folder / name);
  return files.back();
}

void LoadContext::remember(const std::filesystem::path& file) {
  files.push_back(file);
  if (inputs != nullptr) inputs->add_file(file);
}

void LoadContext::take_memory(const std::string& what, std::size_t bytes) const {
  if (inputs != nullptr) inputs->take_memory(what, bytes);
}

std::optional<std::string> LoadContext::table(const std::string& name, const SourcePosition& where) {
  constexpr std::string_view kExtension = ".csv";  // which a column may follow
  const std::size_t dot = name.find(kExtension);
  if (dot == std::string::npos && !name.ends_with(".json") && !is_refractiveindex_info(name)) return name;
  const std::size_t end = dot == std::string::npos ? name.size() : dot + kExtension.size();
  const auto path = file(name.substr(0, end), where);
  if (!path) return std::nullopt;
  return path->string() + name.substr(end);
}

std::optional<std::string> LoadContext::table(const JsonValue& json) {
  const std::optional<std::string> name = read_string(json, diagnostics);
  return name ? table(*name, json.where) : std::nullopt;
}

}  // namespace description

std::optional<Scene> load_scene(const std::filesystem::path& path, std::span<const Override> overrides,
                                Diagnostics& diagnostics, Inputs* inputs) {
  // Words that cannot be read are the scene's fault; a file that is not there is the caller's.
  std::error_code error;
  const bool there = std::filesystem::is_regular_file(path, error);
  const auto source = path == kStandardStream
                          ? read_standard_input(diagnostics, ErrorCode::scene)
                          : read_text(path, diagnostics, there ? ErrorCode::scene : ErrorCode::input);
  if (!source) return std::nullopt;
  if (inputs && path != kStandardStream) inputs->add_file(path);
  std::optional<JsonValue> root = parse_json(source, diagnostics);
  if (!root) return std::nullopt;
  for (const Override& o : overrides) set_json(*root, o.pointer, o.value, diagnostics);
  description::LoadContext context{diagnostics, path.parent_path(), inputs};
  Scene scene = description::read_scene(*root, context);
  if (diagnostics.has_errors()) return std::nullopt;
  description::recentre(scene, context);
  description::check_precision(*root, context, scene);
  if (diagnostics.has_errors()) return std::nullopt;
  scene.sha256 = description::hash(*source, overrides, context);
  scene.commit();
  return scene;
}

}  // namespace abbe
