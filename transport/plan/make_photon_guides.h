#pragma once

#include <optional>
#include <vector>

#include "io/error.h"
#include "scene/scene.h"
#include "transport/plan/photon_guide.h"

namespace abbe {

/// Distant light as viewed from the scene, whose center is the origin of world space.
struct DistantLight {
  Imath::V3d center;  ///< Center of the light's bounding box in world space [m].
  double distance;    ///< Distance of that center from the origin [m].
  double radius;      ///< Radius of the sphere around the bounding box [m].
};
/// Data of a distant light; nothing for a nearby light or one at infinity.
[[nodiscard]] std::optional<DistantLight> distant_light(const Light& light, const Scene& scene);

/// Error{scene} for lights in `traced`, a flag per light, whose photons cannot illuminate the scene; nothing
/// if all can. Set `light_only` if photons aim at all nearby shapes instead of the refracting and specular
/// ones. Photons of distant lights start outside of all shapes that refract them and are sent through the
/// nearby shapes. Distant shapes receive none, and a distant medium attenuates none. The precision of large
/// shapes is limited to that of floats there.
[[nodiscard]] std::optional<Error> refusal(const Scene& scene, const std::vector<bool>& traced,
                                           bool light_only);

/// Guides before training, one per light. `traced_powers` is the power of each light, 0 if it emits no
/// photons. Lights without power, and all nearby lights but the 128 strongest, have unguided emission.
/// `light_only` is as for `refusal`.
[[nodiscard]] std::vector<PhotonGuide> make_photon_guides(const Scene& scene,
                                                          const std::vector<double>& traced_powers,
                                                          bool light_only);

}  // namespace abbe
