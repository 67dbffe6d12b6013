#pragma once

#include <optional>

#include "sensor/film/crop.h"
#include "transport/plan/plan.h"

namespace abbe {

/// Sets how many camera paths of a sample go through each pixel of a crop: 1, 2 or 4, most where pilots find
/// most noise. A film of the costs c_i and variances v_i of a path through each pixel, of which n_i are
/// traced, has the least relMSE for what it costs where n_i is as the root of v_i/c_i, the v_i being relative
/// to the squared mean around and a hundredth of the film's. Costs are rays counted. Pilots trace 32
/// paths through each of two pixels of at most 16384 square blocks, in eight replicates, as a render does,
/// with random numbers of no render: what is chosen by them is independent of the samples it is chosen for,
/// and depends on nothing but plan and crop. Where they expect to gain less than a tenth, or where path
/// tracing is none of the plan's techniques, all pixels are left alike.
void learn_density(Plan& plan, const std::optional<Crop>& crop, int threads);

}  // namespace abbe
