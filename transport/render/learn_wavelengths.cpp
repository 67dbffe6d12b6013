#include "transport/render/learn_wavelengths.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "transport/path/dimensions.h"
#include "transport/render/pilot.h"
#include "transport/render/pilot_photons.h"
#include "transport/render/relative_splats.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

constexpr std::uint32_t kPhotons = 1U << 15;
constexpr std::size_t kParts = 64;  // of the distribution
constexpr double kUnlearntShare = 0.1;

// What photons add to the film, by the part of the distribution that their hero was drawn from.
std::vector<Splat> trace_pilots(const Plan& plan, const RelativePlaces& places, int threads) {
  std::vector<Splat> all;
  for (const std::vector<Splat>&batch : trace_pilot_photons(
           plan.scene, {PilotStage::wavelengths, kPhotons}, threads,
           [&](RayCaster&caster) { return LightTracer(plan, caster, 1); },
           [&](LightTracer&tracer, std::span<const Sampler> photons) {
             std::vector<Splat> splats;
             tracer.trace(photons, [&](std::uint32_t i, const FilmPoint& at, std::span<const double> values) {
               // The number that draws the hero is its place in the cumulative distribution.
               const auto part = static_cast<std::size_t>(photons[i].group(kAimGroup)[2] * kParts);
               if (magnitude(values) > 0) places.add(std::min(part, kParts - 1), at, values, splats);
             });
             return splats;
           }))
    all.insert(all.end(), batch.begin(), batch.end());
  return all;
}

}  // namespace

// Where photons drawn by p0 add values of relative mean square s at a wavelength, those drawn by p would
// leave the variance of the integral of s p0^2 / p, of which p0 sqrt(s) makes the least.
void learn_wavelengths(Plan& plan, int threads) {
  if (!plan.scene.needs.dispersion || plan.traced_lights.empty()) return;
  const RelativePlaces places(plan.scene);
  std::vector<double> importance = relative_squares(trace_pilots(plan, places, threads), places, kParts);
  for (double& part : importance) part = std::sqrt(part);
  const double mean = std::accumulate(importance.begin(), importance.end(), 0.0) / kParts;
  if (!(mean > 0 && std::isfinite(mean))) return;
  for (double& part : importance) part = (1 - kUnlearntShare) * part / mean + kUnlearntShare;
  WavelengthDistribution& learnt = plan.guides.photon_wavelengths;
  learnt = learnt.weighed(importance);
}

}  // namespace abbe
