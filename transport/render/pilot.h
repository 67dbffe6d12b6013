#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

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

/// The rays that pilots may cast to choose how a film is rendered: 64 for each of its pixels, about what path
/// tracing does in ten samples, so that they cost little of it. The samples themselves do not count, as parts
/// of one film may state different ones.
[[nodiscard]] inline double rays_of_pilots(const Camera& camera) {
  return 64.0 * camera.width * camera.height;
}

/// A pixel of the film that a pilot looks at: one of a sequence spread over all of it.
[[nodiscard]] std::pair<int, int> pixel_of_pilot(const Camera& camera, std::uint32_t stream,
                                                 std::uint32_t pilot);

/// What pilots find of a pixel: the mean, and the variance of a path as replicates tell it.
struct PixelNoise {
  double mean = 0;
  double variance = 0;
};

/// Of the values of its paths, so many of them one after the other in each replicate.
[[nodiscard]] PixelNoise noise_of_pixel(std::span<const double> values, std::size_t paths_of_replicate);

/// A film, of one replicate, of few samples per pixel that depend on nothing but the plan: 65536 paths or so,
/// at least one and at most 16 for each pixel, and as many photons where these are traced. Its random numbers
/// are those of no render, so that what is chosen by it is independent of the samples it is chosen for.
/// Nothing if `stop`, which any thread may ask, says so before it is done.
[[nodiscard]] std::optional<Film> pilot_film(
    const Plan& plan, int threads, std::optional<Crop> crop = {},
    const std::function<bool()>& stop = [] { return false; });

/// A film of eight replicates and at most 65536 camera paths and as many photons, for `hidden_noise` to
/// compare a small film with. No render has its random numbers. Nothing for films of more than 8192 pixels or
/// photons per sample, and if `stop` returns true before it is done.
[[nodiscard]] std::optional<Film> noise_pilot(
    const Plan& plan, int threads, std::optional<Crop> crop = {},
    const std::function<bool()>& stop = [] { return false; });

/// What each group of lights adds to such a film in all: to `sums.exposure`, from 16384 paths, and as many
/// photons where these are traced, however many pixels there are.
void pilot_exposures(const Plan& plan, int threads, ExposureByLight& sums);

}  // namespace abbe
