#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <ImathVec.h>

#include "sensor/response/channel.h"
#include "spectral/curve.h"
#include "spectral/packet.h"
#include "spectral/rgb.h"

namespace abbe {

/// Which way an equirectangular image faces. Its top row is `up`, its middle column `forward`, and columns to
/// the right of it lie to the right of who looks there with `up` upwards. Orthogonal, of unit length.
struct EnvironmentFrame {
  Imath::V3d up;
  Imath::V3d forward;
};
/// The middle column looks along +y, or along +x when `up` is (anti)parallel to y, made horizontal and turned
/// by `rotate_deg`, right-handed about `up`, a unit vector.
[[nodiscard]] EnvironmentFrame environment_frame(const Imath::V3d& up, double rotate_deg);

/// Radiance from infinity by direction: texels of equal azimuth and elevation, constant within each, whose
/// linear Rec.709 colours are weights of the spectra of `rgb_basis` times one emission.
class EnvironmentImage {
 public:
  /// Rows from the top. Texels are >= 0 and finite, as many as width * height. Directions are drawn by solid
  /// angle times the film value of a texel, summed over the channels.
  EnvironmentImage(int width, int height, std::vector<std::array<float, 3>> texels,
                   const EnvironmentFrame& frame, const Curve& emission, std::span<const Channel> channels);

  /// Spectral radiance arriving from the unit direction `wi`, in the emission's unit.
  [[nodiscard]] SampledSpectrum radiance(const Imath::V3f& wi, const SampledSpectrum& wavelengths_nm) const;
  /// Draws the unit direction that light comes from; nothing when no texel exposes any channel.
  [[nodiscard]] std::optional<Imath::V3f> sample(Imath::V2f u) const;
  /// Density [1/sr] of `sample`, constant within a texel.
  [[nodiscard]] float pdf(const Imath::V3f& wi) const;

  /// The mean over all directions.
  [[nodiscard]] Curve mean_radiance() const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  [[nodiscard]] std::size_t texel_at(const Imath::V3f& wi) const;
  [[nodiscard]] double row_top(std::size_t row) const;  // cosine with `up` of its upper edge
  [[nodiscard]] double solid_angle(std::size_t row) const;

  std::size_t width_;
  std::size_t height_;
  std::vector<std::array<float, 3>> texels_;
  Imath::V3d up_;
  Imath::V3d forward_;
  Imath::V3d right_;
  std::array<Curve, 3> primaries_;  // emission times the basis
  LinearRgb mean_{0, 0, 0};
  std::vector<double> row_cdf_;     // empty when there is nothing to draw
  std::vector<double> column_cdf_;  // row by row, each ending in 1
};

}  // namespace abbe
