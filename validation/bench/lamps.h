#pragma once

#include <string>

namespace abbe {

/// The lights of a scene file as JSON: `rows`^2 lamps below the ceiling of the hall in
/// `data/bench/hall.json`, panels, balls and spots of three spectra, which differ in strength by a factor of
/// up to 30; the same everywhere.
[[nodiscard]] std::string make_lamps(int rows);

}  // namespace abbe
