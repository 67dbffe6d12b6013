#include "spectral/interpolation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "spectral/curve.h"

namespace abbe {
namespace {

constexpr std::size_t kCubicNodes = 4;
constexpr std::size_t kSpragueNodes = 6;

/// Value k of the sequence that `sprague` interpolates. Values -2, -1, n and n + 1 extrapolate it past the
/// ends.
double extended(std::span<const double> values, std::ptrdiff_t k) {
  constexpr double kDivisor = 209;
  constexpr std::array<std::array<double, kSpragueNodes>, 2> kExtrapolation{
      {{508, -540, 488, -367, 144, -24}, {884, -1960, 3033, -2648, 1080, -180}}};
  const std::ptrdiff_t last = std::ssize(values) - 1;
  if (k >= 0 && k <= last) return values[static_cast<std::size_t>(k)];
  const auto& weights = kExtrapolation.at(static_cast<std::size_t>(k < 0 ? -k - 1 : k - last - 1));
  double value = 0;
  for (std::size_t i = 0; i < kSpragueNodes; ++i)
    value += weights[i] * (k < 0 ? values[i] : values[values.size() - 1 - i]);
  return value / kDivisor;
}

/// Value, slope and curvature at the central one of five evenly spaced values, of the quartic through them
/// [Abramowitz1964, table 25.2].
struct Osculation {
  double value;
  double slope;
  double curvature;
};
Osculation osculation(std::span<const double> values, std::ptrdiff_t k) {
  const auto p = [&](std::ptrdiff_t offset) { return extended(values, k + offset); };
  return {p(0), (p(-2) - 8 * p(-1) + 8 * p(1) - p(2)) / 12,
          (-p(-2) + 16 * p(-1) - 30 * p(0) + 16 * p(1) - p(2)) / 12};
}

}  // namespace

std::vector<double> lagrange_weights(std::span<const double> nodes, double x) {
  std::vector<double> weights(nodes.size(), 1);
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (j != i) weights[i] *= (x - nodes[j]) / (nodes[i] - nodes[j]);
  return weights;
}

double cubic(const Samples& samples, double wavelength_nm) {
  const std::vector<double>& nm = samples.wavelengths_nm;
  const auto after = std::upper_bound(nm.begin(), nm.end(), wavelength_nm) - nm.begin();
  const auto first = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(after - 2, 0, std::ssize(nm) - std::ptrdiff_t{kCubicNodes}));
  const std::vector<double> weights =
      lagrange_weights(std::span(nm).subspan(first, kCubicNodes), wavelength_nm);
  double value = 0;
  for (std::size_t i = 0; i < kCubicNodes; ++i) value += weights[i] * samples.values[first + i];
  return value;
}

double sprague(std::span<const double> values, double position) {
  const auto k = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::floor(position)), 0,
                                            std::ssize(values) - 2);
  const double t = position - static_cast<double>(k);
  const Osculation a = osculation(values, k);
  const Osculation b = osculation(values, k + 1);
  // p(t) = y0 + y0' t + y0''/2 t^2 + c3 t^3 + c4 t^4 + c5 t^5, where c3 to c5 correct value, slope and
  // curvature of the quadratic at t = 1.
  const double value = b.value - (a.value + a.slope + a.curvature / 2);
  const double slope = b.slope - (a.slope + a.curvature);
  const double curvature = b.curvature - a.curvature;
  const double c3 = 10 * value - 4 * slope + curvature / 2;
  const double c4 = -15 * value + 7 * slope - curvature;
  const double c5 = 6 * value - 3 * slope + curvature / 2;
  return a.value + t * (a.slope + t * (a.curvature / 2 + t * (c3 + t * (c4 + t * c5))));
}

std::optional<SampleFault> step_fault(std::span<const double> wavelengths_nm) {
  constexpr double kTolerance = 1e-6;
  for (std::size_t i = 2; i < wavelengths_nm.size(); ++i) {
    const double before = wavelengths_nm[i - 1] - wavelengths_nm[i - 2];
    const double step = wavelengths_nm[i] - wavelengths_nm[i - 1];
    if (std::abs(step - before) > kTolerance * before)
      return SampleFault{i, fmt::format("a step of {:g} nm after one of {:g} nm", step, before)};
  }
  return std::nullopt;
}

std::optional<SampleFault> interpolation_fault(std::span<const double> wavelengths_nm, Interpolation rule) {
  if (rule == Interpolation::linear) return std::nullopt;
  const std::size_t needed = rule == Interpolation::sprague ? kSpragueNodes : kCubicNodes;
  if (wavelengths_nm.size() < needed)
    return SampleFault{wavelengths_nm.size() - 1,
                       fmt::format("{} samples (allowed {} or more)", wavelengths_nm.size(), needed)};
  return rule == Interpolation::sprague ? step_fault(wavelengths_nm) : std::nullopt;
}

Samples every_nanometre(Samples samples, Interpolation rule, double low, double high) {
  if (rule == Interpolation::linear) return samples;
  const std::vector<double>& nm = samples.wavelengths_nm;
  const auto steps = static_cast<double>(nm.size() - 1);
  const auto at = [&](double wavelength_nm) {
    const double value =
        rule == Interpolation::sprague
            ? sprague(samples.values, (wavelength_nm - nm.front()) * steps / (nm.back() - nm.front()))
            : cubic(samples, wavelength_nm);
    return std::clamp(value, low, high);
  };
  Samples fine;
  for (std::size_t i = 0; i < nm.size(); ++i) {
    fine.wavelengths_nm.push_back(nm[i]);
    fine.values.push_back(samples.values[i]);
    const double end = i + 1 < nm.size() ? std::min<double>(nm[i + 1], kMaxWavelengthNm + 1) : nm[i];
    for (double whole = std::max<double>(std::floor(nm[i]) + 1, kMinWavelengthNm); whole < end; ++whole) {
      fine.wavelengths_nm.push_back(whole);
      fine.values.push_back(at(whole));
    }
  }
  return fine;
}

}  // namespace abbe
