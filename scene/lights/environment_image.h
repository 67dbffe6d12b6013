#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <ImathVec.h>

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

}  // namespace abbe
