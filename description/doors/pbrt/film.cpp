#include "description/doors/pbrt/film.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "description/doors/pbrt/named_spectra.h"
#include "description/doors/shared/camera.h"
#include "description/doors/shared/placement.h"
#include "io/extension.h"
#include "sampling/angle.h"

namespace abbe::doors::pbrt {
namespace {

constexpr double kMaxCount = 1e9;

// A number of things, cut to what an int holds.
int count(const Parameters& p, std::string_view name, int absent, Door& door) {
  return static_cast<int>(std::clamp(p.integer(name, absent, door), -kMaxCount, kMaxCount));
}

// What the sensor counts: X, Y and Z, a camera's channels, or radiances.
void set_counts(const Made& film, spec::Sensor& sensor, Door& door) {
  const Parameters& p = film.parameters;
  const std::string name = p.text("sensor", "cie1931", door);
  const auto camera = std::ranges::find(kSensors, name, &Renamed::theirs);
  if (film.type == "spectral")
    sensor.counts =
        spec::Bins{p.number("lambdamin", 360, door), p.number("lambdamax", 830, door), 0, film.where};
  else if (camera != kSensors.end())
    sensor.counts = spec::MeasuredCamera{{{std::string(camera->ours)}, film.where}};
  else
    sensor.counts = spec::StandardObserver{{{Observer::cie1931}, film.where}};
  if (auto* bins = std::get_if<spec::Bins>(&sensor.counts))
    bins->step_nm = (bins->to_nm - bins->from_nm) / std::max(count(p, "nbuckets", 16, door), 1);
  else if (camera == kSensors.end() && name != "cie1931")
    door.note(film.where,
              fmt::format("no table of the sensor \"{}\" is shipped: the CIE observer in its place", name));
}

void set_output(const Parameters& p, Door& door) {
  const std::filesystem::path file = p.text("filename", "", door);
  if (file.empty()) return;
  spec::Output& output = door.scene.output.emplace();
  const std::string name = file.filename().string();
  const std::string extension = extension_of(file);
  (extension == ".exr" ? output.image : output.display) = name;
  if (extension != ".exr" && extension != ".png") {
    door.note(p.all().front().where, "a picture of this format is not written here: no output is named");
    door.scene.output.reset();
  }
}

// The shorter axis's half width in the plane at distance 1, were it not for the angle.
double window_half(const Made& camera, const std::array<std::int64_t, 2>& resolution, Door& door) {
  const std::vector<double> window = camera.parameters.numbers("screenwindow", door);
  if (window.size() != 4) return 1;
  const double half_x = (window[1] - window[0]) / 2;
  const double half_y = (window[3] - window[2]) / 2;
  const double aspect = static_cast<double>(resolution[0]) / static_cast<double>(resolution[1]);
  if (std::abs(window[0] + window[1]) > 1e-6 || std::abs(window[2] + window[3]) > 1e-6 ||
      std::abs(half_x / half_y - aspect) > 1e-3 * aspect)
    door.note(camera.where,
              "a screen window beside the axis, or with pixels that are not square, has no "
              "counterpart here: one of its width in the middle");
  return std::min(half_x, half_y);
}

// There brightness goes with the time that the shutter is open.
void note_exposure(const Made& camera, Door& door) {
  const double opens = camera.parameters.number("shutteropen", 0, door);
  const double closes = camera.parameters.number("shutterclose", 1, door);
  if (!(closes > opens))
    door.diagnostics.error(
        camera.where,
        fmt::format("the shutter {} (got {} and {})",
                    closes < opens ? "closes before it opens" : "does not open", closes, opens));
  else if (closes - opens != 1)
    door.note(camera.where, fmt::format("a shutter that is open for {:.6g} makes a picture as many times as "
                                        "bright there: its times are dropped",
                                        closes - opens));
}

void set_view(const Picture& picture, World& world) {
  Door& door = world.door;
  const Made& camera = *picture.camera;
  if (camera.type != "perspective") {
    const std::vector<std::string> types{"orthographic", "perspective", "realistic", "spherical"};
    if (std::ranges::find(types, camera.type) == types.end())
      door.diagnostics.error(camera.where, unknown_name("camera", camera.type, types));
    else
      door.note(camera.where,
                fmt::format("a camera \"{}\" has no counterpart here: perspective", camera.type));
  }
  GivenCamera given;
  given.where = camera.where;
  given.to_world = picture.camera_to_world * world.upright;
  if (picture.film) {
    const Parameters& film = picture.film->parameters;
    given.resolution = {count(film, "xresolution", 1280, door), count(film, "yresolution", 720, door)};
  } else {
    given.resolution = {1280, 720};
  }
  if (given.resolution[0] < 1 || given.resolution[1] < 1) {
    door.diagnostics.error(picture.film->where, "a film needs a pixel or more each way");
    return;
  }
  const Parameters& p = camera.parameters;
  const double half =
      std::tan(p.number("fov", 90, door) * kDegree / 2) * window_half(camera, given.resolution, door);
  given.fov_deg = 2 * std::atan(half) / kDegree;
  given.lens_radius = p.number("lensradius", 0, door);
  given.focus_distance = p.number("focaldistance", 1e6, door);
  note_exposure(camera, door);
  p.note_unused("camera", door);
  set_camera(given, door);
}

const std::vector<std::string> kIntegratorTypes{
    "ambientocclusion", "bdpt",       "function",      "lightpath", "mlt",    "path",
    "randomwalk",       "simplepath", "simplevolpath", "sppm",      "volpath"};

const std::vector<std::string> kMediumIntegratorTypes{"bdpt", "mlt", "simplevolpath", "volpath"};

void read_integrator(const Made& integrator, Door& door) {
  const std::string& type = integrator.type;
  if (std::ranges::find(kIntegratorTypes, type) == kIntegratorTypes.end())
    return door.diagnostics.error(integrator.where, unknown_name("integrator", type, kIntegratorTypes));
  if (type == "ambientocclusion" || type == "function")
    door.note(
        integrator.where,
        fmt::format("what an integrator \"{}\" tells has no counterpart here: a picture of light", type));
  if (type == "sppm")
    door.note(integrator.where,
              "photons have a depth of their own there, beside that of the paths that meet them: here "
              "\"maxdepth\" is that of both together");
  if (std::ranges::find(kMediumIntegratorTypes, type) == kMediumIntegratorTypes.end())
    door.surface_integrator = type;
  const Parameters& p = integrator.parameters;
  door.limit_depth(count(p, "maxdepth", 5, door), integrator.where);
  // What decides how noisy its picture is.
  p.ignore({"lightsampler", "rrthreshold", "samplelights", "samplebsdf", "cossample", "photonsperiteration",
            "radius", "seed", "mutationsperpixel", "chains", "bootstrapsamples", "largestepprobability",
            "sigma"});
  p.note_unused("integrator", door);
}

// Of a pixel, with pbrt's own numbers for what is absent.
int pixel_samples(const Made& sampler, Door& door) {
  const Parameters& p = sampler.parameters;
  if (sampler.type != "stratified")
    return std::max(1, count(p, "pixelsamples", sampler.type == "independent" ? 4 : 16, door));
  const double all = std::max(1.0, static_cast<double>(count(p, "xsamples", 4, door))) *
                     std::max(1.0, static_cast<double>(count(p, "ysamples", 4, door)));
  return static_cast<int>(std::min(all, kMaxCount));
}

void note_filter(const Made& filter, Door& door) {
  const Parameters& p = filter.parameters;
  if (filter.type == "box" && p.number("xradius", 0.5, door) == 0.5 && p.number("yradius", 0.5, door) == 0.5)
    return;
  door.note(filter.where, "a pixel filter has no counterpart here: a box of one pixel");
}

void set_render(const Picture& picture, Door& door) {
  spec::Render& render = door.scene.render.emplace();
  render.max_depth = 5;  // of the integrator that pbrt takes when none is named
  if (picture.sampler) {
    const Parameters& p = picture.sampler->parameters;
    render.samples = pixel_samples(*picture.sampler, door);
    p.ignore({"jitter", "randomization", "seed"});
    p.note_unused("sampler", door);
  }
  if (picture.integrator) read_integrator(*picture.integrator, door);
}

}  // namespace

void set_picture(const Picture& said, const SourcePosition& end, World& world) {
  Door& door = world.door;
  Picture picture = said;
  if (!picture.camera) {
    door.note(end, "the scene has no camera: pbrt's own, of 90 degrees along z");
    picture.camera = Made{"perspective", {}, end};
  }
  set_render(picture, door);
  spec::Sensor& sensor = door.scene.sensor.emplace();
  if (picture.film) {
    set_counts(*picture.film, sensor, door);
    set_output(picture.film->parameters, door);
    picture.film->parameters.ignore(
        {"xresolution", "yresolution", "savefp16", "diagonal", "maxcomponentvalue"});
  } else {
    sensor.counts = spec::StandardObserver{{{Observer::cie1931}, end}};
  }
  if (picture.filter) note_filter(*picture.filter, door);
  world.upright = upright_world(picture.camera_to_world);
  if (world.upright != Imath::M44d())
    door.note(picture.camera->where,
              "the camera sees a mirror image of right-handed space: x is turned round");
  if (!picture.camera_medium.empty())
    door.note(picture.camera->where, "matter around the camera that no shape encloses is dropped");
  set_view(picture, world);
  if (picture.film) picture.film->parameters.note_unused("film", door);
}

}  // namespace abbe::doors::pbrt
