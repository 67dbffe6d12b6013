#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "spectral/curve.h"

namespace abbe {

/// Where the wavelengths of packets are drawn from. Each (light, channel) pair gives the density |emission x
/// response|, normalised; 95 % of the density is the plain mean of the distinct ones, 5 % is uniform over the
/// support of the channels. The mean weighs pairs equally whatever their power, because a pixel may see one
/// lamp alone and every channel counts; so with N distinct pairs none is sampled at less than 0.95/N of its
/// own ideal density, and no lamp, line or filter starves.
///
/// Piecewise constant on cells of at most 1 nm that also break at every knot, so that lines and band edges
/// are met exactly.
class WavelengthDistribution {
 public:
  /// From the emission curves of the lights and the weights of the sensor channels. Pairs that do not overlap
  /// are dropped; when none overlaps the density is uniform over the channels' support (or over the whole
  /// range when that is empty).
  WavelengthDistribution(std::span<const Curve> emissions, std::span<const Curve> responses);

  /// The distribution whose density is that of this one times `importance`, of which there is one, above 0,
  /// for each of so many equally probable parts of it, up to a factor.
  [[nodiscard]] WavelengthDistribution weighed(std::span<const double> importance) const;

  /// Eight wavelengths F^-1(frac(u + j/8)) for u in [0, 1), with their densities. Each is rounded to a float
  /// of its own cell, so that the curves and `pdf` see the side of an edge it was drawn on; only a cell with
  /// no float in it (narrower than 1.3e-4 nm) gives the nearest one outside.
  [[nodiscard]] SampledWavelengths sample(float u) const;
  /// Density at a wavelength [1/nm]; 0 outside the support.
  [[nodiscard]] double pdf(double wavelength_nm) const;
  /// Support [nm].
  [[nodiscard]] double low_nm() const { return cells_.front().low_nm; }
  [[nodiscard]] double high_nm() const { return cells_.back().low_nm; }

 private:
  WavelengthDistribution() = default;
  // From the cells makes what else there is.
  void prepare_to_sample();

  // From `low_nm` to the next cell's; the last one only ends the range, with a cdf of 1.
  struct Cell {
    double low_nm;
    double cdf;  // at low_nm
    double density;
    double nm_per_cdf;  // 1/density
  };
  // The same for packets: the floats that lie in the cell, or, where there are none, the last one before it
  // as `most_nm`.
  struct FloatCell {
    float least_nm;
    float most_nm;
    float density;
  };
  using LaneNumbers = std::array<double, kLanes>;
  // The cells that hold these values of the cumulative distribution.
  [[nodiscard]] std::array<std::uint32_t, kLanes> cells_at(const LaneNumbers& cdf) const;

  std::vector<Cell> cells_;
  std::vector<FloatCell> float_cells_;
  std::vector<std::uint32_t> guide_;  // per i of its size: the cell that holds a cdf of i/size
};

}  // namespace abbe
