#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>

#include "sensor/film/film.h"
#include "transport/path/film_response.h"
#include "transport/plan/plan.h"
#include "transport/render/render.h"

namespace abbe {

/// Seed of the random numbers of pilots: scene files have none so large.
inline constexpr std::uint64_t kSeedOfPilots = std::uint64_t{1} << 63;

/// What pilots judge film values by: the sum of their magnitudes over the channels, 0 where one is not
/// finite.
[[nodiscard]] inline double magnitude(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return std::isfinite(sum) ? sum : 0;
}

/// A film, of one replicate, of few samples per pixel that depend on nothing but the plan: 65536 paths or so,
/// at least one and at most 16 for each pixel, and as many photons where these are traced. Its random numbers
/// are those of no render, so that what is chosen by it is independent of the samples it is chosen for.
/// Nothing if `stop`, which any thread may ask, says so before it is done.
[[nodiscard]] std::optional<Film> pilot_film(
    const Plan& plan, int threads, std::optional<Crop> crop = {},
    const std::function<bool()>& stop = [] { return false; });

/// What each group of lights adds to such a film in all: to `sums.exposure`, from 16384 paths, and as many
/// photons where these are traced, however many pixels there are.
void pilot_exposures(const Plan& plan, int threads, ExposureByLight& sums);

}  // namespace abbe
