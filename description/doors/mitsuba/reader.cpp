#include "description/doors/mitsuba/reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "description/doors/mitsuba/lights.h"
#include "description/doors/mitsuba/shapes.h"
#include "description/doors/shared/camera.h"
#include "io/text.h"
#include "sampling/angle.h"

namespace abbe::doors {
namespace mitsuba {
namespace {

// A number of things, cut to what an int holds.
int count(const Object& object, std::string_view name, int absent) {
  return static_cast<int>(std::clamp(object.number(name, absent), -1e9, 1e9));
}

// Names what other elements refer to.
void name_elements(const Element& element, World& world) {
  for (const Element& child : element.children) {
    const std::string& id = child["id"];
    if (!id.empty() && child.tag != "ref" && !world.ids.try_emplace(id, &child).second)
      world.door.diagnostics.error(child.where, fmt::format("a second element of the id \"{}\"", id));
    name_elements(child, world);
  }
}

// The tangent of half the view along the shorter axis, of a view that is said along another.
double half_view(const Object& sensor, double width, double height, const World& world) {
  if (sensor.has("fov") && sensor.has("focal_length"))
    world.door.diagnostics.error(sensor.place_of("focal_length"),
                                 "a view takes \"fov\" or \"focal_length\", not both");
  const double shorter = std::min(width, height);
  const double diagonal = std::hypot(width, height);
  if (!sensor.has("fov")) {  // on a film of 36 mm x 24 mm
    const std::string focal_length = sensor.text("focal_length", "50mm");
    const auto mm = numbers_of(focal_length.substr(0, focal_length.find("mm")));
    if (mm && mm->size() == 1 && mm->front() > 0)
      return std::hypot(36, 24) / 2 / mm->front() * shorter / diagonal;
    world.door.diagnostics.error(sensor.where(),
                                 fmt::format("expected a focal length in mm (got \"{}\")", focal_length));
    return 1;
  }
  const std::vector<std::string> axes{"diagonal", "larger", "smaller", "x", "y"};
  const std::array lengths{diagonal, std::max(width, height), shorter, width, height};
  const std::string axis = lower_case(sensor.text("fov_axis", "x"));
  const auto along = static_cast<std::size_t>(std::ranges::find(axes, axis) - axes.begin());
  if (along < axes.size())
    return std::tan(sensor.number("fov", 0) * kDegree / 2) * shorter / lengths.at(along);
  world.door.diagnostics.error(sensor.place_of("fov_axis"), unknown_name("axis", axis, axes));
  return 1;
}

void note_film(const Object& film, const World& world) {
  for (const Element* filter : film.all("rfilter"))
    if ((*filter)["type"] != "box")
      world.door.note(filter->where, "a pixel filter has no counterpart here: a box");
  if (film.type() == "specfilm")
    world.door.note(film.where(),
                    "channels of a film have no counterpart here: the CIE observer in their place");
  film.ignore({"pixel_format", "component_format", "file_format", "sample_border", "compensate", "banner"});
}

// Resolution and output of the film, the samples, and what else the sensor holds.
std::array<std::int64_t, 2> read_film(const Object& sensor, const World& world) {
  Door& door = world.door;
  door.scene.sensor.emplace().counts = spec::StandardObserver{{{Observer::cie1931}, sensor.where()}};
  std::array<std::int64_t, 2> resolution{768, 576};
  for (const Element* element : sensor.all("film")) {
    const Object film(*element, world);
    resolution = {count(film, "width", 768), count(film, "height", 576)};
    note_film(film, world);
    film.note_unused();
  }
  for (const Element* element : sensor.all("sampler")) {
    const Object sampler(*element, world);
    door.scene.render->samples = std::max(1, count(sampler, "sample_count", 4));
    sampler.ignore({"seed", "jitter"});
    sampler.note_unused();
  }
  return resolution;
}

constexpr double kFarClip = 1e4;

// Planes are noted that cut off more than those that hold where none are said.
void note_clip_planes(const Object& sensor, const World& world) {
  constexpr double kNear = 1e-2;
  const double near = sensor.number("near_clip", kNear);
  const double far = sensor.number("far_clip", kFarClip);
  if (near <= kNear && far >= kFarClip) return;
  world.door.note(
      sensor.where(),
      fmt::format("clip planes have no counterpart here: what is nearer than {:g} or farther than "
                  "{:g} is seen",
                  near, far));
}

void read_sensor(const Object& sensor, World& world) {
  Door& door = world.door;
  const std::vector<std::string> types{"batch",       "distant",       "irradiancemeter", "orthographic",
                                       "perspective", "radiancemeter", "thinlens"};
  if (std::ranges::find(types, sensor.type()) == types.end())
    return door.diagnostics.error(sensor.where(), unknown_name("sensor", sensor.type(), types));
  if (sensor.type() != "perspective" && sensor.type() != "thinlens")
    door.note(sensor.where(),
              fmt::format("a sensor \"{}\" has no counterpart here: perspective", sensor.type()));
  GivenCamera camera;
  camera.where = sensor.where();
  camera.resolution = read_film(sensor, world);
  if (camera.resolution[0] < 1 || camera.resolution[1] < 1)
    return door.diagnostics.error(sensor.where(), "a film needs a pixel or more each way");
  // x runs to the left there.
  camera.to_world = scaling({-1, 1, 1}) * sensor.transform("to_world");
  world.upright = upright_world(camera.to_world);
  if (world.upright != Imath::M44d())
    door.note(sensor.where(), "the camera sees a mirror image of right-handed space: x is turned round");
  camera.to_world = camera.to_world * world.upright;
  const auto width = static_cast<double>(camera.resolution[0]);
  const auto height = static_cast<double>(camera.resolution[1]);
  camera.fov_deg = 2 * std::atan(half_view(sensor, width, height, world)) / kDegree;
  if (sensor.type() == "thinlens") {
    camera.lens_radius = sensor.number("aperture_radius", 0);
    camera.focus_distance = sensor.number("focus_distance", sensor.number("far_clip", kFarClip));
  }
  note_clip_planes(sensor, world);
  sensor.ignore({"shutter_open", "shutter_close"});
  sensor.note_unused();
  set_camera(camera, door);
}

const std::vector<std::string> kIntegratorTypes{
    "aov",       "depth",          "direct",     "direct_projective", "moment", "path",    "prb",
    "prb_basic", "prb_projective", "prbvolpath", "ptracer",           "stokes", "volpath", "volpathmis"};

// Depths count the light as well there. Integrators for derivatives have a depth when none is said.
void limit_depth(const Object& integrator, const World& world) {
  const std::string& type = integrator.type();
  if (type.starts_with("direct")) return world.door.limit_depth(1, integrator.where());
  const int depth = count(integrator, "max_depth", type.starts_with("prb") ? 6 : -1);
  if (depth >= 0) world.door.limit_depth(depth - 1, integrator.where());
}

void read_integrator(const Object& integrator, const World& world) {
  Door& door = world.door;
  const std::string& type = integrator.type();
  if (std::ranges::find(kIntegratorTypes, type) == kIntegratorTypes.end())
    return door.diagnostics.error(integrator.where(), unknown_name("integrator", type, kIntegratorTypes));
  const bool of_another = type == "aov" || type == "depth" || type == "moment" || type == "stokes";
  if (!of_another && type.find("volpath") == std::string::npos) door.surface_integrator = type;
  if (of_another)
    door.note(
        integrator.where(),
        fmt::format("what an integrator \"{}\" tells has no counterpart here: a picture of light", type));
  for (const Element* within : integrator.all("integrator")) read_integrator(Object(*within, world), world);
  limit_depth(integrator, world);
  integrator.ignore({"rr_depth", "samples_per_pass", "block_size", "emitter_samples", "bsdf_samples",
                     "shading_samples", "aovs"});
  integrator.note_unused();
}

void read_scene(const Element& root, World& world) {
  Door& door = world.door;
  door.scene.render.emplace();
  const Object scene(root, world);
  const auto sensors = scene.all("sensor");
  if (sensors.empty()) return door.diagnostics.error(root.where, "a scene without a sensor");
  if (sensors.size() > 1) door.note(sensors[1]->where, "a scene has one camera here: the first");
  read_sensor(Object(*sensors.front(), world), world);
  for (const Element* integrator : scene.all("integrator"))
    read_integrator(Object(*integrator, world), world);
  Materials materials(world);
  for (const Element* shape : scene.all("shape"))
    add_shape(Object(*shape, world), Among::scene, door.scene.shapes, materials, world);
  for (const Element* light : scene.all("emitter")) add_light(Object(*light, world), world);
  // What only others refer to.
  (void)scene.all("bsdf");
  (void)scene.all("medium");
  (void)scene.all("texture");
  scene.note_unused();
}

}  // namespace
}  // namespace mitsuba

bool read_mitsuba(const std::filesystem::path& file, Door& door) {
  const auto root = mitsuba::read_xml(file, door);
  if (!root) return false;
  mitsuba::World world{door, file.parent_path()};
  mitsuba::name_elements(*root, world);
  mitsuba::find_matter(*root, world);
  mitsuba::read_scene(*root, world);
  return !door.diagnostics.has_errors();
}

}  // namespace abbe::doors
