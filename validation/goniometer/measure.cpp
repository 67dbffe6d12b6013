#include "validation/goniometer/measure.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "materials/bsdf/warp.h"

namespace abbe {
namespace {

// Albedo of a material with delta events only, which needs no sampling.
AlbedoReplicates exact_albedo(const Bsdf& bsdf, const Imath::V3f& wo) {
  AlbedoReplicates all{};
  for (int lane = 0; lane < kLanes; ++lane)
    for (const BsdfSample& event : delta_events(bsdf, wo, lane, TransportMode::power)) {
      auto& side = event.transmitted ? all.transmitted : all.reflected;
      for (double& replicate : side[static_cast<std::size_t>(lane)])
        replicate += static_cast<double>(event.pdf * event.weight[lane]);
    }
  return all;
}

// Reflectance and transmittance at many wavelengths. Each packet uses its own random numbers, so that errors
// average out over wavelengths.
struct Spectra {
  std::vector<Replicates> reflected, transmitted;
};
Spectra spectra(const Material& material, const std::vector<double>& wavelengths_nm, const Imath::V3f& wo,
                int samples) {
  Spectra all;
  for (std::size_t first = 0; first < wavelengths_nm.size(); first += kLanes) {
    const SampledSpectrum packet = packet_of(wavelengths_nm, first);
    const Bsdf bsdf = make_bsdf(material, {packet});
    const AlbedoReplicates part =
        scatters(bsdf)
            ? albedo_replicates(sampler_of(bsdf, wo, TransportMode::power), wo, samples, first / kLanes)
            : exact_albedo(bsdf, wo);
    for (std::size_t j = 0; j < kLanes && first + j < wavelengths_nm.size(); ++j) {
      all.reflected.push_back(part.reflected[j]);
      all.transmitted.push_back(part.transmitted[j]);
    }
  }
  return all;
}

std::vector<Estimate> estimates(const std::vector<Replicates>& spectrum) {
  std::vector<Estimate> all;
  for (const Replicates& at : spectrum) all.push_back(estimate(at));
  return all;
}

// Standard error of Y from the Y of each replicate.
double standard_error_of_Y(const std::vector<Replicates>& visible, const GoniometerSettings& settings) {
  const std::vector<XYZ> weights = tristimulus_weights(settings.illuminant, settings.observer);
  double white = 0;
  for (const XYZ& weight : weights) white += weight[1];
  Replicates Y{};
  for (std::size_t i = 0; i < visible.size(); ++i)
    for (std::size_t r = 0; r < kReplicates; ++r) Y[r] += 100 * weights[i][1] / white * visible[i][r];
  return estimate(Y).standard_error;
}

ScatteredColor color_of(const std::vector<Replicates>& visible, const GoniometerSettings& settings) {
  std::vector<Knot> knots;
  for (const double nm : visible_wavelengths()) knots.push_back({nm, estimate(visible[knots.size()]).mean});
  const XYZ xyz = tristimulus(settings.illuminant, Curve(std::move(knots)), settings.observer);
  return {xyz, xyz_to_lab(xyz, tristimulus(settings.illuminant, Curve(1.0), settings.observer)),
          standard_error_of_Y(visible, settings)};
}

// A colour is a mean over wavelengths, so few samples of each are enough.
void add_colors(const Material& material, const Imath::V3f& wo, const GoniometerSettings& settings,
                GoniometerAngle& at) {
  constexpr int kSampleDivisor = 32;
  constexpr int kMinSamples = 64;
  const Spectra measured =
      spectra(material, visible_wavelengths(), wo, std::max(settings.samples / kSampleDivisor, kMinSamples));
  at.reflected_color = color_of(measured.reflected, settings);
  at.transmitted_color = color_of(measured.transmitted, settings);
}

GoniometerAngle measure_angle(const Material& material, const GoniometerSettings& settings,
                              double angle_deg) {
  const Imath::V3f wo = incidence(settings, angle_deg);
  const Spectra measured = spectra(material, settings.wavelengths_nm, wo, settings.samples);
  GoniometerAngle at{angle_deg, estimates(measured.reflected), estimates(measured.transmitted), {}, {}, 1, 0};
  add_colors(material, wo, settings, at);
  const SampledSpectrum packet = packet_of(settings.wavelengths_nm, 0);
  const Bsdf bsdf = make_bsdf(material, {packet});
  if (!scatters(bsdf)) return at;
  const DensityCheck check = check_density(
      sampler_of(bsdf, wo, TransportMode::radiance),
      [&](const Imath::V3f& wi) { return static_cast<double>(pdf(bsdf, wo, wi)[0]); }, 0);
  at.sampling_p = check.p;
  at.non_delta_probability = check.integral;
  return at;
}

}  // namespace

Imath::V3f incidence(const GoniometerSettings& settings, double angle_deg) {
  const double cosine = std::cos(angle_deg * std::numbers::pi / 180);
  return direction_at(settings.from_inside ? -cosine : cosine, std::numbers::pi);
}

std::vector<double> visible_wavelengths() {
  std::vector<double> visible;
  for (int nm = SumRange{}.low_nm; nm <= SumRange{}.high_nm; ++nm) visible.push_back(nm);
  return visible;
}

SampledSpectrum packet_of(const std::vector<double>& wavelengths_nm, std::size_t first) {
  SampledSpectrum::Values packet;
  for (std::size_t j = 0; j < kLanes; ++j)
    packet[j] = static_cast<float>(wavelengths_nm[std::min(first + j, wavelengths_nm.size() - 1)]);
  return SampledSpectrum(packet);
}

GoniometerReport measure(const Material& material, const GoniometerSettings& settings) {
  GoniometerReport report{lobes(material), is_dispersive(material), {}, {}, 0};
  for (const double angle : settings.angles_deg)
    report.angles.push_back(measure_angle(material, settings, angle));
  const SampledSpectrum packet = packet_of(settings.wavelengths_nm, 0);
  report.reciprocity = reciprocity_error(make_bsdf(material, {packet}));
  for (const GoniometerAngle& at : report.angles)
    for (std::size_t i = 0; i < at.reflected.size(); ++i)
      report.max_albedo = std::max(report.max_albedo, at.reflected[i].mean + at.transmitted[i].mean);
  return report;
}

}  // namespace abbe
