#pragma once

#include <optional>
#include <vector>

#include "io/error.h"
#include "scene/scene.h"
#include "transport/plan/aim.h"

namespace abbe {

/// What a light that is far looks like from the scene: its middle, how far [m] that is from the middle of the
/// scene, and its radius [m].
struct FarLight {
  Imath::V3d center;
  double distance;
  double radius;
};
/// Tells how a light that is far looks; nothing for one that is near or has no place.
[[nodiscard]] std::optional<FarLight> far_away(const Light& light, const Scene& scene);

/// Why photons of the lights in `traced` cannot light the scene. They are sent through what is near, so that
/// they meet nothing that is far, nor lose anything in a cloud there; and they start outside of all that may
/// bend them, so that they are no finer than floats there. Nothing where they can.
[[nodiscard]] std::optional<Error> refusal(const Scene& scene, const std::vector<bool>& traced,
                                           bool light_only);

/// Where the photons of each light are aimed, before anything is learnt; those of no power have no aim.
[[nodiscard]] std::vector<Aim> make_aims(const Scene& scene, const std::vector<double>& traced_powers,
                                         bool light_only);

}  // namespace abbe
