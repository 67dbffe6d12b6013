#pragma once

#include <string>

namespace abbe {

/// JSON array of `rows`^2 lights below the ceiling of the hall in `data/bench/hall.json`. They are panels,
/// balls and spots of three spectra, and their powers differ by up to a factor of 30. The positions follow a
/// low-discrepancy sequence, so the result is the same on every platform.
[[nodiscard]] std::string make_lights(int rows);

}  // namespace abbe
