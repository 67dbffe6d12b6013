#pragma once

#include <optional>
#include <string>

namespace abbe {

class Scene;

/// What in a scene makes polarisation matter: a kind of thing, as "shape", and its name.
struct PolarisationNeed {
  const char* kind;
  std::string name;
};

/// Where the light of some path may be polarised by one event and then meet another, in the scene or in the
/// camera's lens, whose power depends on that, without anything between that depolarises for certain; nothing
/// where no path can, so that what is worked out for unpolarised light is exact.
[[nodiscard]] std::optional<PolarisationNeed> polarisation_need(const Scene& scene);

/// Whether paths of the scene carry polarisation: where it matters, unless its settings leave it out.
[[nodiscard]] bool carries_polarisation(const Scene& scene);

}  // namespace abbe
