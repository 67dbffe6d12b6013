#pragma once

#include <string>

namespace abbe {

/// JSON array of `rows`^2 lights (`rows` >= 1) below the ceiling of the hall in `data/bench/hall.json`, for
/// its key `lights`. They are panels, balls and spots of the illuminants A, D65 and FL11, with luminous
/// fluxes from 1 to 30 lm. Each is in its own cell of a grid of `rows` x `rows`. The positions in the cells
/// and the fluxes follow low-discrepancy sequences, so the result is the same on every platform.
[[nodiscard]] std::string make_lights(int rows);

}  // namespace abbe
