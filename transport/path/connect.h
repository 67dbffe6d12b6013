#pragma once

#include <optional>

#include "transport/path/free_path.h"
#include "transport/path/path_vertex.h"
#include "transport/path/ray_caster.h"

namespace abbe {

/// Contribution of a path that joins a camera subpath and a light subpath by one straight segment. Let t be
/// the throughputs of both, f of either end that towards the other (importance of a camera, emission of a
/// light), and T the transmittance of the segment. With G = |cos_a cos_b|/d^2 [Veach1997, eq. 10.3],
///     contribution = t_a f_a t_b f_b G T.
/// The estimate is this over the pdfs of both subpaths. For a light at infinity G is cos_a alone.
struct Connection {
  SampledSpectrum contribution;
  /// Probability, per wavelength, that `propagate` passes the segment without an event.
  SampledSpectrum passing_pdf;
  /// Value that the sensor measures of a contribution of 1; nothing if no polarisation is carried.
  std::optional<StokesSpectrum> stokes = {};
};

/// Connects vertex `a` of a camera subpath with vertex `b` of a light subpath; either may be the camera's or
/// the light's own vertex. Both must have the same wavelengths, and `a` must not be at infinity. Casts a
/// shadow ray. Returns nothing if the ends scatter no light to each other or the segment is occluded.
[[nodiscard]] std::optional<Connection> connect(const Scene& scene, RayCaster& caster, const PathVertex& a,
                                                const PathVertex& b);

/// Transmittance and passing probability of an unoccluded segment that starts at a vertex, as `transmission`
/// returns them.
[[nodiscard]] Transmission transmission_along(const Scene& scene, RayCaster& caster, const PathVertex& from,
                                              const PathSegment& segment);

/// Ray from a vertex in the unit direction `w`, with its origin offset from the vertex's surface.
[[nodiscard]] Ray spawn_towards(const PathVertex& vertex, const Imath::V3f& w);

}  // namespace abbe
