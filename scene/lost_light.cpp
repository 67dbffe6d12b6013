#include "scene/lost_light.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "scene/shapes/solid.h"
#include "scene/small_light.h"

namespace abbe {
namespace {

// Solid angle [sr] below which path tracing practically never hits a light by chance: fewer than one in
// 12,000 directions.
constexpr double kTinyLight_sr = 0.001;

// Names of the lights that `select` accepts; of a large number only the first ones.
template <typename Select>
std::string names_of(const Scene& scene, Select select) {
  constexpr std::size_t kMaxNames = 8;
  std::string names;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (!select(i) || ++count > kMaxNames) continue;
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", scene.lights[i].name);
  }
  return count > kMaxNames ? fmt::format("{} and {} more", names, count - kMaxNames) : names;
}

// Collects the classes of light paths that cannot be sampled, each with its lights.
class Classes {
 public:
  explicit Classes(const Scene& scene) : scene_(scene) {}

  // Adds a class for the lights that `select` accepts, if any.
  template <typename Select>
  void add(Select select, std::string_view expression, std::string_view words) {
    const std::string lights = names_of(scene_, select);
    if (!lights.empty()) classes_.push_back(fmt::format("{}: {} ({})", expression, words, lights));
  }
  [[nodiscard]] std::vector<PathClass> result() && { return std::move(classes_); }

 private:
  const Scene& scene_;
  std::vector<PathClass> classes_;
};

bool any(std::size_t /*light*/) {
  return true;
}

bool has_specular_shapes(const Scene& scene) {
  return std::any_of(scene.shapes.begin(), scene.shapes.end(), [&](const ShapeInstance& instance) {
    return lobes(scene.materials[instance.material]).delta;
  });
}

// Marks the lights that paths from the viewpoints practically never hit by chance.
std::vector<bool> tiny_lights(const Scene& scene, const Viewpoints& from) {
  std::vector<bool> tiny;
  for (const Light& light : scene.lights)
    tiny.push_back(!light.is_delta() && !light.is_environment() && emits(light) &&
                   subtends_less(scene, light, from, kTinyLight_sr));
  return tiny;
}

// Few directions from a probe lead to such a light, and photons from it count only where they hit a surface
// next to the probe.
template <typename Select>
void add_tiny_lights_of_probe(const Scene& scene, Select select, Classes& classes) {
  if (!is_probe(scene.camera) || !has_specular_shapes(scene)) return;
  const std::vector<bool> tiny = tiny_lights(scene, probe_viewpoints(scene));
  classes.add([&](std::size_t i) { return tiny[i] && select(i); }, "E S+ L",
              "a tiny light that illuminates a probe by way of mirrors or glass");
}

// Light tracing samples every path whose vertex next to the eye scatters, and all paths to a probe with an
// area.
void add_of_light_tracing(const Scene& scene, Classes& classes) {
  const auto& lights = scene.lights;
  const bool probe = is_probe(scene.camera);
  if (probe && !traits(scene.camera).opening)
    return classes.add(any, "E (S|D)* L", "everything: photons cannot hit a point");
  classes.add([&](std::size_t i) { return lights[i].is_environment(); }, "E (S|D)* L",
              "all light of an environment light");
  if (probe) return;
  classes.add([&](std::size_t i) { return !lights[i].is_delta() && !lights[i].is_environment(); }, "E L",
              "lights seen directly");
  if (traits(scene.camera).ghosts)
    classes.add([&](std::size_t i) { return lights[i].is_delta() && emits(lights[i]); }, "E L",
                "lens ghosts of a point, spot or directional light");
  if (has_specular_shapes(scene))
    classes.add([&](std::size_t i) { return !lights[i].is_environment(); }, "E S (S|D)* L",
                "everything seen in mirrors or through glass");
}

// Path tracing samples every path that ends on a light with an area. With light sampling it also samples
// every path whose vertex next to the light scatters. Photons that hit a probe sample the remaining paths of
// a traced light: all of a delta light, otherwise those whose vertex next to the probe is specular.
void add_of_path_tracing(const Scene& scene, const SceneFeatures& features, bool light_tracing_active,
                         Classes& classes) {
  const auto& lights = scene.lights;
  const std::vector<bool> tiny = tiny_lights(scene, specular_centers(scene));
  const bool connects = scene.render.sampling.lights != LightStrategy::bsdf;
  const auto delta = [&](std::size_t i) { return lights[i].is_delta() && emits(lights[i]); };
  const auto traced = [&](std::size_t i) { return light_tracing_active && features.light_is_traced[i]; };
  const auto reached = [&](std::size_t i) { return is_probe(scene.camera) && traced(i); };
  if (!connects)
    classes.add(delta, "E (S|D)+ L", "a point, spot or directional light, which no path can hit");
  if (!has_specular_shapes(scene)) return;
  const auto connected = [&](std::size_t i) { return connects && delta(i) && !reached(i); };
  classes.add(connected, "E S+ L", "a point, spot or directional light seen in mirrors or through glass");
  add_tiny_lights_of_probe(
      scene, [&](std::size_t i) { return !reached(i); }, classes);
  if (!features.caustics) return;
  classes.add([&](std::size_t i) { return connected(i) && traced(i); }, "E S (S|D)* D (S|D)* S L",
              "caustics of a point, spot or directional light, seen in mirrors or through glass");
  classes.add([&](std::size_t i) { return connected(i) && !traced(i); }, "E (S|D)* D (S|D)* S L",
              "caustics of a point, spot or directional light");
  classes.add([&](std::size_t i) { return tiny[i] && traced(i) && !reached(i); }, "E S (S|D)* D (S|D)* S L",
              "caustics of a tiny light, seen in mirrors or through glass, that no pilot photon found");
  classes.add([&](std::size_t i) { return tiny[i] && (!traced(i) || reached(i)); }, "E (S|D)* D (S|D)* S L",
              "caustics of a tiny light that no pilot photon found");
}

void add_of_merging(const Scene& scene, const SceneFeatures& features, Classes& classes) {
  if (!has_specular_shapes(scene)) return;
  const auto delta = [&](std::size_t i) { return scene.lights[i].is_delta() && emits(scene.lights[i]); };
  classes.add(delta, "E S+ L", "a point, spot or directional light seen in mirrors or through glass");
  if (features.scattering)
    classes.add(delta, "E S* (D S+)+ L",
                "a point, spot or directional light, by paths that scatter only in media and never twice in "
                "succession");
  add_tiny_lights_of_probe(scene, any, classes);
}

void add_of_bidirectional(const Scene& scene, Classes& classes) {
  const auto delta = [&](std::size_t i) { return scene.lights[i].is_delta() && emits(scene.lights[i]); };
  if (has_specular_shapes(scene))
    classes.add(delta, "E S+ (D S+)* L",
                "a point, spot or directional light, by paths without two consecutive scattering vertices");
  add_tiny_lights_of_probe(scene, any, classes);
}

void add_of_photons_by_chance(const Scene& scene, Classes& classes) {
  if (traits(scene.camera).ghosts) classes.add(any, "E (S|D)* L", "the ghosts of the lens");
  if (!traits(scene.camera).opening)
    classes.add(any, "E (S|D)* L", "everything: photons cannot enter through a point");
}

// Number of times that a ray leaves a shape, minus the number that it enters it.
int exits(const Shape& shape, const Imath::V3d& from, const Imath::V3d& direction, double min_step) {
  int count = 0;
  double t = 0;
  while (const auto hit = intersect(shape, BasicRay<double>{from, direction}, t)) {
    count += hit->normal.dot(direction) > 0 ? 1 : -1;
    t = hit->t + min_step;
  }
  return count;
}

// The test works on a copy, because `make_solid` modifies its mesh.
bool has_openings(const Shape& shape) {
  const auto* mesh = plain<Mesh>(shape);
  if (mesh == nullptr) return false;
  Mesh copy = *mesh;
  return make_solid(copy).open_edges > 0;
}

bool encloses(const Shape& shape, const Imath::V3d& point) {
  constexpr double kMinStep = 1e-9;  // between two surfaces, relative to the shape
  const auto askew = askew_direction<double>();
  const Imath::Box3d box = bounds(shape);
  const double min_step = kMinStep * box.size().length();
  return min_step > 0 && box.intersects(point) && exits(shape, point, askew, min_step) > 0 &&
         exits(shape, point, -askew, min_step) > 0;
}

// True if a light lies in the shape or emits into it.
bool is_illuminated(const Scene& scene, std::uint32_t enclosure) {
  return std::any_of(scene.lights.begin(), scene.lights.end(), [&](const Light& light) {
    if (surface_of(light) == enclosure) return two_sided(light);
    if (motion_of(light, scene.shapes) != nullptr) return true;  // it may enter
    if (light.at_infinity()) return false;
    return std::ranges::any_of(kRepresentativePoints, [&](const std::array<float, 2>& u) {
      const EmissionPoint from = sample_emission_point(light, scene.shapes, {u[0], u[1]}, 0);
      return encloses(scene.shapes[enclosure].shape, Imath::V3d(from.point));
    });
  });
}

// Origins of the camera's rays; for a probe representative points.
std::vector<Imath::V3d> ray_origins_of(const Camera& camera) {
  if (!is_probe(camera)) return {center(camera)};
  std::vector<Imath::V3d> camera_points;
  for (const std::array<float, 2>& u : kRepresentativePoints)
    camera_points.emplace_back(probe_point(camera, {u[0], u[1]}));
  return camera_points;
}

}  // namespace

