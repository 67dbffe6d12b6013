#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace abbe {

/// Interpolation between the samples of a table: piecewise linear, or by the functions `sprague` or `cubic`.
enum class Interpolation { linear, sprague, cubic };

/// A function known at some wavelengths.
struct Samples {
  std::vector<double> wavelengths_nm;  ///< Strictly ascending.
  std::vector<double> values;          ///< One for each wavelength.
};

/// Weights w_i of the values at `nodes` for the value of their interpolating polynomial at x: w_i = prod_{j
/// != i} (x - x_j)/(x_i - x_j) [Abramowitz1964, eq. 25.2.2]. The nodes must be distinct.
[[nodiscard]] std::vector<double> lagrange_weights(std::span<const double> nodes, double x);

/// Lagrange interpolation by the cubic through the four samples around a wavelength [Abramowitz1964, sec.
/// 25.2]. The first and last interval use the nearest four. Exact for polynomials of degree 3 on any
/// wavelengths. Requires at least four samples, and a wavelength within their range.
[[nodiscard]] double cubic(const Samples& samples, double wavelength_nm);

/// Sprague interpolation of at least six evenly spaced values [CIE167, sec. 9.2.4, table V]. `position`
/// counts steps from the first value. In each interval, a polynomial of degree 5 matches the value, slope and
/// curvature at both ends of the quartic through the five values around. The result is smooth to the second
/// derivative and exact for polynomials of degree 4. Two values are extrapolated past each end. They are
/// exact only for straight lines, and so are the two intervals at each end. The caller ensures that
/// `position` lies within [0, values.size() - 1].
[[nodiscard]] double sprague(std::span<const double> values, double position);

/// A sample that an interpolation rule does not accept, and the reason.
struct SampleFault {
  std::size_t row;   ///< Index of the sample, from 0.
  std::string text;  ///< Reason, for the end of an error message.
};

/// The first sample whose step differs from the step before it by more than 1e-6 of a step, or nothing.
[[nodiscard]] std::optional<SampleFault> step_fault(std::span<const double> wavelengths_nm);

/// Explains why a rule cannot interpolate at these wavelengths; nothing if it can.
[[nodiscard]] std::optional<SampleFault> interpolation_fault(std::span<const double> wavelengths_nm,
                                                             Interpolation rule);

/// Function through the samples by `rule`, resampled for linear interpolation: at the samples and at every
/// whole nanometre of [300, 1100] between them. Interpolated values are clamped to [low, high], samples are
/// not. The caller ensures that `interpolation_fault` finds nothing.
[[nodiscard]] Samples every_nanometre(Samples samples, Interpolation rule, double low, double high);

}  // namespace abbe
