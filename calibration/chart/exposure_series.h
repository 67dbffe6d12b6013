#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace abbe {

/// A known camera response for tests of its recovery. It maps linear exposure to a code value in [0, 1] and
/// rises strictly between 0 and 1. Exposures of 1 and above give full scale, negative ones 0.
class PlantedResponse {
 public:
  /// Parses "linear", "gamma:G" (code = x^(1/G), G in [0.2, 5]) or "s-curve". The latter is a film-like
  /// characteristic with toe and shoulder, code = x^p (1 + s)/(x^p + s) with p = 1.4, s = 0.18^p. Throws
  /// Error{usage} for anything else.
  explicit PlantedResponse(const std::string& description);

  /// Code value in [0, 1] of a linear exposure, which is first clipped to [0, 1].
  [[nodiscard]] double code(double exposure) const;
  /// Linear exposure in [0, 1] of a code value: the inverse of `code`. Codes are first clipped to [0, 1].
  [[nodiscard]] double exposure(double code) const;

 private:
  double power_ = 1;
  double shoulder_ = 0;  // s; 0 for a pure power
};

/// Noise of code values, with full scale 1. A code z has independent Gaussian noise of variance `read`^2 +
/// `shot` z. Rounding to `bits` bits, steps of 1/(2^bits - 1), then adds a twelfth of a squared step.
struct CodeNoise {
  int bits = 0;     ///< Bits of the codes; 0 for no rounding.
  double read = 0;  ///< Standard deviation of dark codes.
  double shot = 0;  ///< Variance per unit of code.

  /// Standard deviation of a code whose noiseless value is `code`, rounding included. Negative codes count as
  /// 0.
  [[nodiscard]] double deviation(double code) const;
};

/// One channel's code values of every patch at every exposure time. Code 0 is black, code 1 clipped.
struct ExposureSeries {
  std::vector<double> times_s;             ///< Exposure times in any order.
  std::vector<std::vector<double>> codes;  ///< codes[patch][time], each in [0, 1].
  /// Standard deviations of the codes, deviations[patch][time]; empty if they are unknown.
  std::vector<std::vector<double>> deviations;
};

/// Simulates photographs of `values` (linear; 1 gives full scale in one second) with the exposure times
/// `times_s` through a response. Codes are clipped to [0, 1] after the noise. The result states the
/// deviations of the noise at the codes, unless the camera has neither noise nor rounding. The noise is a
/// function of `seed`.
[[nodiscard]] ExposureSeries expose(std::span<const double> values, std::span<const double> times_s,
                                    const PlantedResponse& response, const CodeNoise& noise,
                                    std::uint64_t seed = 1);

}  // namespace abbe
