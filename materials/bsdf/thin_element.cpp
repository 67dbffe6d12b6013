#include "materials/bsdf/thin_element.h"

#include <algorithm>
#include <numbers>

#include "materials/interface/thin_sheet.h"

namespace abbe {

namespace {

// A unit vector in the surface at an angle [rad] from u, counterclockwise for a viewer outside.
Imath::V2d surface_axis(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

}  // namespace

// Each wavelength reflects with the probability R/(R + T).
std::optional<BsdfSample> ThinGlassBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                TransportMode /*mode*/) const {
  if (wo.z == 0) return std::nullopt;
  const float cos_i = std::min(std::abs(wo.z), 1.0F);
  const FresnelPower<float> chosen = sheet_power(cos_i, n[hero], depth[hero]);
  const float leaving = chosen.R() + chosen.transmitted();
  if (!(leaving > 0)) return std::nullopt;
  const bool passes = u.lobe * leaving >= chosen.R();
  const float probability = (passes ? chosen.transmitted() : chosen.R()) / leaving;
  SampledSpectrum::Values weight;
  SampledSpectrum::Values lane_pdf;
  for (std::size_t j = 0; j < kLanes; ++j) {
    const FresnelPower<float> lane = sheet_power(cos_i, n[static_cast<int>(j)], depth[static_cast<int>(j)]);
    const float part = passes ? lane.transmitted() : lane.R();
    weight[j] = part / probability;
    lane_pdf[j] = part > 0 ? part / (lane.R() + lane.transmitted()) / probability : 0.0F;
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
    const FresnelPower<float> lane = sheet_power(cos_i, lane_n, lane_depth);
    return through ? lane.transmitted() : lane.R();
  });
}

ThinGlassBsdf ThinGlassMaterial::bsdf(const SurfaceLookup& at) const {
  return {relative_index(index, at.outside, at.wavelengths_nm).n,
          index.absorption_per_m(at.wavelengths_nm) * static_cast<float>(thickness)};
}

PolariserBsdf PolariserMaterial::bsdf(const SurfaceLookup& at) const {
  const SampledSpectrum across = blocked(at.wavelengths_nm);
  return {{transmittance(at.wavelengths_nm) * (SampledSpectrum(1) + across) * 0.5F},
          across,
          Imath::V2f(surface_axis(angle))};
}

double WavePlateMaterial::retardance(double wavelength_nm) const {
  if (const auto* ideal = std::get_if<Ideal>(&kind)) return ideal->retardance;
  const auto& crystal = std::get<Crystal>(kind);
  return 2 * std::numbers::pi * crystal.birefringence(wavelength_nm) * crystal.thickness /
         (wavelength_nm * 1e-9);
}

// The retardance of plates of high order is many times 2 pi, so it is reduced in double.
WavePlateBsdf WavePlateMaterial::bsdf(const SurfaceLookup& at) const {
  return {
      {transmittance(at.wavelengths_nm)},
      SampledSpectrum::map(at.wavelengths_nm,
                           [this](float nm) {
                             return static_cast<float>(std::remainder(retardance(nm), 2 * std::numbers::pi));
                           }),
      Imath::V2f(surface_axis(angle))};
}

std::optional<MuellerMatrix> ThinGlassBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& wi,
                                                    bool /*delta*/, std::optional<int> lane) const {
  const float cos_i = std::min(std::abs(wo.z), 1.0F);
  const bool through = wo.z * wi.z < 0;
  return mueller_of_surface(wo, lane, [&](int j) {
    const InterfaceMueller<float> pane = sheet_mueller(cos_i, n[j], depth[j]);
    return through ? pane.through : pane.reflected;
  });
}

std::optional<MuellerMatrix> PolariserBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& /*wi*/,
                                                    bool /*delta*/, std::optional<int> /*lane*/) const {
  return mueller_of_lanes(projected_axis(axis, wo), [&](int j) { return polariser_mueller(blocked[j]); });
}

std::optional<MuellerMatrix> WavePlateBsdf::mueller(const Imath::V3f& wo, const Imath::V3f& /*wi*/,
                                                    bool /*delta*/, std::optional<int> /*lane*/) const {
  return mueller_of_lanes(projected_axis(axis, wo), [&](int j) { return wave_plate_mueller(retardance[j]); });
}

std::optional<FresnelPower<double>> ThinGlassMaterial::smooth_power(const SmoothLookup& at) const {
  return sheet_power(at.cos_i, index.n(at.wavelength_nm) / at.outside,
                     index.absorption_per_m(at.wavelength_nm) * thickness);
}

SmoothMueller ThinGlassMaterial::smooth_mueller(const SmoothLookup& at) const {
  return {sheet_mueller(at.cos_i, index.n(at.wavelength_nm) / at.outside,
                        index.absorption_per_m(at.wavelength_nm) * thickness)};
}

std::optional<FresnelPower<double>> PolariserMaterial::smooth_power(const SmoothLookup& at) const {
  return at.undeflected(mean_transmittance(at.wavelength_nm));
}

SmoothMueller PolariserMaterial::smooth_mueller(const SmoothLookup& at) const {
  return {{{}, polariser_mueller(blocked(at.wavelength_nm))}, surface_axis(angle)};
}

SmoothMueller WavePlateMaterial::smooth_mueller(const SmoothLookup& at) const {
  return {{{}, wave_plate_mueller(retardance(at.wavelength_nm))}, surface_axis(angle)};
}

}  // namespace abbe
