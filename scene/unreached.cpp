#include "scene/unreached.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "scene/small_light.h"

namespace abbe {
namespace {

// Path tracing finds a light of less than this solid angle [sr] by chance in less than one in 12,000
// directions: hardly ever.
constexpr double kTinyLight_sr = 0.001;

// The lights of the scene that `select` holds for, by name; of very many, the first ones.
template <typename Select>
std::string names_of(const Scene& scene, Select select) {
  constexpr std::size_t kMostNames = 8;
  std::string names;
  std::size_t count = 0;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (!select(i) || ++count > kMostNames) continue;
    names += fmt::format("{}\"{}\"", names.empty() ? "" : ", ", scene.lights[i].name);
  }
  return count > kMostNames ? fmt::format("{} and {} more", names, count - kMostNames) : names;
}

// The classes that are found to be unreached, each with the lights whose light it is.
class Classes {
 public:
  explicit Classes(const Scene& scene) : scene_(scene) {}

  // Those of the lights that `select` holds for, if any.
  template <typename Select>
  void add(Select select, std::string_view expression, std::string_view words) {
    const std::string lights = names_of(scene_, select);
    if (!lights.empty()) told_.push_back(fmt::format("{}: {} ({})", expression, words, lights));
  }
  [[nodiscard]] std::vector<PathClass> told() && { return std::move(told_); }

 private:
  const Scene& scene_;
  std::vector<PathClass> told_;
};

bool any(std::size_t /*light*/) {
  return true;
}

bool has_specular_shapes(const Scene& scene) {
  return std::any_of(scene.shapes.begin(), scene.shapes.end(), [&](const ShapeInstance& instance) {
    return lobes(scene.materials[instance.material]).delta;
  });
}

// The lights that paths from some places hardly ever meet by chance.
std::vector<bool> tiny_lights(const Scene& scene, const Viewpoints& from) {
  std::vector<bool> tiny;
  for (const Light& light : scene.lights)
    tiny.push_back(!light.is_delta() && !light.is_environment() && emits(light) &&
                   looks_smaller(scene, light, from, kTinyLight_sr));
  return tiny;
}

// Few directions from a meter lead there, and photons show them only where they meet a surface beside it.
template <typename Select>
void add_tiny_lights_of_meter(const Scene& scene, Select select, Classes& classes) {
  if (!is_meter(scene.camera) || !has_specular_shapes(scene)) return;
  const std::vector<bool> tiny = tiny_lights(scene, places_of_meter(scene));
  classes.add([&](std::size_t i) { return tiny[i] && select(i); }, "E S+ L",
              "a tiny light that a meter sees in mirrors or through glass");
}

// Light tracing reaches every path whose vertex next to the eye scatters, and all that comes to a meter that
// is no point.
void add_of_light_tracing(const Scene& scene, Classes& classes) {
  const auto& lights = scene.lights;
  const bool meter = is_meter(scene.camera);
  if (meter && !traits(scene.camera).opening)
    return classes.add(any, "E (S|D)* L", "everything: photons do not run into a point");
  classes.add([&](std::size_t i) { return lights[i].is_environment(); }, "E (S|D)* L",
              "all light of an environment");
  if (meter) return;
  classes.add([&](std::size_t i) { return lights[i].is<AreaLight, SunLight>(); }, "E L",
              "lights seen directly");
  if (traits(scene.camera).ghosts)
    classes.add([&](std::size_t i) { return lights[i].is_delta() && emits(lights[i]); }, "E L",
                "a point, spot or directional light seen by way of the lens's ghosts");
  if (has_specular_shapes(scene))
    classes.add([&](std::size_t i) { return !lights[i].is_environment(); }, "E S (S|D)* L",
                "everything seen in mirrors or through glass");
}

// Path tracing with light sampling reaches every path that ends on a light with area, and every one whose
// vertex next to the light scatters; without it, the former. Photons that run into a meter reach the others
// of a traced light if it is without area, else those whose vertex next to the meter is specular.
void add_of_path_tracing(const Scene& scene, const Needs& needs, bool light_tracing_active,
                         Classes& classes) {
  const auto& lights = scene.lights;
  const std::vector<bool> tiny = tiny_lights(scene, specular_centers(scene));
  const bool connects = scene.render.sampling.lights != LightStrategy::bsdf;
  const auto delta = [&](std::size_t i) { return lights[i].is_delta() && emits(lights[i]); };
  const auto traced = [&](std::size_t i) { return light_tracing_active && needs.light_is_traced[i]; };
  const auto reached = [&](std::size_t i) { return is_meter(scene.camera) && traced(i); };
  if (!connects) classes.add(delta, "E (S|D)+ L", "a point, spot or directional light, which no path meets");
  if (!has_specular_shapes(scene)) return;
  const auto connected = [&](std::size_t i) { return connects && delta(i) && !reached(i); };
  classes.add(connected, "E S+ L", "a point, spot or directional light seen in mirrors or through glass");
  add_tiny_lights_of_meter(
      scene, [&](std::size_t i) { return !reached(i); }, classes);
  if (!needs.caustics) return;
  classes.add([&](std::size_t i) { return connected(i) && traced(i); }, "E S (S|D)* D (S|D)* S L",
              "caustics of a point, spot or directional light, seen in mirrors or through glass");
  classes.add([&](std::size_t i) { return connected(i) && !traced(i); }, "E (S|D)* D (S|D)* S L",
              "caustics of a point, spot or directional light");
  classes.add([&](std::size_t i) { return tiny[i] && traced(i) && !reached(i); }, "E S (S|D)* D (S|D)* S L",
              "caustics of a tiny light, seen in mirrors or through glass, that pilots have not shown");
  classes.add([&](std::size_t i) { return tiny[i] && (!traced(i) || reached(i)); }, "E (S|D)* D (S|D)* S L",
              "caustics of a tiny light that pilots have not shown");
}

}  // namespace

std::vector<PathClass> unreached(const Scene& scene, const Needs& needs, bool light_tracing_active) {
  Classes classes(scene);
  const auto delta = [&](std::size_t i) { return scene.lights[i].is_delta() && emits(scene.lights[i]); };
  const bool specular = has_specular_shapes(scene);
  switch (scene.render.integrator) {
    case Integrator::light:
      add_of_light_tracing(scene, classes);
      break;
    case Integrator::bdpt:
      if (specular)
        classes.add(
            delta, "E S+ (D S+)* L",
            "a point, spot or directional light where no two vertices in a row but the eye's scatter");
      add_tiny_lights_of_meter(scene, any, classes);
      break;
    case Integrator::photon_map:
    case Integrator::ppm:
    case Integrator::sppm:
    case Integrator::vcm:
      if (!specular) break;
      classes.add(delta, "E S+ L", "a point, spot or directional light seen in mirrors or through glass");
      if (needs.scattering)
        classes.add(
            delta, "E S* (D S+)+ L",
            "a point, spot or directional light where only matter scatters, and no two events in a row");
      add_tiny_lights_of_meter(scene, any, classes);
      break;
    case Integrator::photon_brute:
      if (traits(scene.camera).ghosts)
        classes.add(any, "E (S|D)* L", "what comes by way of the lens's ghosts");
      if (!traits(scene.camera).opening)
        classes.add(any, "E (S|D)* L", "everything: photons do not come in through a point");
      break;
    case Integrator::adjoint_brute:
      classes.add(delta, "E (S|D)* L", "all light of a point, spot or directional light");
      break;
    case Integrator::automatic:
    case Integrator::path:
      add_of_path_tracing(scene, needs, light_tracing_active, classes);
  }
  return std::move(classes).told();
}

}  // namespace abbe
