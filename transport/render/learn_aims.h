#pragma once

#include "transport/plan/plan.h"

namespace abbe {

/// Teaches a plan where to aim its photons, by what others expose the film to.
void learn_aims(Plan& plan, int threads);

}  // namespace abbe
