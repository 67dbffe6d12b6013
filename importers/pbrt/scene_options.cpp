#include "importers/pbrt/scene_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "importers/shared/camera.h"
#include "importers/shared/placement.h"
#include "io/text.h"
#include "sampling/angle.h"

namespace abbe::importers::pbrt {
namespace {

// Cameras of pbrt, case-sensitive, and their tables in `data/camera`. pbrt's other sensors have none.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kSensors{
    {{"canon_eos_5d", "Canon_EOS_5D"},
     {"canon_eos_5d_mkii", "Canon_EOS_5D_Mark_II"},
     {"canon_eos_5d_mkiii", "Canon_EOS_5D_Mark_III"},
     {"canon_eos_5d_mkiv", "Canon_EOS_5D_Mark_IV"},
     {"nikon_d810", "Nikon_D810"},
     {"nikon_d850", "Nikon_D850"},
     {"sony_ilce_7m3", "Sony_ILCE-7M3"}}};

constexpr double kMaxCount = 1e9;

// An integer parameter, clamped to the range of int.
int count(const Parameters& p, std::string_view name, int fallback, SceneImporter& importer) {
  return static_cast<int>(std::clamp(p.integer(name, fallback, importer), -kMaxCount, kMaxCount));
}

// Sets the sensor's responses: X, Y and Z, a camera's channels, or radiance in spectral bands.
void set_counts(const Directive& film, spec::Sensor& sensor, SceneImporter& importer) {
  const Parameters& p = film.parameters;
  const std::string name = p.text("sensor", "cie1931", importer);
  const auto camera = std::ranges::find(kSensors, name, &decltype(kSensors)::value_type::first);
  if (film.type == "spectral")
    sensor.counts =
        spec::Bins{p.number("lambdamin", 360, importer), p.number("lambdamax", 830, importer), 0, film.where};
  else if (camera != kSensors.end())
    sensor.counts = spec::MeasuredCamera{{{std::string(camera->second)}, film.where}};
  else
    sensor.counts = spec::StandardObserver{{{Observer::cie1931}, film.where}};
  if (auto* bins = std::get_if<spec::Bins>(&sensor.counts))
    bins->step_nm = (bins->to_nm - bins->from_nm) / std::max(count(p, "nbuckets", 16, importer), 1);
  else if (camera == kSensors.end() && name != "cie1931")
    importer.note(
        film.where,
        fmt::format("no table of the sensor \"{}\" is shipped: replaced by the CIE observer", name));
}

void set_output(const Parameters& p, SceneImporter& importer) {
  const std::filesystem::path file = p.text("filename", "", importer);
  if (file.empty()) return;
  spec::Output& output = importer.scene.output.emplace();
  const std::string name = file.filename().string();
  const std::string extension = extension_of(file);
  (extension == ".exr" ? output.image : output.display) = name;
  if (extension != ".exr" && extension != ".png") {
    importer.note(p.all().front().where,
                  "the picture format of the output is not supported: no output is set");
    importer.scene.output.reset();
  }
}

// Half width of the screen window along the shorter axis, at distance 1 for a field of view of 90 degrees.
double half_window(const Directive& camera, const std::array<std::int64_t, 2>& resolution,
                   SceneImporter& importer) {
  const std::vector<double> window = camera.parameters.numbers("screenwindow", importer);
  if (window.size() != 4) return 1;
  const double half_x = (window[1] - window[0]) / 2;
  const double half_y = (window[3] - window[2]) / 2;
  const double aspect = static_cast<double>(resolution[0]) / static_cast<double>(resolution[1]);
  if (std::abs(window[0] + window[1]) > 1e-6 || std::abs(window[2] + window[3]) > 1e-6 ||
      std::abs(half_x / half_y - aspect) > 1e-3 * aspect)
    importer.note(camera.where,
                  "a screen window that is off-center or has non-square pixels is not supported: a centered "
                  "one of its width is used");
  return std::min(half_x, half_y);
}

// Notes a shutter time other than 1, which scales the brightness in pbrt.
void note_exposure(const Directive& camera, SceneImporter& importer) {
  const double opens = camera.parameters.number("shutteropen", 0, importer);
  const double closes = camera.parameters.number("shutterclose", 1, importer);
  if (!(closes > opens))
    importer.fail(camera.where,
                  fmt::format("the shutter {} (got {} and {})",
                              closes < opens ? "closes before it opens" : "does not open", closes, opens));
  else if (closes - opens != 1)
    importer.note(
        camera.where,
        fmt::format(
            "the shutter is open for {:.6g}, by which pbrt multiplies the brightness: its times are dropped",
            closes - opens));
}

// Sets a perspective camera, which also replaces unsupported types of cameras.
void set_perspective_camera(const SceneOptions& options, ImportState& state) {
  SceneImporter& importer = state.importer;
  const Directive& camera = *options.camera;
  if (camera.type != "perspective") {
    const std::vector<std::string> types{"orthographic", "perspective", "realistic", "spherical"};
    if (std::ranges::find(types, camera.type) == types.end())
      importer.fail(camera.where, unknown_name("camera", camera.type, types));
    else
      importer.note(
          camera.where,
          fmt::format("a camera \"{}\" is not supported: a perspective camera is used", camera.type));
  }
  ImportedCamera imported;
  imported.where = camera.where;
  imported.to_world = options.camera_to_world * state.world_mirror;
  if (options.film) {
    const Parameters& film = options.film->parameters;
    imported.resolution = {count(film, "xresolution", 1280, importer),
                           count(film, "yresolution", 720, importer)};
  } else {
    imported.resolution = {1280, 720};
  }
  if (imported.resolution[0] < 1 || imported.resolution[1] < 1) {
    importer.fail(options.film->where, "a film needs at least one pixel along each axis");
    return;
  }
  const Parameters& p = camera.parameters;
  const double half = std::tan(p.number("fov", 90, importer) * kDegree / 2) *
                      half_window(camera, imported.resolution, importer);
  imported.fov_deg = 2 * std::atan(half) / kDegree;
  imported.lens_radius = p.number("lensradius", 0, importer);
  imported.focus_distance = p.number("focaldistance", 1e6, importer);
  note_exposure(camera, importer);
  p.note_unused("camera", importer);
  set_camera(imported, importer);
}

const std::vector<std::string> kIntegratorTypes{
    "ambientocclusion", "bdpt",       "function",      "lightpath", "mlt",    "path",
    "randomwalk",       "simplepath", "simplevolpath", "sppm",      "volpath"};

const std::vector<std::string> kMediumIntegratorTypes{"bdpt", "mlt", "simplevolpath", "volpath"};

void read_integrator(const Directive& integrator, SceneImporter& importer) {
  const std::string& type = integrator.type;
  if (std::ranges::find(kIntegratorTypes, type) == kIntegratorTypes.end())
    return importer.diagnostics.error(integrator.where, unknown_name("integrator", type, kIntegratorTypes));
  if (type == "ambientocclusion" || type == "function")
    importer.note(
        integrator.where,
        fmt::format("the output of an integrator \"{}\" is not supported: radiance is rendered", type));
  if (type == "sppm")
    importer.note(
        integrator.where,
        "\"maxdepth\" of pbrt limits camera paths and photons separately: Abbe limits both together");
  if (std::ranges::find(kMediumIntegratorTypes, type) == kMediumIntegratorTypes.end())
    importer.surface_integrator = type;
  const Parameters& p = integrator.parameters;
  importer.limit_depth(count(p, "maxdepth", 5, importer), integrator.where);
  // These parameters affect noise only.
  p.ignore({"lightsampler", "rrthreshold", "samplelights", "samplebsdf", "cossample", "photonsperiteration",
            "radius", "seed", "mutationsperpixel", "chains", "bootstrapsamples", "largestepprobability",
            "sigma"});
  p.note_unused("integrator", importer);
}

// Samples per pixel, with pbrt's defaults.
int pixel_samples(const Directive& sampler, SceneImporter& importer) {
  const Parameters& p = sampler.parameters;
  if (sampler.type != "stratified")
    return std::max(1, count(p, "pixelsamples", sampler.type == "independent" ? 4 : 16, importer));
  const double all = std::max(1.0, static_cast<double>(count(p, "xsamples", 4, importer))) *
                     std::max(1.0, static_cast<double>(count(p, "ysamples", 4, importer)));
  return static_cast<int>(std::min(all, kMaxCount));
}

void note_filter(const Directive& filter, SceneImporter& importer) {
  const Parameters& p = filter.parameters;
  if (filter.type == "box" && p.number("xradius", 0.5, importer) == 0.5 &&
      p.number("yradius", 0.5, importer) == 0.5)
    return;
  importer.note(filter.where, "pixel filters are not supported: a box of one pixel is used");
}

void set_render(const SceneOptions& options, SceneImporter& importer) {
  spec::Render& render = importer.scene.render.emplace();
  // Default of pbrt's default integrator.
  render.max_depth = 5;
  if (options.sampler) {
    const Parameters& p = options.sampler->parameters;
    render.samples = pixel_samples(*options.sampler, importer);
    p.ignore({"jitter", "randomization", "seed"});
    p.note_unused("sampler", importer);
  }
  if (options.integrator) read_integrator(*options.integrator, importer);
}

}  // namespace

