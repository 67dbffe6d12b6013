#include "spectral/rgb.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "io/error.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"

namespace abbe {
namespace {

constexpr SumRange kSums;
constexpr std::size_t kCount = static_cast<std::size_t>(kSums.high_nm - kSums.low_nm) + 1;
constexpr std::size_t kUnknowns = 6;

using Vector = std::array<double, kUnknowns>;

// Solves a x = b in place by elimination with pivots; both arguments are used up.
template <std::size_t N>
std::array<double, N> solve(std::array<std::array<double, N>, N> a, std::array<double, N> b) {
  for (std::size_t i = 0; i < N; ++i) {
    std::size_t pivot = i;
    for (std::size_t row = i + 1; row < N; ++row)
      if (std::abs(a[row][i]) > std::abs(a[pivot][i])) pivot = row;
    for (std::size_t column = 0; column < N; ++column) std::swap(a[i][column], a[pivot][column]);
    std::swap(b[i], b[pivot]);
    for (std::size_t row = 0; row < N; ++row) {
      if (row == i) continue;
      const double factor = a[row][i] / a[i][i];
      for (std::size_t column = i; column < N; ++column) a[row][column] -= factor * a[i][column];
      b[row] -= factor * b[i];
    }
  }
  for (std::size_t i = 0; i < N; ++i) b[i] /= a[i][i];
  return b;
}

// The share of each primary in a unit of power per nanometre, reflected by the perfect diffuser under D65.
std::array<LinearRgb, kCount> make_weights() {
  Diagnostics diagnostics;
  const auto d65 = load_illuminant("D65", {}, diagnostics);
  if (!d65) throw Error(ErrorCode::input, "illuminant D65", diagnostics.text());
  const ColorMatching& match = color_matching(Observer::cie1931);
  std::array<std::array<double, 3>, 3> primaries{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& [x, y] = kRec709Primaries.at(c);
    primaries[0][c] = x;
    primaries[1][c] = y;
    primaries[2][c] = 1 - x - y;
  }
  std::array<LinearRgb, kCount> weights{};
  LinearRgb white{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const double nm = kSums.low_nm + static_cast<double>(i);
    const double power = d65->curve(nm);
    weights[i] = solve<3>(primaries, {power * match.x(nm), power * match.y(nm), power * match.z(nm)});
    for (std::size_t c = 0; c < 3; ++c) white[c] += weights[i][c];
  }
  for (LinearRgb& at : weights)
    for (std::size_t c = 0; c < 3; ++c) at[c] /= white[c];
  return weights;
}

const std::array<LinearRgb, kCount>& weights() {
  static const std::array<LinearRgb, kCount> kWeights = make_weights();
  return kWeights;
}

// Red, green and blue at the i-th nanometre: exp(p), 1 and exp(q) over their sum, p and q quadratics in
// wavelength.
LinearRgb basis_at(const Vector& u, std::size_t i) {
  const double x = 2 * static_cast<double>(i) / (kCount - 1) - 1;
  const double p = u[0] + x * (u[1] + x * u[2]);
  const double q = u[3] + x * (u[4] + x * u[5]);
  const double most = std::max({p, q, 0.0});
  const LinearRgb e{std::exp(p - most), std::exp(-most), std::exp(q - most)};
  const double total = e[0] + e[1] + e[2];
  return {e[0] / total, e[1] / total, e[2] / total};
}

// The colours of red and blue less what they should be; green follows, since all three add up to white.
Vector residual(const Vector& u) {
  Vector r{-1, 0, 0, 0, 0, -1};
  for (std::size_t i = 0; i < kCount; ++i) {
    const LinearRgb basis = basis_at(u, i);
    for (std::size_t c = 0; c < 3; ++c) {
      r[c] += weights()[i][c] * basis[0];
      r[3 + c] += weights()[i][c] * basis[2];
    }
  }
  return r;
}

double squared(const Vector& r) {
  double sum = 0;
  for (const double x : r) sum += x * x;
  return sum;
}

// One step of Gauss and Newton from u, damped after Levenberg and Marquardt.
Vector step(const Vector& u, const Vector& r, double damping) {
  constexpr double kDifference = 1e-5;
  std::array<Vector, kUnknowns> slope{};  // by unknown
  for (std::size_t j = 0; j < kUnknowns; ++j) {
    Vector above = u;
    Vector below = u;
    above[j] += kDifference;
    below[j] -= kDifference;
    const Vector a = residual(above);
    const Vector b = residual(below);
    for (std::size_t i = 0; i < kUnknowns; ++i) slope[j][i] = (a[i] - b[i]) / (2 * kDifference);
  }
  std::array<Vector, kUnknowns> normal{};
  Vector right{};
  for (std::size_t j = 0; j < kUnknowns; ++j)
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      for (std::size_t k = 0; k < kUnknowns; ++k) normal[j][k] += slope[j][i] * slope[k][i];
      right[j] -= slope[j][i] * r[i];
    }
  for (std::size_t j = 0; j < kUnknowns; ++j) normal[j][j] *= 1 + damping;
  Vector moved = solve(normal, right);
  for (std::size_t j = 0; j < kUnknowns; ++j) moved[j] += u[j];
  return moved;
}

Vector fit() {
  constexpr double kDone = 1e-24;
  constexpr int kSteps = 200;  // 30 are needed
  Vector u{-1, 8, 4, -1, -8, 4};
  Vector r = residual(u);
  double damping = 1e-2;
  for (int i = 0; i < kSteps && squared(r) > kDone; ++i) {
    const Vector next = step(u, r, damping);
    const Vector left = residual(next);
    const bool better = squared(left) < squared(r);
    damping *= better ? 0.3 : 4;
    if (!better) continue;
    u = next;
    r = left;
  }
  if (squared(r) > kDone) throw Error(ErrorCode::internal, "RGB basis", "the fit does not converge");
  return u;
}

RgbBasis make_basis() {
  const Vector u = fit();
  std::array<std::vector<Knot>, 3> knots;
  for (std::size_t i = 0; i < kCount; ++i) {
    const LinearRgb at = basis_at(u, i);
    for (std::size_t c = 0; c < 3; ++c) knots[c].push_back({kSums.low_nm + static_cast<double>(i), at[c]});
  }
  return {Curve(std::move(knots[0])), Curve(std::move(knots[1])), Curve(std::move(knots[2]))};
}

}  // namespace

LinearRgb linear_rgb(const Curve& reflectance) {
  LinearRgb rgb{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const double value = reflectance(kSums.low_nm + static_cast<double>(i));
    for (std::size_t c = 0; c < 3; ++c) rgb[c] += weights()[i][c] * value;
  }
  return rgb;
}

double srgb_decoded(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

const RgbBasis& rgb_basis() {
  static const RgbBasis kBasis = make_basis();
  return kBasis;
}

Curve rgb_spectrum(const LinearRgb& rgb) {
  if (rgb[0] == rgb[1] && rgb[1] == rgb[2]) return Curve(rgb[0]);
  const auto [low, high] = std::minmax_element(rgb.begin(), rgb.end());
  const RgbBasis& basis = rgb_basis();
  const Curve mixture =
      sum(sum(scaled(basis.red, rgb[0]), scaled(basis.green, rgb[1])), scaled(basis.blue, rgb[2]));
  std::vector<Knot> knots(mixture.knots().begin(), mixture.knots().end());
  for (Knot& knot : knots) knot.value = std::clamp(knot.value, *low, *high);  // rounding
  return Curve(std::move(knots));
}

}  // namespace abbe
