#pragma once

#include <vector>

namespace abbe {

/// The times at which the rows of a film are exposed, and the transmittance of the shutter. Rows count from 0
/// at the top. Each row is exposed for the exposure time T. The first row starts at time 0, each further one
/// `delay` T later. The whole film is exposed over the span T (1 + (rows - 1) delay); ray times are fractions
/// of it. After the fraction s of its exposure, a row has the transmittance S(s). It records the integral of
/// S E over time for an irradiance E.
class Shutter {
 public:
  /// The transmittance after a fraction of a row's exposure; linear between knots.
  struct Knot {
    double time = 0;           ///< Fraction of the row's exposure time, in [0, 1].
    double transmittance = 1;  ///< In [0, 1].
  };

  /// A global shutter, fully open for the whole exposure.
  Shutter() = default;
  /// Builds a shutter. The times of the knots do not decrease; the first is 0, the last 1, and the mean
  /// transmittance is positive. `delay` >= 0 is that between rows, as a fraction of the exposure time. These
  /// conditions are not checked.
  Shutter(std::vector<Knot> knots, double delay, int rows);

  /// Mean of S, in (0, 1]: the factor on the exposure time if nothing changes during the exposure.
  [[nodiscard]] double mean() const { return mean_; }
  /// The span divided by the exposure time: 1 + (rows - 1) delay.
  [[nodiscard]] double span() const { return span_; }
  /// Samples a ray time at which the row is exposed, in proportion to S, by `u` in [0, 1). The time is a
  /// fraction of the span, in [0, 1]. Light at that time has the weight `mean`.
  [[nodiscard]] float sample(int row, float u) const { return plain_ ? u : sample_row(row, u); }
  /// Weight of light that arrives at the row at a ray time that is uniform over the span: S, divided by the
  /// fraction of the span for which a row is open. 0 while the row is not exposed.
  [[nodiscard]] float weight(int row, float time) const {
    return plain_ ? static_cast<float>(mean_) : row_weight(row, time);
  }

  /// The equivalent shutter for a static scene, with constant transmittance `mean`.
  [[nodiscard]] Shutter static_equivalent() const;

 private:
  [[nodiscard]] float sample_row(int row, float u) const;
  [[nodiscard]] float row_weight(int row, float time) const;

  std::vector<Knot> knots_ = {{0, 1}, {1, 1}};
  std::vector<double> cdf_ = {0, 1};  // per knot: cumulative fraction of the transmitted light
  double mean_ = 1;
  double delay_ = 0;
  double span_ = 1;
  bool plain_ = true;  // constant transmittance, and all rows at once
};

}  // namespace abbe
