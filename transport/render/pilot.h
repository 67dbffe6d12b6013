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

/// Seed of the random numbers of pilots. Scene files cannot have so large a seed.
inline constexpr std::uint64_t kPilotSeed = std::uint64_t{1} << 63;

/// Magnitude of film values for pilots: the sum of their absolute values over the channels, 0 if one is not
/// finite.
[[nodiscard]] inline double magnitude(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return std::isfinite(sum) ? sum : 0;
}

/// Number of rays that pilots may cast to choose how a film is rendered: 64 per pixel, about as many as path
/// tracing casts in ten samples. The samples of the render do not count, because parts of one film may state
/// different ones.
[[nodiscard]] inline double pilot_ray_budget(const Camera& camera) {
  return 64.0 * camera.width * camera.height;
}

/// Column and row of the pixel of a pilot path: element `pilot` of a sequence that covers the whole film
/// evenly. Each value of `stream` selects another sequence.
[[nodiscard]] std::pair<int, int> pilot_pixel(const Camera& camera, std::uint32_t stream,
                                              std::uint32_t pilot);

/// Noise of a pixel as pilots estimate it.
struct PixelNoise {
  double mean = 0;      ///< Mean of the paths' values.
  double variance = 0;  ///< Variance of the value of one path.
};

/// Mean and variance of one path from the values of a pixel's paths. Each replicate has `paths_per_replicate`
/// consecutive values; the variance follows from the scatter of the replicates. There must be two replicates
/// or more, all of equal size.
[[nodiscard]] PixelNoise estimate_pixel_noise(std::span<const double> values,
                                              std::size_t paths_per_replicate);

/// A film of one replicate and few samples per pixel, which depends on the plan alone. It has about 65536
/// paths, at least one and at most 16 per pixel, and as many photons if the plan traces photons. No render
/// uses its random numbers, so choices that follow from it are independent of the samples of the render. The
/// film has the crop `crop`. Empty if `stop` returned true before the film was finished; any thread may call
/// `stop`. `threads` is at least 1. Throws as `Pass::run`.
[[nodiscard]] std::optional<Film> pilot_film(
    const Plan& plan, int threads, std::optional<Crop> crop = {},
    const std::function<bool()>& stop = [] { return false; });

/// A film of eight replicates and at most 65536 camera paths and photons, with which `hidden_noise` compares
/// a small film. No render uses its random numbers. Empty for films of more than 8192 pixels or photons per
/// sample, and if `stop` returned true before the film was finished. Arguments and errors are as for
/// `pilot_film`.
[[nodiscard]] std::optional<Film> noise_pilot(
    const Plan& plan, int threads, std::optional<Crop> crop = {},
    const std::function<bool()>& stop = [] { return false; });

/// Adds to `sums.exposure` what each group of lights contributes to the whole film in a sample. All members
/// of `sums` must be set, with `exposure` of one element per group. The estimate uses 16384 camera paths, and
/// as many photons if the plan traces photons, for any number of pixels. It does not depend on `threads`.
/// Throws Error{resource} if more than `MediumStack::kMaxShapes` media nest.
void pilot_exposures(const Plan& plan, int threads, ExposureByLight& sums);

}  // namespace abbe
