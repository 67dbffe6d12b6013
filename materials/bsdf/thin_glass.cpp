#include "materials/bsdf/thin_glass.h"

#include <algorithm>
#include <cmath>

#include "materials/bsdf/mirror.h"
#include "materials/interface/fresnel.h"

namespace abbe {
namespace {

struct Sheet {
  float reflected, transmitted;
};

// For light of one polarisation, `r` reflected and `t` let pass by each face.
Sheet polarised(float r, float t, float a) {
  const float passed = t * t * a / (1 - r * r * a * a);
  return {r + passed * r * a, passed};
}

Sheet sheet(float cos_i, float n, float depth) {
  const FresnelPower<float> f = fresnel_dielectric(cos_i, n);
  if (!(f.cos_t > 0)) return {1, 0};  // total reflection
  const float a = std::exp(-depth / f.cos_t);
  const Sheet s = polarised(f.Rs, f.Ts, a);
  const Sheet p = polarised(f.Rp, f.Tp, a);
  return {(s.reflected + p.reflected) / 2, (s.transmitted + p.transmitted) / 2};
}

}  // namespace

// A lane is reflected by its share of what leaves.
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

}  // namespace abbe
