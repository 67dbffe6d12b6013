#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace abbe {

/// How a table is read between its samples: by straight lines, by `sprague`, by `cubic`.
enum class Interpolation { linear, sprague, cubic };

/// A function known at some wavelengths.
struct Samples {
  std::vector<double> wavelengths_nm;  ///< Strictly ascending.
  std::vector<double> values;          ///< One for each wavelength.
};

/// The weights w_i with which the values at `nodes` give that at x of the polynomial through them,
/// w_i = prod_{j != i} (x - x_j)/(x_i - x_j) [Abramowitz1964, eq. 25.2.2]. The nodes differ from each other.
[[nodiscard]] std::vector<double> lagrange_weights(std::span<const double> nodes, double x);

/// Lagrange's interpolation by the cubic through the four samples around a wavelength, the nearest four in
/// the first and last interval: exact for polynomials of degree 3, on any wavelengths [Abramowitz1964,
/// sec. 25.2]. Needs four samples or more, and a wavelength within theirs.
[[nodiscard]] double cubic(const Samples& samples, double wavelength_nm);

/// Sprague's interpolation of six evenly spaced values or more, `position` counting steps from the first: in
/// each interval the polynomial of degree 5 that at both ends has the value, slope and curvature of the
/// quartic through the five values around, hence smooth to the second derivative and exact for polynomials of
/// degree 4. Two values are added beyond each end [CIE167, sec. 9.2.4, table V]; these are exact
/// for straight lines alone, so the two intervals at each end are too.
[[nodiscard]] double sprague(std::span<const double> values, double position);

/// A sample that a rule of interpolation cannot take, and why.
struct SampleFault {
  std::size_t row;
  std::string text;
};

/// The first sample that is not as far from the one before as that is from its own predecessor, to 1e-6 of a
/// step.
[[nodiscard]] std::optional<SampleFault> step_fault(std::span<const double> wavelengths_nm);

/// Why wavelengths cannot be interpolated that way: too few of them, or steps that are not even.
[[nodiscard]] std::optional<SampleFault> interpolation_fault(std::span<const double> wavelengths_nm,
                                                             Interpolation rule);

/// The function through the samples, sampled so finely that straight lines represent it: at the samples and
/// at each whole nanometre of [300, 1100] between them. What overshoots [low, high] is cut there. Linear
/// samples are left as they are.
[[nodiscard]] Samples every_nanometre(Samples samples, Interpolation rule, double low, double high);

}  // namespace abbe
