#pragma once

#include <cstdint>
#include <functional>
#include <optional>

#include "scene/lights/light.h"
#include "scene/shapes/ray.h"
#include "transport/path/path_state.h"
#include "transport/path/ray_caster.h"

namespace abbe {

/// True if events between surfaces are possible: a medium scatters, or media have boundaries without an
/// interface.
[[nodiscard]] inline bool has_free_paths(const Scene& scene) {
  return scene.features.scattering || scene.features.boundaries;
}

/// Point at `distance` [m] along a ray, rounded towards its origin. The ray ends at the distance `end` [m],
/// possibly infinity, on a surface with the unit normal `end_normal`, which is 0 if it ends at no surface. A
/// point too close to that surface is moved away by the offset with which rays leave it. Rounding might
/// otherwise put it behind the surface.
[[nodiscard]] Imath::V3f point_along(const Ray& ray, float distance, float end, const Imath::V3f& end_normal);

/// Event at which a path segment ends.
enum class SegmentEnd : std::uint8_t {
  escape,   ///< The path leaves the scene.
  surface,  ///< The path hits a surface that is more than a medium boundary.
  medium,   ///< The path scatters in a medium.
  /// The path ends at a medium boundary: behind it the path might start behind an opaque surface that crosses
  /// the boundary or ends at it (`Scene::transmission_may_leak`).
  hidden,
};

/// Receives each homogeneous scattering segment that a path enters, with the state at the segment's origin.
using SegmentVisitor = std::function<void(const MediumSegment&)>;

/// Advances a path along its ray to its next event: on a surface, in a scattering medium, or out of the
/// scene. Updates throughput, pdfs and media, and crosses medium boundaries. `hit` is the nearest hit of the
/// ray. For `SegmentEnd::surface` it becomes the surface of the event, with the distance from the ray's
/// origin. The origin changes only for `SegmentEnd::medium`: then it is the position of the event. `visitor`
/// may be empty. Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
///
/// The hero draws its optical depth to the next scattering from e^-depth with `u` in [0, 1)^2; the second
/// number supplies further digits of the first. Let s_k be the extinction of wavelength k and x the distance.
/// The pdf of scattering is s_k e^(-s_k x), that of passing e^(-s_k x). Wavelengths are balanced over these
/// pdfs as over pdfs of directions. [Wilkie2014, sec. 4.2]
[[nodiscard]] SegmentEnd propagate(const Scene& scene, RayCaster& caster, const Imath::V2f& u,
                                   PathState& path, std::optional<SurfaceHit>& hit,
                                   const SegmentVisitor& visitor = {});

/// Attenuation of light along an unoccluded segment, per wavelength.
struct Transmission {
  SampledSpectrum transmittance{1.0F};  ///< Fraction neither absorbed nor scattered, in [0, 1].
  /// Probability that `propagate` passes the segment without an event; media that only absorb do not reduce
  /// it.
  SampledSpectrum pdf{1.0F};
};
/// Evaluates the first `distance` [m] of a ray that starts in `media`, across medium boundaries; `distance`
/// may be infinite. The ray must hit no other surface before. Throws Error{resource} if more than
/// `MediumStack::kMaxShapes` media nest.
[[nodiscard]] Transmission transmission(const Scene& scene, RayCaster& caster, Ray ray, MediumState media,
                                        const SampledSpectrum& wavelengths_nm, float distance);
/// Tests `shadow_ray` first. Returns nothing if it is occluded, otherwise `transmission` along the first
/// `distance` [m] of `ray`, which runs along the same segment. Throws as `transmission`.
[[nodiscard]] std::optional<Transmission> unblocked_transmission(const Scene& scene, RayCaster& caster,
                                                                 const BasicRay<double>& shadow_ray,
                                                                 const Ray& ray, const MediumState& media,
                                                                 const SampledSpectrum& wavelengths_nm,
                                                                 float distance);

/// Equiangular sampling of a distance along a ray in a medium, for a light at a point [Kulla2012]. The
/// range is the part of the ray within the light's cone, if the cone is narrower than a half space. The pdf
/// is uniform in the angle at which the light sees the point. Let D be the light's distance from the ray, t
/// the signed distance along the ray from its point nearest to the light, and theta = atan(t/D):
///     p(t) = D / ((theta_b - theta_a) (D^2 + t^2)),
/// theta_a and theta_b being the angles at both ends of the range. The factor 1/d^2 of the light cancels.
class Equiangular {
 public:
  /// Sampler for the first `length` [m] of a ray, which may be infinite. Returns nothing for other
  /// lights, for a light that illuminates no part of it, and for a light at the ray's origin.
  [[nodiscard]] static std::optional<Equiangular> along(const Ray& ray, float length, const Light& light);

  /// Samples a distance from the ray's origin [m], within the range, with `u` in [0, 1).
  [[nodiscard]] float sample(float u) const;
  /// Pdf of a distance from the ray's origin [1/m]; 0 outside the range.
  [[nodiscard]] float pdf(float distance) const;

 private:
  Equiangular(double from, double to, double foot, double height);

  float from_, to_;    // range of distances [m]
  double foot_;        // distance of the point nearest to the light [m]
  double height_;      // distance of that point from the light [m]
  double low_, high_;  // angles at both ends of the range
};

}  // namespace abbe
