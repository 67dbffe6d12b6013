#pragma once

#include <span>

#include "transport/plan/plan.h"
#include "transport/technique/path_starts.h"

namespace abbe {

/// Trains the plan's photon guides with pilot photons, so that more photons contribute to the film. Also sets
/// `GuidingData::undertrained` and `undertrained_fraction`. Does nothing if no light is traced. The result
/// does not depend on `threads`, which is at least 1.
void train_photon_guides(Plan& plan, int threads);

/// Start of a pilot photon that contributed, with its training weight.
struct PilotStart {
  PhotonStart start;
  double weight;  ///< `PilotRay::weight`.
};

/// Trains the photon guide of each light (`PhotonGuide::train`) with given photon starts. Guides of lights
/// without starts are unchanged.
void train_photon_guides_from(std::span<const PilotStart> starts, Plan& plan);

}  // namespace abbe
