#include "materials/bsdf/thin_glass.h"

#include <algorithm>

#include "materials/bsdf/mirror.h"
#include "materials/interface/thin_sheet.h"

namespace abbe {
namespace {

// Reflectance and transmittance of the sheet for unpolarised light.
struct Sheet {
  float reflected, transmitted;
};

Sheet sheet(float cos_i, float n, float depth) {
  const FresnelPower<float> power = sheet_power(cos_i, n, depth);
  return {power.R(), power.transmitted()};
}

}  // namespace

// Each wavelength reflects with the probability R/(R + T).
std::optional<BsdfSample> ThinGlassBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                TransportMode /*mode*/) const {
  if (wo.z == 0) return std::nullopt;
  const float cos_i = std::min(std::abs(wo.z), 1.0F);
  const Sheet chosen = sheet(cos_i, n[hero], depth[hero]);
  const float leaving = chosen.reflected + chosen.transmitted;
  if (!(leaving > 0)) return std::nullopt;
  const bool passes = u.lobe * leaving >= chosen.reflected;
  const float probability = (passes ? chosen.transmitted : chosen.reflected) / leaving;
  SampledSpectrum::Values weight;
  SampledSpectrum::Values lane_pdf;
  for (std::size_t j = 0; j < kLanes; ++j) {
    const Sheet lane = sheet(cos_i, n[static_cast<int>(j)], depth[static_cast<int>(j)]);
    const float part = passes ? lane.transmitted : lane.reflected;
    weight[j] = part / probability;
    lane_pdf[j] = part > 0 ? part / (lane.reflected + lane.transmitted) / probability : 0.0F;
  }
  return BsdfSample{.wi = passes ? -wo : mirrored(wo),
                    .weight = SampledSpectrum(weight),
                    .lane_pdf = SampledSpectrum(lane_pdf),
                    .pdf = probability,
                    .delta = true,
                    .transmitted = passes};
}

SampledSpectrum ThinGlassBsdf::delta_probability(const Imath::V3f& wo) const {
  return SampledSpectrum::map(delta_power(wo, false) + delta_power(wo, true),
                              [](float leaving) { return leaving > 0 ? 1.0F : 0.0F; });
}

SampledSpectrum ThinGlassBsdf::delta_power(const Imath::V3f& wo, bool through) const {
  const float cos_i = std::min(std::abs(wo.z), 1.0F);
  return SampledSpectrum::map(n, depth, [=](float lane_n, float lane_depth) {
    const Sheet lane = sheet(cos_i, lane_n, lane_depth);
    return through ? lane.transmitted : lane.reflected;
  });
}

}  // namespace abbe
