#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <ImathVec.h>

#include "scene/lights/model.h"
#include "sensor/response/channel.h"
#include "spectral/curve.h"
#include "spectral/rgb.h"
#include "spectral/sampled_spectrum.h"

namespace abbe {

/// Orientation of an equirectangular image, by orthogonal unit vectors in render coordinates. Light from the
/// direction `up` is at the top edge, light from `forward` in the center. Columns farther right lie to the
/// right of an observer who looks forward with `up` upwards.
struct EnvironmentFrame {
  Imath::V3d up;
  Imath::V3d forward;
};
/// Frame whose center column looks along +y, or along +x if `up` is parallel to y. That direction is made
/// horizontal and rotated by `rotate_deg`, right-handed about the unit vector `up`.
[[nodiscard]] EnvironmentFrame environment_frame(const Imath::V3d& up, double rotate_deg);

/// Radiance from infinity as a function of direction. Texels span equal steps of azimuth and elevation and
/// are constant. Their linear Rec.709 colours weight the spectra of `rgb_basis`, times one emission spectrum.
class EnvironmentImage {
 public:
  /// Takes width * height texels, row by row from the top and from left to right, finite and >= 0; this is
  /// not checked. `emission` is the spectral radiance of a texel (1, 1, 1). Directions are sampled in
  /// proportion to solid angle times the film value of a texel, summed by magnitude over `channels`.
  /// `channels` need not outlive it.
  EnvironmentImage(int width, int height, std::vector<std::array<float, 3>> texels,
                   const EnvironmentFrame& frame, const Curve& emission, std::span<const Channel> channels);

  /// Spectral radiance arriving from the direction `wi`, which points away from the scene, in the emission's
  /// unit.
  [[nodiscard]] SampledSpectrum radiance(const Imath::V3f& wi, const SampledSpectrum& wavelengths_nm) const;
  /// Samples the unit direction towards incident light by `u` in [0, 1)^2; nothing if no texel exposes any
  /// channel.
  [[nodiscard]] std::optional<Imath::V3f> sample(Imath::V2f u) const;
  /// Density [1/sr] of `sample`, constant within a texel; 0 if no texel exposes any channel.
  [[nodiscard]] float pdf(const Imath::V3f& wi) const;

  /// Mean spectral radiance over all directions by solid angle, in the emission's unit.
  [[nodiscard]] Curve mean_radiance() const;
  /// Memory in bytes of texels and sampling tables.
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  [[nodiscard]] std::size_t texel_at(const Imath::V3f& wi) const;
  [[nodiscard]] double row_top(std::size_t row) const;  // cosine with `up` of the row's upper edge
  [[nodiscard]] double solid_angle(std::size_t row) const;

  std::size_t width_;
  std::size_t height_;
  std::vector<std::array<float, 3>> texels_;
  Imath::V3d up_;
  Imath::V3d forward_;
  Imath::V3d right_;
  std::array<Curve, 3> primaries_;  // emission times the RGB basis
  LinearRgb mean_{0, 0, 0};
  std::vector<double> row_cdf_;     // empty if no texel exposes any channel
  std::vector<double> column_cdf_;  // row by row, each ends in 1
};

/// Light from infinity: uniform radiance, or that of an image.
struct EnvironmentLight {
  static constexpr bool kIsDelta = false;
  static constexpr bool kAtInfinity = true;

  std::shared_ptr<const EnvironmentImage> image = nullptr;

  // Functions of `LightModel`. With an image, directions are sampled in proportion to it. Otherwise they are
  // in proportion to the cosine on the receiving side, or uniform if there is no such side.
  [[nodiscard]] std::optional<LightSample> sample(const LightQuery& query) const;
  [[nodiscard]] float pdf(const Shapes& shapes, const LightHit& at) const;
  [[nodiscard]] SampledSpectrum emission_from(const ScaledCurve& emission, const Imath::V3f& wi,
                                              const SampledSpectrum& wavelengths_nm) const;
  [[nodiscard]] ScaledCurve mean_emission(const ScaledCurve& emission) const {
    return image ? ScaledCurve(image->mean_radiance()) : emission;
  }
  [[nodiscard]] EmissionDensity emission_density(const EmissionQuery& query) const;
  [[nodiscard]] double etendue(double across) const { return 4 * std::numbers::pi * across; }
  [[nodiscard]] LightBounds bounds(const Shapes& shapes, double emission) const;
  [[nodiscard]] double solid_angle() const { return 4 * std::numbers::pi; }
  [[nodiscard]] std::size_t memory_bytes() const { return image ? image->memory_bytes() : 0; }
};

/// Parallel light from infinity. `towards` is the unit direction from the scene towards the source.
struct DirectionalLight {
  static constexpr bool kIsDelta = true;
  static constexpr bool kAtInfinity = true;

  Imath::V3f towards{0, 0, 1};

  // Functions of `LightModel`.
  [[nodiscard]] std::optional<LightSample> sample(const LightQuery& query) const;
  [[nodiscard]] EmissionDensity emission_density(const EmissionQuery& query) const;
  [[nodiscard]] double etendue(double across) const { return across; }
  [[nodiscard]] LightBounds bounds(const Shapes& shapes, double emission) const;
  [[nodiscard]] std::optional<DirectionCone> beam() const { return DirectionCone{towards, 0}; }
  [[nodiscard]] std::optional<BasicRay<double>> central_ray(const Ball& sphere) const;
};

/// A disc at infinity around the unit direction `towards`, with uniform radiance and visible to cameras. It
/// is sampled uniformly over its solid angle.
struct SunLight {
  static constexpr bool kIsDelta = false;
  static constexpr bool kAtInfinity = true;

  Imath::V3f towards{0, 0, 1};
  float cap = 1;  ///< 1 - cos of its angular radius, in (0, 1].

  /// True if the unit direction `wi` points to the disc.
  [[nodiscard]] bool contains(const Imath::V3f& wi) const { return (wi - towards).length2() <= 2 * cap; }
  /// Irradiance of a perpendicular surface divided by the radiance [sr]: pi sin^2 of the angular radius.
  [[nodiscard]] double projected_solid_angle() const;

  // Functions of `LightModel`.
  [[nodiscard]] std::optional<LightSample> sample(const LightQuery& query) const;
  [[nodiscard]] float pdf(const Shapes& shapes, const LightHit& at) const;
  [[nodiscard]] EmissionDensity emission_density(const EmissionQuery& query) const;
  [[nodiscard]] double etendue(double across) const { return projected_solid_angle() * across; }
  [[nodiscard]] LightBounds bounds(const Shapes& shapes, double emission) const;
  [[nodiscard]] std::optional<DirectionCone> beam() const { return DirectionCone{towards, cap}; }
  [[nodiscard]] bool is_visible_along(const Imath::V3f& wi) const { return contains(wi); }
  [[nodiscard]] double solid_angle() const { return 2 * std::numbers::pi * static_cast<double>(cap); }
  [[nodiscard]] std::optional<BasicRay<double>> central_ray(const Ball& sphere) const;
};

}  // namespace abbe
