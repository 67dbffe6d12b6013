#include "transport/plan/techniques.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace abbe {

std::string_view name_of(Technique technique) {
  constexpr std::array<std::string_view, 3> kNames{"path", "light", "bdpt"};
  return kNames.at(static_cast<std::size_t>(technique));
}

std::vector<Technique> chosen_techniques(const Scene& scene) {
  switch (scene.render.integrator) {
    case Integrator::path:
      return {Technique::path};
    case Integrator::light:
      return {Technique::light};
    case Integrator::bdpt:
      return {Technique::bdpt};
    case Integrator::automatic:
      break;
  }
  if (scene.needs.light_tracing) return {Technique::path, Technique::light};
  return {Technique::path};
}

bool uses(std::span<const Technique> techniques, Technique technique) {
  return std::find(techniques.begin(), techniques.end(), technique) != techniques.end();
}

bool starts_at_lights(std::span<const Technique> techniques) {
  return uses(techniques, Technique::light) || uses(techniques, Technique::bdpt);
}

std::string owned_paths(Technique technique, std::span<const Technique> active) {
  if (technique == Technique::bdpt)
    return "E (S|D)* L but, of lights without area, those of no D beside another or L";
  const bool alone = active.size() == 1;
  if (technique == Technique::light) return alone ? "E D (S|D)* L" : "E D (S|D)* S L of traced lights";
  return alone ? "E (S|D)* L" : "E (S|D)* L but those of light";
}

}  // namespace abbe
