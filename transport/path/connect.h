#pragma once

#include <optional>

#include "transport/path/free_path.h"
#include "transport/path/path_vertex.h"
#include "transport/path/ray_caster.h"

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

}  // namespace abbe
