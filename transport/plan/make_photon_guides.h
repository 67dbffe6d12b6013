#pragma once

#include <optional>
#include <vector>

#include "io/error.h"
#include "scene/scene.h"
#include "transport/plan/photon_guide.h"

namespace abbe {

/// Distant light as viewed from the scene: its center, the distance [m] of that from the scene's center, and
/// its radius [m].
struct DistantLight {
  Imath::V3d center;
  double distance;
  double radius;
};
/// Data of a distant light; nothing for a nearby light or one without a position.
[[nodiscard]] std::optional<DistantLight> distant_light(const Light& light, const Scene& scene);

/// Error for lights in `traced` whose photons cannot illuminate the scene; nothing if all can. Photons of
/// distant lights start outside of all shapes that refract them and are sent through the nearby shapes.
/// Distant shapes receive none, and a distant medium attenuates none. The precision of large shapes is
/// limited to that of floats there.
[[nodiscard]] std::optional<Error> refusal(const Scene& scene, const std::vector<bool>& traced,
                                           bool light_only);

/// Guides of all lights before training; lights without power have none.
[[nodiscard]] std::vector<PhotonGuide> make_photon_guides(const Scene& scene,
                                                          const std::vector<double>& traced_powers,
                                                          bool light_only);

}  // namespace abbe
