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

/// Orientation of an equirectangular image. Its top row is `up` and its center column `forward`. Columns
/// farther right lie to the right of an observer who looks forward with `up` upwards. Orthogonal unit
/// vectors.
struct EnvironmentFrame {
  Imath::V3d up;
  Imath::V3d forward;
};
/// Frame whose center column looks along +y, or along +x if `up` is parallel to y. That direction is made
/// horizontal and rotated by `rotate_deg`, right-handed about the unit vector `up`.
[[nodiscard]] EnvironmentFrame environment_frame(const Imath::V3d& up, double rotate_deg);

/// Radiance from infinity as a function of direction. Texels have equal azimuth and elevation and are
/// constant. Their linear Rec.709 colours weight the spectra of `rgb_basis`, times one emission spectrum.
class EnvironmentImage {
 public:
  /// Rows start at the top. The width * height texels are finite and >= 0. Directions are sampled in
  /// proportion to solid angle times the film value of a texel, summed over the channels.
  EnvironmentImage(int width, int height, std::vector<std::array<float, 3>> texels,
                   const EnvironmentFrame& frame, const Curve& emission, std::span<const Channel> channels);

  /// Spectral radiance arriving from the unit direction `wi`, in the emission's unit.
  [[nodiscard]] SampledSpectrum radiance(const Imath::V3f& wi, const SampledSpectrum& wavelengths_nm) const;
  /// Samples the unit direction towards incident light; nothing if no texel exposes any channel.
  [[nodiscard]] std::optional<Imath::V3f> sample(Imath::V2f u) const;
  /// Density [1/sr] of `sample`, constant within a texel.
  [[nodiscard]] float pdf(const Imath::V3f& wi) const;

  /// Mean over all directions.
  [[nodiscard]] Curve mean_radiance() const;
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
