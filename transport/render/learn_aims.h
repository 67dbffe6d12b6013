#pragma once

#include <span>

#include "transport/plan/plan.h"
#include "transport/technique/photon_start.h"

namespace abbe {

/// Teaches a plan where to aim its photons, by what others expose the film to.
void learn_aims(Plan& plan, int threads);

/// The start of a photon that shows where to aim others, and how much it counts.
struct ShownStart {
  PhotonStart start;
  double worth;
};

/// Aims the photons of each light where those that have set out from it show (`Aim::learn`).
void aim_where(std::span<const ShownStart> shown, Plan& plan);

}  // namespace abbe