void apply_options(const SceneOptions& declared, const SourcePosition& end, ImportState& state) {
  SceneImporter& importer = state.importer;
  SceneOptions options = declared;
  if (!options.camera) {
    importer.note(end, "the scene has no camera: pbrt's default, 90 degrees along z, is used");
    options.camera = Directive{"perspective", {}, end};
  }
  set_render(options, importer);
  spec::Sensor& sensor = importer.scene.sensor.emplace();
  if (options.film) {
    set_counts(*options.film, sensor, importer);
    set_output(options.film->parameters, importer);
    options.film->parameters.ignore(
        {"xresolution", "yresolution", "savefp16", "diagonal", "maxcomponentvalue"});
  } else {
    sensor.counts = spec::StandardObserver{{{Observer::cie1931}, end}};
  }
  if (options.filter) note_filter(*options.filter, importer);
  state.world_mirror = world_mirror_of(options.camera_to_world);
  if (state.world_mirror != Imath::M44d())
    importer.note(options.camera->where,
                  "the camera shows a mirror image of right-handed space: x is negated");
  if (!options.camera_medium.empty())
    importer.note(options.camera->where, "a medium around the camera that no shape encloses is dropped");
  set_perspective_camera(options, state);
  if (options.film) options.film->parameters.note_unused("film", importer);
}

}  // namespace abbe::importers::pbrt
