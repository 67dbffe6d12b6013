#pragma once

#include <span>

#include "transport/plan/plan.h"
#include "transport/technique/photon_start.h"

namespace abbe {

/// Trains the plan's photon guides with pilot photons, so that more photons contribute to the film.
void train_photon_guides(Plan& plan, int threads);

/// Start of a pilot photon that contributed, with its training weight.
struct PilotStart {
  PhotonStart start;
  double weight;
};

/// Trains the photon guide of each light (`Aim`) with given photon starts.
void train_photon_guides_from(std::span<const PilotStart> starts, Plan& plan);

}  // namespace abbe
