#pragma once

#include <span>
#include <string>
#include <vector>

namespace abbe {

/// A known non-linear response, planted so that its recovery can be judged: code value in [0, 1] of a linear
/// exposure, where exposure 1 and above give full scale.
class PlantedResponse {
 public:
  /// "linear"; "gamma:G" (code = x^(1/G), G in [0.2, 5]); or "s-curve", a film-like characteristic with toe
  /// and shoulder, code = x^p (1 + s)/(x^p + s) with p = 1.4, s = 0.18^p. Throws Error{usage} for anything
  /// else.
  explicit PlantedResponse(const std::string& description);

  [[nodiscard]] double code(double exposure) const;
  /// Linear exposure of a code value in [0, 1]: the inverse.
  [[nodiscard]] double exposure(double code) const;

 private:
  double power_ = 1;
  double shoulder_ = 0;  // s; 0 for a pure power
};

/// One channel's code values of every patch at every exposure time.
struct ExposureSeries {
  std::vector<double> times_s;
  std::vector<std::vector<double>> codes;  ///< codes[patch][time], each in [0, 1].
};

/// Photographs `values` (linear, 1 = full scale in one second) for `times_s` through a response, rounded to
/// `bits` bits (0: not rounded).
[[nodiscard]] ExposureSeries expose(std::span<const double> values, std::span<const double> times_s,
                                    const PlantedResponse& response, int bits);

}  // namespace abbe
