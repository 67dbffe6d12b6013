#pragma once

#include <cmath>
#include <numbers>
#include <optional>
#include <variant>

#include <ImathVec.h>

#include "materials/bsdf/warp.h"
#include "materials/coating.h"
#include "spectral/packet.h"

namespace abbe {

/// Which quantity a path carries: radiance (from the camera) or importance's adjoint, power (from a light).
/// Refraction scales radiance by 1/eta^2 and leaves power alone.
enum class TransportMode { radiance, power };

/// Random numbers of one scattering event.
struct BsdfRandom {
  float lobe;
  Imath::V2f direction;
};

/// One scattering event. Directions are local: z along the normal, both away from the surface.
///
/// The direction was drawn by the hero lane. `weight` is f |cos wi| / pdf(hero), lane by lane; `lane_pdf` is
/// pdf(lane)/pdf(hero), so that transport can balance the lanes. Lanes that could not have taken this
/// direction have weight and lane_pdf 0.
struct BsdfSample {
  Imath::V3f wi;
  SampledSpectrum weight;
  SampledSpectrum lane_pdf{1.0F};
  float pdf = 0;  ///< Density of wi for the hero [1/sr]; for a delta event the probability of the event.
  bool delta = false;
  bool transmitted = false;
  bool dispersive = false;  ///< wi depends on wavelength: only the hero follows.
};

/// Lambertian reflection on the side of the normal `wo` is on; both sides alike.
struct DiffuseBsdf {
  SampledSpectrum reflectance;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr bool delta() { return false; }
};

/// Smooth dielectric interface with the normal towards the outside; `n` is the inside index relative to the
/// outside.
struct DielectricBsdf {
  SampledSpectrum n;
  bool dispersive;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr bool delta() { return true; }
};

/// Smooth conductor, opaque, reflecting on both sides.
struct ConductorBsdf {
  SampledSpectrum n;
  SampledSpectrum k;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr bool delta() { return true; }
};

/// Smooth dielectric interface under thin films, which may absorb; it refers to the material and sees the
/// packet `wavelengths_nm`.
struct CoatedDielectricBsdf {
  SampledSpectrum wavelengths_nm;
  const RefractiveIndex* index;
  const Coating* coating;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr bool delta() { return true; }
};

/// Smooth conductor under thin films.
struct CoatedConductorBsdf {
  SampledSpectrum wavelengths_nm;
  const RefractiveIndex* index;
  const Coating* coating;

  [[nodiscard]] std::optional<BsdfSample> sample(const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                                 TransportMode mode) const;
  [[nodiscard]] SampledSpectrum eval(const Imath::V3f& wo, const Imath::V3f& wi, TransportMode mode) const;
  [[nodiscard]] SampledSpectrum pdf(const Imath::V3f& wo, const Imath::V3f& wi) const;
  [[nodiscard]] static constexpr bool delta() { return true; }
};

/// The closed list of scattering models, evaluated at one packet of wavelengths. A new model is a file pair,
/// an entry here, and one in `materials/material.h`; the statistical tests iterate the list.
using Bsdf =
    std::variant<DiffuseBsdf, DielectricBsdf, ConductorBsdf, CoatedDielectricBsdf, CoatedConductorBsdf>;
static_assert(sizeof(Bsdf) <= 3 * sizeof(SampledSpectrum));  // every vertex of a path holds one

[[nodiscard]] std::optional<BsdfSample> sample(const Bsdf& bsdf, const Imath::V3f& wo, const BsdfRandom& u,
                                               int hero, TransportMode mode);
/// f(wo, wi) [1/sr] lane by lane, without the cosine; 0 for delta models.
[[nodiscard]] SampledSpectrum eval(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi,
                                   TransportMode mode);
/// Density with which `sample` would draw wi were each lane the hero [1/sr]; 0 for delta models.
[[nodiscard]] SampledSpectrum pdf(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi);
[[nodiscard]] bool is_delta(const Bsdf& bsdf);
/// Index of the matter behind a surface that lets light in, relative to what is outside, at one lane; 1 for
/// the others.
[[nodiscard]] float index_inside(const Bsdf& bsdf, int lane);
/// Whether nothing leaves, whatever arrives.
[[nodiscard]] bool is_black(const Bsdf& bsdf);

// In line, as scattering off the commonest matter costs less than the calls would.

// f = reflectance/pi, drawn with density cos/pi: the weight is the reflectance for every direction.

inline std::optional<BsdfSample> DiffuseBsdf::sample(const Imath::V3f& wo, const BsdfRandom& u, int /*hero*/,
                                                     TransportMode /*mode*/) const {
  Imath::V3f wi = cosine_hemisphere(u.direction);
  if (wo.z == 0 || wi.z == 0) return std::nullopt;
  const float pdf = wi.z * std::numbers::inv_pi_v<float>;
  wi.z = std::copysign(wi.z, wo.z);
  return BsdfSample{.wi = wi, .weight = reflectance, .pdf = pdf};
}

inline SampledSpectrum DiffuseBsdf::eval(const Imath::V3f& wo, const Imath::V3f& wi,
                                         TransportMode /*mode*/) const {
  return wo.z * wi.z > 0 ? reflectance * std::numbers::inv_pi_v<float> : SampledSpectrum();
}

inline SampledSpectrum DiffuseBsdf::pdf(const Imath::V3f& wo, const Imath::V3f& wi) const {
  return SampledSpectrum(wo.z * wi.z > 0 ? std::abs(wi.z) * std::numbers::inv_pi_v<float> : 0.0F);
}

inline std::optional<BsdfSample> sample(const Bsdf& bsdf, const Imath::V3f& wo, const BsdfRandom& u, int hero,
                                        TransportMode mode) {
  return std::visit([&](const auto& model) { return model.sample(wo, u, hero, mode); }, bsdf);
}

inline SampledSpectrum eval(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi,
                            TransportMode mode) {
  return std::visit([&](const auto& model) { return model.eval(wo, wi, mode); }, bsdf);
}

inline SampledSpectrum pdf(const Bsdf& bsdf, const Imath::V3f& wo, const Imath::V3f& wi) {
  return std::visit([&](const auto& model) { return model.pdf(wo, wi); }, bsdf);
}

inline bool is_delta(const Bsdf& bsdf) {
  return std::visit([](const auto& model) { return model.delta(); }, bsdf);
}

inline float index_inside(const Bsdf& bsdf, int lane) {
  if (const auto* dielectric = std::get_if<DielectricBsdf>(&bsdf)) return dielectric->n[lane];
  const auto* coated = std::get_if<CoatedDielectricBsdf>(&bsdf);
  return coated != nullptr ? coated->index->n(coated->wavelengths_nm)[lane] : 1.0F;
}

inline bool is_black(const Bsdf& bsdf) {
  const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf);
  return diffuse != nullptr && diffuse->reflectance.is_zero();
}

}  // namespace abbe
