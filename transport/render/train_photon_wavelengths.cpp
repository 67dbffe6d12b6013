#include "transport/render/train_photon_wavelengths.h"

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
constexpr std::size_t kWavelengthBins = 64;  // bins of equal probability of the distribution
constexpr double kUniformFraction = 0.1;

// Splats of the photons on the film, by the bin of the wavelength distribution that their hero was sampled
// from.
std::vector<Splat> trace_pilots(const Plan& plan, const RelativeErrorCells& cells, int threads) {
  std::vector<Splat> all;
  for (const std::vector<Splat>&batch : trace_pilot_photons(
           plan.scene, {PilotStage::wavelengths, kPhotons}, threads,
           [&](RayCaster&caster) { return LightTracer(plan, caster, 1); },
           [&](LightTracer&tracer, std::span<const Sampler> photons) {
             std::vector<Splat> splats;
             tracer.trace(photons, [&](std::uint32_t i, const FilmPoint& at, std::span<const double> values) {
               // The random number that samples the hero is its position in the cumulative distribution.
               const auto bin =
                   static_cast<std::size_t>(photons[i].group(kPhotonGuideGroup)[2] * kWavelengthBins);
               if (magnitude(values) > 0) cells.add(std::min(bin, kWavelengthBins - 1), at, values, splats);
             });
             return splats;
           }))
    all.insert(all.end(), batch.begin(), batch.end());
  return all;
}

}  // namespace

// Let photons drawn with density p0 add values of relative mean square s at a wavelength. Drawn with density
// p, they have the variance of the integral of s p0^2 / p, which is least for p proportional to p0 sqrt(s).
void train_photon_wavelengths(Plan& plan, int threads) {
  if (!plan.scene.features.dispersion || plan.traced_lights.empty()) return;
  const RelativeErrorCells cells(plan.scene);
  std::vector<double> importance =
      relative_squares(trace_pilots(plan, cells, threads), cells, kWavelengthBins);
  for (double& bin : importance) bin = std::sqrt(bin);
  const double mean = std::accumulate(importance.begin(), importance.end(), 0.0) / kWavelengthBins;
  if (!(mean > 0 && std::isfinite(mean))) return;
  for (double& bin : importance) bin = (1 - kUniformFraction) * bin / mean + kUniformFraction;
  WavelengthDistribution& wavelengths = plan.guides.photon_wavelengths;
  wavelengths = wavelengths.weighted(importance);
}

}  // namespace abbe
