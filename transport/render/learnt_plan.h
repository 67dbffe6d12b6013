#pragma once

#include <memory>

#include "transport/plan/plan.h"

namespace abbe {

/// The plan of a scene whose photons, where camera paths go beside them, are aimed by what pilots show to
/// reach the film (`learn_aims`), with wavelengths drawn where these leave noise (`learn_wavelengths`), and
/// whose camera paths look for caustics where photons show them (`learn_caustics`). What is learnt depends on
/// the scene alone, neither on its seed nor on its samples, nor on the threads, which change nothing but the
/// time it takes; guides that are known from before are taken instead. Throws what `make_plan` throws.
[[nodiscard]] Plan make_learnt_plan(const Scene& scene, int threads,
                                    const std::shared_ptr<const Guides>& guides = {});

}  // namespace abbe
