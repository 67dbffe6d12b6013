#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "transport/path/ray_caster.h"
#include "transport/path/walk.h"

namespace abbe {

/// Whether events may lie between surfaces: matter scatters, or begins without an interface.
[[nodiscard]] inline bool has_free_paths(const Scene& scene) {
  return scene.needs.scattering || scene.needs.boundaries;
}

/// The point that far along a ray that ends at `end`, perhaps infinite, on a surface of that unit normal, or
/// at none where it is 0. A point that floats do not tell from the surface is moved off it, as far as rays
/// that leave the surface start: rounded as it is, it might lie behind.
[[nodiscard]] Imath::V3f point_along(const Ray& ray, float distance, float end, const Imath::V3f& end_normal);

/// Where a walk has come to along its ray.
enum class Arrival : std::uint8_t {
  outside,  ///< The scene is left.
  surface,
  matter,  ///< That scatters it.
  hidden,  ///< Its way on may start behind a wall, see `Scene::hides_beyond`: it ends there.
};

/// Is told of each stretch of even matter that scatters which a walk comes to, as it is at its origin.
using StretchVisitor = std::function<void(const Stretch&)>;

/// Takes a walk along its ray, whose nearest hit is `hit`, to its next event: at a surface, which `hit` then
/// is, out of the scene, or in matter that scatters it. Boundaries of matter are passed. The ray goes on
/// starting where it does unless matter scatters: then the event lies at its origin.
///
/// The hero draws its optical depth to the next scattering from e^-depth by `u` in [0, 1)^2, the second
/// number being the digits beyond the first. With extinction s_k of lane k and the way x through it, the
/// density of scattering there is s_k e^(-s_k x), that of passing e^(-s_k x), and the lanes are balanced over
/// these as over densities of directions. [Wilkie2014, sec. 4.2]
[[nodiscard]] Arrival propagate(const Scene& scene, RayCaster& caster, const Imath::V2f& u, Walk& walk,
                                std::optional<SurfaceHit>& hit, const StretchVisitor& visitor = {});

/// What is left of light on a straight way that nothing blocks, and with which density `propagate` would have
/// come that way, lane by lane.
struct Transmission {
  SampledSpectrum transmittance{1.0F};
  SampledSpectrum density{1.0F};
};
/// Follows the first `distance` [m], perhaps infinite, of a ray that sets out within `around`.
[[nodiscard]] Transmission transmission(const Scene& scene, RayCaster& caster, Ray ray, Surroundings around,
                                        const SampledSpectrum& wavelengths_nm, float distance);
/// That of a ray along a way that may be blocked; nothing where it is.
[[nodiscard]] std::optional<Transmission> unblocked_transmission(const Scene& scene, RayCaster& caster,
                                                                 const BasicRay<double>& way, const Ray& ray,
                                                                 const Surroundings& around,
                                                                 const SampledSpectrum& wavelengths_nm,
                                                                 float distance);

}  // namespace abbe
