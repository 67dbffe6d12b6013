#pragma once

#include <optional>

#include "transport/path/free_path.h"
#include "transport/path/path_vertex.h"
#include "transport/path/ray_caster.h"

namespace abbe {

/// What joins the ends of two paths into one: with the throughputs t of both, f of either end towards the
/// other (of a camera its importance, of a light its emission), G = |cos_a cos_b|/d^2 and the transmittance T
/// of the way [Veach1997, eq. 10.3],
///     contribution = t_a f_a t_b f_b G T,
/// so that the path contributes this over the densities of both. To a light at infinity G is cos_a alone.
/// Where polarisation is carried the sensor sees `seen` of a contribution of 1: what the rows of one measure
/// of the vector of the other.
struct Connection {
  SampledSpectrum contribution;
  SampledSpectrum density;  ///< With which `propagate` passes all matter on the way, lane by lane.
  std::optional<StokesSpectrum> seen = {};
};

/// Joins `a` of a path from the camera to `b` of a path from a light, or two vertices of which one is the
/// camera's or the light's own, at the wavelengths of `a`, which `b` has too. Nothing where nothing goes
/// from one to the other, or something stands on the way, which is cast. `a` is not at infinity.
[[nodiscard]] std::optional<Connection> connect(const Scene& scene, RayCaster& caster, const PathVertex& a,
                                                const PathVertex& b);

/// What is left of light that sets out from a vertex along an open way, as of `transmission`.
[[nodiscard]] Transmission transmission_along(const Scene& scene, RayCaster& caster, const PathVertex& from,
                                              const Way& way);

/// The ray that leaves a vertex towards the unit vector `w`, clear of its surface.
[[nodiscard]] Ray leave_towards(const PathVertex& vertex, const Imath::V3f& w);

}  // namespace abbe
