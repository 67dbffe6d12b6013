#include "transport/render/learn_wavelengths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

#include "sensor/film/relative_error.h"
#include "spectral/rgb.h"
#include "transport/path/dimensions.h"
#include "transport/render/pilot.h"
#include "transport/render/pilot_photons.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

constexpr std::uint32_t kPhotons = 1U << 15;
constexpr std::size_t kParts = 64;  // of the distribution
constexpr int kBlocks = 32;         // along an edge of the film
constexpr double kUnlearntShare = 0.1;

/// A value that a photon adds to the film.
struct Splat {
  std::size_t part;   ///< Of the distribution, from which its hero was drawn.
  std::size_t place;  ///< On the film.
  double value;
};

/// The places at which errors are relative to the same mean: each plane of each block of pixels.
class Places {
 public:
  explicit Places(const Scene& scene)
      : camera_(scene.camera),
        planes_(scene.film_planes().size()),
        across_(std::min(kBlocks, scene.camera.width)),
        down_(std::min(kBlocks, scene.camera.height)) {
    if (!scene.mosaic && is_observer(scene.channels)) from_xyz_ = rgb_to_xyz(kRec709).inverse();
  }

  [[nodiscard]] std::size_t count() const {
    return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_) * planes_;
  }
  /// Adds what a photon of that part brings there.
  void add(std::size_t part, const FilmPoint& at, std::span<const double> values,
           std::vector<Splat>& splats) const {
    const int block = at.y * down_ / camera_.height * across_ + at.x * across_ / camera_.width;
    const std::size_t first = static_cast<std::size_t>(block) * planes_;
    const LinearRgb rgb = from_xyz_ ? multiply(*from_xyz_, {values[0], values[1], values[2]}) : LinearRgb();
    for (std::size_t k = 0; k < values.size(); ++k)  // of many bands few have light
      if (const double value = from_xyz_ ? rgb[k] : values[k]; value != 0)
        splats.push_back({part, first + k, value});
  }

 private:
  const Camera& camera_;
  std::size_t planes_;
  int across_;
  int down_;
  std::optional<Matrix3> from_xyz_;  // to linear sRGB
};

using Splats = std::vector<std::vector<Splat>>;  // of each batch

Splats trace_pilots(const Plan& plan, const Places& places, int threads) {
  return trace_pilot_photons(
      plan.scene, {PilotStage::wavelengths, kPhotons}, threads,
      [&](RayCaster& caster) { return LightTracer(plan, caster, 1); },
      [&](LightTracer& tracer, std::span<const Sampler> photons) {
        std::vector<Splat> splats;
        tracer.trace(photons, [&](std::uint32_t i, const FilmPoint& at, std::span<const double> values) {
          // The number that draws the hero is its place in the cumulative distribution.
          const auto part = static_cast<std::size_t>(photons[i].group(kAimGroup)[2] * kParts);
          if (magnitude(values) > 0) places.add(std::min(part, kParts - 1), at, values, splats);
        });
        return splats;
      });
}

// Of the photons of each part the squares of what they add, relative to the squared means around and the
// usual part of that of the film.
std::vector<double> relative_squares(const Splats& batches, const Places& places) {
  std::vector<double> means(places.count());
  for (const std::vector<Splat>& batch : batches)
    for (const Splat& splat : batch) means[splat.place] += splat.value;
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / static_cast<double>(means.size());
  std::vector<double> squares(kParts);
  for (const std::vector<Splat>& batch : batches)
    for (const auto& [part, place, value] : batch)
      squares[part] += value * value / (means[place] * means[place] + kUsualFloor * mean * mean);
  return squares;
}

}  // namespace

// Where photons drawn by p0 add values of relative mean square s at a wavelength, those drawn by p would
// leave the variance of the integral of s p0^2 / p, of which p0 sqrt(s) makes the least.
void learn_wavelengths(Plan& plan, int threads) {
  if (!plan.scene.needs.dispersion || plan.traced_lights.empty()) return;
  const Places places(plan.scene);
  std::vector<double> importance = relative_squares(trace_pilots(plan, places, threads), places);
  for (double& part : importance) part = std::sqrt(part);
  const double mean = std::accumulate(importance.begin(), importance.end(), 0.0) / kParts;
  if (!(mean > 0 && std::isfinite(mean))) return;
  for (double& part : importance) part = (1 - kUnlearntShare) * part / mean + kUnlearntShare;
  WavelengthDistribution& learnt = plan.guides.photon_wavelengths;
  learnt = learnt.weighed(importance);
}

}  // namespace abbe
