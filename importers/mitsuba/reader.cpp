#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "importers/mitsuba/scene_objects.h"
#include "importers/shared/camera.h"
#include "io/text.h"
#include "sampling/angle.h"

namespace abbe::importers {
namespace mitsuba {
namespace {

int count(const Object& object, std::string_view name, int fallback) {
  return static_cast<int>(std::clamp(object.number(name, fallback), -1e9, 1e9));
}

void register_ids(const Element& element, ImportState& state) {
  for (const Element& child : element.children) {
    const std::string& id = child["id"];
    if (!id.empty() && child.tag != "ref" && !state.ids.try_emplace(id, &child).second)
      state.importer.fail(child.where, fmt::format("duplicate id \"{}\"", id));
    register_ids(child, state);
  }
}

// Tangent of half the field of view along the shorter axis, from the axis that the sensor declares.
double tan_half_fov(const Object& sensor, double width, double height) {
  if (sensor.has("fov") && sensor.has("focal_length"))
    sensor.importer().fail(sensor.position_of("focal_length"),
                           "a view takes \"fov\" or \"focal_length\", not both");
  const double shorter = std::min(width, height);
  const double diagonal = std::hypot(width, height);
  if (!sensor.has("fov")) {  // For a film of 36 mm x 24 mm.
    const std::string focal_length = sensor.text("focal_length", "50mm");
    const auto mm = numbers_of(focal_length.substr(0, focal_length.find("mm")));
    if (mm && mm->size() == 1 && mm->front() > 0)
      return std::hypot(36, 24) / 2 / mm->front() * shorter / diagonal;
    sensor.fail(fmt::format("expected a focal length in mm (got \"{}\")", focal_length));
    return 1;
  }
  const std::vector<std::string> axes{"diagonal", "larger", "smaller", "x", "y"};
  const std::array lengths{diagonal, std::max(width, height), shorter, width, height};
  const std::string axis = lower_case(sensor.text("fov_axis", "x"));
  const auto along = static_cast<std::size_t>(std::ranges::find(axes, axis) - axes.begin());
  if (along < axes.size())
    return std::tan(sensor.number("fov", 0) * kDegree / 2) * shorter / lengths.at(along);
  sensor.importer().fail(sensor.position_of("fov_axis"), unknown_name("axis", axis, axes));
  return 1;
}

void note_film(const Object& film) {
  for (const Element* filter : film.all("rfilter"))
    if ((*filter)["type"] != "box")
      film.importer().note(filter->where, "pixel filters are not supported: a box filter is used");
  if (film.type() == "specfilm")
    film.note("spectral channels of a film are not supported: replaced by the CIE observer");
  film.ignore({"pixel_format", "component_format", "file_format", "sample_border", "compensate", "banner"});
}

std::array<std::int64_t, 2> read_film(const Object& sensor) {
  SceneImporter& importer = sensor.importer();
  importer.scene.sensor.emplace().counts = spec::StandardObserver{{{Observer::cie1931}, sensor.where()}};
  std::array<std::int64_t, 2> resolution{768, 576};
  for (const Element* element : sensor.all("film")) {
    const Object film(*element, sensor.state());
    resolution = {count(film, "width", 768), count(film, "height", 576)};
    note_film(film);
    film.note_unused();
  }
  for (const Element* element : sensor.all("sampler")) {
    const Object sampler(*element, sensor.state());
    importer.scene.render->samples = std::max(1, count(sampler, "sample_count", 4));
    sampler.ignore({"seed", "jitter"});
    sampler.note_unused();
  }
  return resolution;
}

constexpr double kFarClip = 1e4;

void note_clip_planes(const Object& sensor) {
  constexpr double kNear = 1e-2;
  const double near = sensor.number("near_clip", kNear);
  const double far = sensor.number("far_clip", kFarClip);
  if (near <= kNear && far >= kFarClip) return;
  sensor.note(fmt::format(
      "clip planes are not supported: objects nearer than {:g} or farther than {:g} are visible", near, far));
}

// Sets camera, sensor and the mirror of the world. Unsupported types of sensors become a perspective camera.
void read_sensor(const Object& sensor, ImportState& state) {
  SceneImporter& importer = state.importer;
  const std::vector<std::string> types{"batch",       "distant",       "irradiancemeter", "orthographic",
                                       "perspective", "radiancemeter", "thinlens"};
  if (!importer.is_known("sensor", sensor.type(), types, sensor.where())) return;
  if (sensor.type() != "perspective" && sensor.type() != "thinlens")
    sensor.note(fmt::format("a sensor \"{}\" is not supported: a perspective camera is used", sensor.type()));
  ImportedCamera camera;
  camera.where = sensor.where();
  camera.resolution = read_film(sensor);
  if (camera.resolution[0] < 1 || camera.resolution[1] < 1)
    return (void)sensor.fail("a film needs at least one pixel along each axis");
  // x points to the left in Mitsuba.
  camera.to_world = scaling({-1, 1, 1}) * sensor.transform("to_world");
  state.world_mirror = world_mirror_of(camera.to_world, camera.where, importer);
  camera.to_world = camera.to_world * state.world_mirror;
  const auto width = static_cast<double>(camera.resolution[0]);
  const auto height = static_cast<double>(camera.resolution[1]);
  camera.fov_deg = 2 * std::atan(tan_half_fov(sensor, width, height)) / kDegree;
  if (sensor.type() == "thinlens") {
    camera.lens_radius = sensor.number("aperture_radius", 0);
    camera.focus_distance = sensor.number("focus_distance", sensor.number("far_clip", kFarClip));
  }
  note_clip_planes(sensor);
  sensor.ignore({"shutter_open", "shutter_close"});
  sensor.note_unused();
  set_camera(camera, importer);
}

const std::vector<std::string> kIntegratorTypes{
    "aov",       "depth",          "direct",     "direct_projective", "moment", "path",    "prb",
    "prb_basic", "prb_projective", "prbvolpath", "ptracer",           "stokes", "volpath", "volpathmis"};

// Sets the maximum depth. Mitsuba's depth counts the light as well. Integrators for derivatives have a
// default depth.
void limit_depth(const Object& integrator) {
  const std::string& type = integrator.type();
  if (type.starts_with("direct")) return integrator.importer().limit_depth(1, integrator.where());
  const int depth = count(integrator, "max_depth", type.starts_with("prb") ? 6 : -1);
  if (depth >= 0) integrator.importer().limit_depth(depth - 1, integrator.where());
}

void read_integrator(const Object& integrator) {
  SceneImporter& importer = integrator.importer();
  const std::string& type = integrator.type();
  if (!importer.is_known("integrator", type, kIntegratorTypes, integrator.where())) return;
  const bool outputs_other_quantity =
      type == "aov" || type == "depth" || type == "moment" || type == "stokes";
  if (!outputs_other_quantity && type.find("volpath") == std::string::npos)
    importer.surface_integrator = type;
  if (outputs_other_quantity)
    integrator.note(
        fmt::format("the output of an integrator \"{}\" is not supported: radiance is rendered", type));
  for (const Element* inner : integrator.all("integrator"))
    read_integrator(Object(*inner, integrator.state()));
  limit_depth(integrator);
  integrator.ignore({"rr_depth", "samples_per_pass", "block_size", "emitter_samples", "bsdf_samples",
                     "shading_samples", "aovs"});
  integrator.note_unused();
}

void read_scene(const Element& root, ImportState& state) {
  SceneImporter& importer = state.importer;
  importer.scene.render.emplace();
  const Object scene(root, state);
  const auto sensors = scene.all("sensor");
  if (sensors.empty()) return (void)scene.fail("the scene has no sensor");
  if (sensors.size() > 1) importer.note(sensors[1]->where, "a scene has one camera: the first is used");
  read_sensor(Object(*sensors.front(), state), state);
  for (const Element* integrator : scene.all("integrator")) read_integrator(Object(*integrator, state));
  Materials materials(state);
  for (const Element* shape : scene.all("shape"))
    add_shape(Object(*shape, state), ShapeOwner::scene, importer.scene.shapes, materials);
  for (const Element* light : scene.all("emitter")) add_light(Object(*light, state));
  // Marks elements that others refer to as used.
  (void)scene.all("bsdf");
  (void)scene.all("medium");
  (void)scene.all("texture");
  scene.note_unused();
}

}  // namespace
}  // namespace mitsuba

bool read_mitsuba(const std::filesystem::path& file, SceneImporter& importer) {
  const auto root = mitsuba::read_xml(file, importer);
  if (!root) return false;
  mitsuba::ImportState state{importer, file.parent_path()};
  mitsuba::register_ids(*root, state);
  mitsuba::collect_dielectric_indices(*root, state);
  mitsuba::read_scene(*root, state);
  return !importer.diagnostics.has_errors();
}

}  // namespace abbe::importers
