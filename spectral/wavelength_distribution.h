#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "spectral/curve.h"

namespace abbe {

/// Distribution from which the wavelengths of paths are sampled. Each (light, channel) pair gives the
/// normalised density |emission x response|. The plain mean of the distinct pairs makes up 95 % of the
/// density. The other 5 % are uniform over the support of the channels. The mean weights pairs equally
/// whatever their power, because one light can dominate a pixel and every channel counts. With N distinct
/// pairs, each is sampled with at least 0.95/N of its own ideal density.
///
/// The density is piecewise constant on cells of at most 1 nm. Cells end at every knot, so that lines and
/// band edges are exact.
class WavelengthDistribution {
 public:
  /// Constructs the distribution from the emission curves of the lights and the weights of the sensor
  /// channels, in any units. Negative values count by their magnitude. If no pair overlaps, the density is
  /// uniform over the support of the channels, or over the whole range if that is empty.
  WavelengthDistribution(std::span<const Curve> emissions, std::span<const Curve> responses);

  /// Distribution whose density is proportional to this one times `importance`. The elements of `importance`,
  /// at least one, are > 0. They belong to equally probable parts of this distribution, by ascending
  /// wavelength.
  [[nodiscard]] WavelengthDistribution weighted(std::span<const double> importance) const;

  /// Eight wavelengths F^-1(frac(u + j/8)) for u in [0, 1), and their pdfs [1/nm]. Lane j has the wavelength
  /// of j/8. Each is rounded to a float of its own cell, so that curves and `pdf` take the same side of an
  /// edge. A cell narrower than 1.3e-4 nm may contain no float; it gives the nearest one outside.
  [[nodiscard]] SampledWavelengths sample(float u) const;
  /// Pdf at a wavelength [1/nm]; 0 outside the support.
  [[nodiscard]] double pdf(double wavelength_nm) const;
  /// Ends of the support [nm]. `pdf` is 0 at `high_nm` and above.
  [[nodiscard]] double low_nm() const { return cells_.front().low_nm; }
  [[nodiscard]] double high_nm() const { return cells_.back().low_nm; }

 private:
  WavelengthDistribution() = default;
  // Builds the tables for sampling from the cells.
  void prepare_to_sample();

  // A cell extends to `low_nm` of the next one. The last one only ends the range, with a cdf of 1.
  struct Cell {
    double low_nm;
    double cdf;  // at low_nm
    double density;
    double nm_per_cdf;  // 1/density
  };
  // Float copy of a cell for packets: the range of its floats. If it contains none, `max_nm` is the last
  // float before it.
  struct FloatCell {
    float min_nm;
    float max_nm;
    float density;
  };
  using LaneValues = std::array<double, kLanes>;
  // Cells that contain these values of the cumulative distribution.
  [[nodiscard]] std::array<std::uint32_t, kLanes> cells_at(const LaneValues& cdf) const;

  std::vector<Cell> cells_;
  std::vector<FloatCell> float_cells_;
  std::vector<std::uint32_t> guide_;  // entry i: the cell that contains a cdf of i/size
};

}  // namespace abbe