std::vector<PathClass> unsampled_paths(const Scene& scene, const SceneFeatures& features,
                                       bool light_tracing_active) {
  Classes classes(scene);
  const IntegratorTraits& integrator = traits(scene.render.integrator);
  switch (integrator.traces) {
    case TracedPaths::camera:
      add_of_path_tracing(scene, features, light_tracing_active, classes);
      break;
    case TracedPaths::light:
      add_of_light_tracing(scene, classes);
      break;
    case TracedPaths::both:
    case TracedPaths::photons:
      if (integrator.merging == Merging::none)
        add_of_bidirectional(scene, classes);
      else
        add_of_merging(scene, features, classes);
      break;
    case TracedPaths::light_by_chance:
      add_of_photons_by_chance(scene, classes);
      break;
    case TracedPaths::camera_by_chance:
      classes.add([&](std::size_t i) { return scene.lights[i].is_delta() && emits(scene.lights[i]); },
                  "E (S|D)* L", "all light of a point, spot or directional light");
  }
  return std::move(classes).result();
}

std::optional<std::uint32_t> dark_enclosure(const Scene& scene) {
  const std::vector<Imath::V3d> camera = ray_origins_of(scene.camera);
  if (scene.camera.motion) return std::nullopt;
  for (std::uint32_t i = 0; i < scene.shapes.size(); ++i) {
    const ShapeInstance& instance = scene.shapes[i];
    if (motion_of(instance.shape) == nullptr && opaque(scene.materials[instance.material]) &&
        std::ranges::all_of(camera, [&](const auto& at) { return encloses(instance.shape, at); }) &&
        !is_illuminated(scene, i) && !has_openings(instance.shape))
      return i;
  }
  return std::nullopt;
}

}  // namespace abbe
