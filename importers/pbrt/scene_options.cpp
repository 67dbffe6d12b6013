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

// Sets the sensor's responses: X, Y and Z, a camera's channels, or radiance in spectral bands.
void set_counts(const Directive& film, spec::Sensor& sensor) {
  const Parameters& p = film.parameters;
  const std::string name = p.text("sensor", "cie1931");
  const auto camera = std::ranges::find(kSensors, name, &decltype(kSensors)::value_type::first);
  if (film.type == "spectral")
    sensor.counts = spec::Bins{p.number("lambdamin", 360), p.number("lambdamax", 830), 0, film.where};
  else if (camera != kSensors.end())
    sensor.counts = spec::MeasuredCamera{{{std::string(camera->second)}, film.where}};
  else
    sensor.counts = spec::StandardObserver{{{Observer::cie1931}, film.where}};
  if (auto* bins = std::get_if<spec::Bins>(&sensor.counts))
    bins->step_nm = (bins->to_nm - bins->from_nm) / std::max(p.integer("nbuckets", 16), 1);
  else if (camera == kSensors.end() && name != "cie1931")
    film.note(fmt::format("no table of the sensor \"{}\" is shipped: replaced by the CIE observer", name));
}

void set_output(const Parameters& p, SceneImporter& importer) {
  const std::filesystem::path file = p.text("filename", "");
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
double half_window(const Directive& camera, const std::array<std::int64_t, 2>& resolution) {
  const std::vector<double> window = camera.parameters.numbers("screenwindow");
  if (window.size() != 4) return 1;
  const double half_x = (window[1] - window[0]) / 2;
  const double half_y = (window[3] - window[2]) / 2;
  const double aspect = static_cast<double>(resolution[0]) / static_cast<double>(resolution[1]);
  if (std::abs(window[0] + window[1]) > 1e-6 || std::abs(window[2] + window[3]) > 1e-6 ||
      std::abs(half_x / half_y - aspect) > 1e-3 * aspect)
    camera.note(
        "a screen window that is off-center or has non-square pixels is not supported: a centered "
        "one of its width is used");
  return std::min(half_x, half_y);
}

// Notes a shutter time other than 1, which scales the brightness in pbrt.
void note_exposure(const Directive& camera) {
  const double opens = camera.parameters.number("shutteropen", 0);
  const double closes = camera.parameters.number("shutterclose", 1);
  if (!(closes > opens))
    camera.fail(fmt::format("the shutter {} (got {} and {})",
                            closes < opens ? "closes before it opens" : "does not open", closes, opens));
  else if (closes - opens != 1)
    camera.note(fmt::format(
        "the shutter is open for {:.6g}, by which pbrt multiplies the brightness: its times are dropped",
        closes - opens));
}

// Sets a perspective camera, which also replaces unsupported types of cameras.
void set_perspective_camera(const SceneOptions& options, ImportState& state) {
  SceneImporter& importer = state.importer;
  const Directive& camera = *options.camera;
  if (camera.type != "perspective")
    if (importer.is_known("camera", camera.type, {"orthographic", "perspective", "realistic", "spherical"},
                          camera.where))
      camera.note(fmt::format("a camera \"{}\" is not supported: a perspective camera is used", camera.type));
  ImportedCamera imported;
  imported.where = camera.where;
  imported.to_world = options.camera_to_world * state.world_mirror;
  imported.resolution = {1280, 720};
  if (options.film) {
    const Parameters& film = options.film->parameters;
    imported.resolution = {film.integer("xresolution", 1280), film.integer("yresolution", 720)};
  }
  if (imported.resolution[0] < 1 || imported.resolution[1] < 1)
    return (void)options.film->fail("a film needs at least one pixel along each axis");
  const Parameters& p = camera.parameters;
  const double half = std::tan(p.number("fov", 90) * kDegree / 2) * half_window(camera, imported.resolution);
  imported.fov_deg = 2 * std::atan(half) / kDegree;
  imported.lens_radius = p.number("lensradius", 0);
  imported.focus_distance = p.number("focaldistance", 1e6);
  note_exposure(camera);
  p.note_unused("camera");
  set_camera(imported, importer);
}

const std::vector<std::string> kIntegratorTypes{
    "ambientocclusion", "bdpt",       "function",      "lightpath", "mlt",    "path",
    "randomwalk",       "simplepath", "simplevolpath", "sppm",      "volpath"};

const std::vector<std::string> kMediumIntegratorTypes{"bdpt", "mlt", "simplevolpath", "volpath"};

void read_integrator(const Directive& integrator, SceneImporter& importer) {
  const std::string& type = integrator.type;
  if (!importer.is_known("integrator", type, kIntegratorTypes, integrator.where)) return;
  if (type == "ambientocclusion" || type == "function")
    integrator.note(
        fmt::format("the output of an integrator \"{}\" is not supported: radiance is rendered", type));
  if (type == "sppm")
    integrator.note(
        "\"maxdepth\" of pbrt limits camera paths and photons separately: Abbe limits both together");
  if (std::ranges::find(kMediumIntegratorTypes, type) == kMediumIntegratorTypes.end())
    importer.surface_integrator = type;
  const Parameters& p = integrator.parameters;
  importer.limit_depth(p.integer("maxdepth", 5), integrator.where);
  // These parameters affect noise only.
  p.ignore({"lightsampler", "rrthreshold", "samplelights", "samplebsdf", "cossample", "photonsperiteration",
            "radius", "seed", "mutationsperpixel", "chains", "bootstrapsamples", "largestepprobability",
            "sigma"});
  p.note_unused("integrator");
}

int pixel_samples(const Directive& sampler) {
  const Parameters& p = sampler.parameters;
  if (sampler.type != "stratified")
    return std::max(1, p.integer("pixelsamples", sampler.type == "independent" ? 4 : 16));
  const double all = std::max(1.0, static_cast<double>(p.integer("xsamples", 4))) *
                     std::max(1.0, static_cast<double>(p.integer("ysamples", 4)));
  return static_cast<int>(std::min(all, 1e9));
}

void note_filter(const Directive& filter) {
  const Parameters& p = filter.parameters;
  if (filter.type == "box" && p.number("xradius", 0.5) == 0.5 && p.number("yradius", 0.5) == 0.5) return;
  filter.note("pixel filters are not supported: a box of one pixel is used");
}

void set_render(const SceneOptions& options, SceneImporter& importer) {
  spec::Render& render = importer.scene.render.emplace();
  // Default of pbrt's default integrator.
  render.max_depth = 5;
  if (options.sampler) {
    const Parameters& p = options.sampler->parameters;
    render.samples = pixel_samples(*options.sampler);
    p.ignore({"jitter", "randomization", "seed"});
    p.note_unused("sampler");
  }
  if (options.integrator) read_integrator(*options.integrator, importer);
}

}  // namespace

void apply_options(const SceneOptions& declared, const SourcePosition& end, ImportState& state) {
  SceneImporter& importer = state.importer;
  SceneOptions options = declared;
  if (!options.camera) {
    importer.note(end, "the scene has no camera: pbrt's default, 90 degrees along z, is used");
    options.camera = Directive{"perspective", Parameters(importer), end};
  }
  set_render(options, importer);
  spec::Sensor& sensor = importer.scene.sensor.emplace();
  if (options.film) {
    set_counts(*options.film, sensor);
    set_output(options.film->parameters, importer);
    options.film->parameters.ignore(
        {"xresolution", "yresolution", "savefp16", "diagonal", "maxcomponentvalue"});
  } else {
    sensor.counts = spec::StandardObserver{{{Observer::cie1931}, end}};
  }
  if (options.filter) note_filter(*options.filter);
  state.world_mirror = world_mirror_of(options.camera_to_world, options.camera->where, importer);
  if (!options.camera_medium.empty())
    options.camera->note("a medium around the camera that no shape encloses is dropped");
  set_perspective_camera(options, state);
  if (options.film) options.film->parameters.note_unused("film");
}

}  // namespace abbe::importers::pbrt
