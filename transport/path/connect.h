#pragma once

#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "sampling/sampler.h"
#include "transport/path/free_path.h"
#include "transport/path/path_vertex.h"
#include "transport/path/ray_caster.h"
#include "transport/path/vertex.h"

namespace abbe {

/// Contribution of a path that joins vertex a of a camera subpath and vertex b of a light subpath by one
/// straight segment of length d:
///
///     contribution = t_a f_a t_b f_b G T,  G = |cos_a cos_b|/d^2 [Veach1997, eq. 10.3],
///
/// - t: throughput of each subpath, which is divided by the hero's pdf already (`PathPacket`);
/// - f: what the vertex sends along the segment: its BSDF or phase function, a camera's importance, or a
///   light's emission;
/// - G: cosines are 1 in media and at points without a normal. For a light at infinity G is cos_a;
/// - T: transmittance of the segment.
///
/// The estimate is the contribution times the MIS weight (`StrategyWeights`).
struct Connection {
  /// Formula above, per wavelength; neither weighted by MIS nor divided by the pdf of the wavelengths.
  SampledSpectrum contribution;
  /// Probability, per wavelength, that `propagate` passes the segment without an event.
  SampledSpectrum passing_pdf;
  /// Stokes components that the sensor measures for a contribution of 1; nothing for unpolarised transport.
  std::optional<StokesSpectrum> stokes = {};
};

/// Connects vertex `a` of a camera subpath with vertex `b` of a light subpath; either may be the camera's or
/// the light's own vertex. Both must have the same wavelengths and hero, and `a` must not be at infinity.
/// Casts a shadow ray at the time of `a`. Returns nothing if the ends coincide, scatter no light to each
/// other, or if the segment is occluded. Throws Error{resource} if more than `MediumStack::kMaxShapes` media
/// nest.
[[nodiscard]] std::optional<Connection> connect(const Scene& scene, RayCaster& caster, const PathVertex& a,
                                                const PathVertex& b);

/// Transmittance and passing probability of an unoccluded segment that starts at the vertex `from`, as
/// `transmission` returns them. `from` must not be at infinity. Throws Error{resource} if more than
/// `MediumStack::kMaxShapes` media nest.
[[nodiscard]] Transmission transmission_along(const Scene& scene, RayCaster& caster, const PathVertex& from,
                                              const PathSegment& segment);

/// Infinite ray from a vertex in the unit direction `w`, at the vertex's time. If the vertex has a surface,
/// the origin is offset from it to the side of `w`. The vertex must not be at infinity.
[[nodiscard]] Ray spawn_towards(const PathVertex& vertex, const Imath::V3f& w);

/// Number of vertices of a path that are always connected; see `choose_joined`.
inline constexpr std::size_t kAlwaysJoined = 8;

/// Probability that vertex `number`, at least 1, is connected to the vertices of another path.
[[nodiscard]] inline float joining_probability(std::size_t number) {
  return number <= kAlwaysJoined ? 1.0F : static_cast<float>(kAlwaysJoined) / static_cast<float>(number);
}

/// Vertex of a path that is connected to another path.
struct JoinedVertex {
  std::size_t number = 0;  ///< Number of the vertex in its path, from 1.
  float weight = 1;        ///< Factor 1/p_n of its connections.
};

/// Chooses the vertices of a path that are connected to another path. Connecting all pairs, each at a cost in
/// proportion to the lengths of both, would cost the third power of the length. From the ninth on, vertex n
/// is therefore connected with the probability p_n = 8/n and the weight 1/p_n [Horvitz1952]. This selects
/// about 8 (1 + ln(N/8)) of N vertices. Sampling is systematic [Madow1949]: a vertex is chosen if the sum of
/// p_1 ... p_n and one random number of `sampler` passes an integer. Surface vertices with delta
/// distributions only are left out. Replaces the content of `joined`; its numbers ascend.
void choose_joined(std::span<const PathVertex> path, const Sampler& sampler,
                   std::vector<JoinedVertex>& joined);

/// BSDF [1/sr] with which a surface scatters photon flux that arrived nearby towards the vertex's own path.
/// `from` is the unit direction to the photon's origin, `normal` the outward geometric normal at the photon.
/// On a relief the value is multiplied by the shading cosine of `from` over the geometric one, by which flux
/// arrives. 0 if the normals differ by more than 60 degrees, because the photon is then on another face.
[[nodiscard]] inline SampledSpectrum merged_scattering(const SurfaceVertex& vertex, const Imath::V3f& from,
                                                       const Imath::V3f& normal) {
  constexpr float kSameFace = 0.5F;  // minimum cosine between two normals
  const float cos_incident = std::abs(from.dot(vertex.hit.normal));
  if (normal.dot(vertex.hit.normal) < kSameFace || !(cos_incident > 0)) return {};
  const SurfaceVertex::OutgoingDirection outgoing = vertex.eval_towards(from, TransportMode::radiance);
  return vertex.relief ? outgoing.f * (std::abs(outgoing.wi.z) / cos_incident) : outgoing.f;
}

/// Stokes vector that a camera path with the polarisation `eye` measures of photon flux that `vertex`
/// scatters, relative to an unpolarised estimate. `light` is the polarisation of the flux, and `from` the
/// unit direction to its origin. Nothing if `eye` is empty; otherwise `light` must not be empty.
[[nodiscard]] inline std::optional<StokesSpectrum> merged_polarisation(const SurfaceVertex& vertex,
                                                                       const CarriedPolarisation& eye,
                                                                       const Imath::V3f& from,
                                                                       const CarriedPolarisation& light) {
  if (!eye) return std::nullopt;
  return eye
      ->through(vertex.mueller(vertex.frame.to_local(from), false), vertex.frame.to_world(vertex.wo),
                TransportMode::radiance)
      .of(*light, -from);
}

}  // namespace abbe
