#pragma once

#include <cstdint>
#include <span>

#include "transport/path/film_response.h"
#include "transport/path/ray_caster.h"
#include "transport/plan/plan.h"
#include "transport/technique/bidirectional.h"
#include "transport/technique/brute.h"
#include "transport/technique/light.h"
#include "transport/technique/path.h"
#include "transport/technique/photon_mapping.h"

namespace abbe {

/// The tracers of all integrators, with one ray caster. A plan uses those of its techniques. One instance per
/// thread.
struct Tracers {
  /// `photon_fraction` is the fraction of a sample per pixel that one photon represents. Plan and caster must
  /// outlive the tracers.
  Tracers(const Plan& plan, RayCaster& caster, double photon_fraction)
      : path(plan, caster),
        light(plan, caster, photon_fraction),
        bidirectional(plan, caster),
        photon_gatherer(plan, caster),
        brute_photon(plan, caster, photon_fraction),
        adjoint_brute(plan, caster) {}

  PathTracer path;
  LightTracer light;
  BidirectionalTracer bidirectional;
  PhotonGatherer photon_gatherer;
  BrutePhotonTracer brute_photon;
  AdjointBruteTracer adjoint_brute;
};

/// A `Deposit` that ignores its values, for callers that need only single contributions or rays.
inline void discard_values(std::uint32_t /*path*/, const FilmPoint& /*at*/,
                           std::span<const double> /*values*/) {}

}  // namespace abbe
