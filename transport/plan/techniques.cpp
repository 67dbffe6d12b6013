#include "transport/plan/techniques.h"

#include <algorithm>

namespace abbe {

std::string_view name_of(Technique technique) {
  return technique == Technique::path ? "path" : "light";
}

std::vector<Technique> chosen_techniques(const Scene& scene) {
  switch (scene.render.integrator) {
    case Integrator::path:
      return {Technique::path};
    case Integrator::light:
      return {Technique::light};
    case Integrator::automatic:
      break;
  }
  if (scene.needs.light_tracing) return {Technique::path, Technique::light};
  return {Technique::path};
}

bool uses(std::span<const Technique> techniques, Technique technique) {
  return std::find(techniques.begin(), techniques.end(), technique) != techniques.end();
}

std::string owned_paths(Technique technique, std::span<const Technique> active) {
  const bool alone = active.size() == 1;
  if (technique == Technique::light) return alone ? "E D (S|D)* L" : "E D (S|D)* S L of traced lights";
  return alone ? "E (S|D)* L" : "E (S|D)* L but those of light";
}

}  // namespace abbe
