#include "spectral/colorimetry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "io/error.h"
#include "spectral/library.h"
#include "spectral/straight_piece.h"

namespace abbe {
namespace {

ColorMatching load_color_matching(const std::string& table, const std::string& suffix) {
  const auto load = [&table](const std::string& column) {
    Diagnostics diagnostics;
    auto curve = load_curve("observer", table + ":" + column, {}, diagnostics);
    if (!curve) throw Error(ErrorCode::input, table, diagnostics.text());
    return std::move(curve->curve);
  };
  return {load("xbar" + suffix), load("ybar" + suffix), load("zbar" + suffix)};
}

// How far a bend at a nanometre may be from it, and both ends of a jump from each other.
constexpr double kRoundingNm = 1e-9;

// The largest jump of a curve between the ends of a sum, as it counts by another; ends of tables are jumps.
double largest_jump(const Curve& curve, const Curve& by, SumRange range) {
  double largest = 0;
  const std::span<const Knot> knots = curve.knots();
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const double nm = knots[i].wavelength_nm;
    if (nm - knots[i - 1].wavelength_nm > kRoundingNm || nm < range.low_nm + kRoundingNm ||
        nm > range.high_nm - kRoundingNm)
      continue;
    const double seen = std::max(std::abs(by(nm - kRoundingNm)), std::abs(by(nm + kRoundingNm)));
    largest = std::max(largest, std::abs(knots[i].value - knots[i - 1].value) * seen);
  }
  return largest;
}

// Whether its values at the whole nanometres of a sum tell a curve, as it counts by another: narrow lines lie
// between them, or on one, and a sum would miss them or count them several times; of a jump, as of a band, it
// would take one side alone, which is enough of jumps of a thousandth.
bool is_told_by_nanometres(const Curve& curve, const Curve& by, SumRange range) {
  constexpr double kSmall = 1e-3;
  if (!std::ranges::all_of(curve.knots(), [](const Knot& knot) {
        return std::abs(knot.wavelength_nm - std::round(knot.wavelength_nm)) < kRoundingNm;
      }))
    return false;
  const double jump = largest_jump(curve, by, range);
  if (jump == 0) return true;
  for (int nm = range.low_nm; nm <= range.high_nm; ++nm)
    if (std::abs(curve(nm) * by(nm)) >= jump / kSmall) return true;
  return false;
}

bool are_told_by_nanometres(const Curve& a, const Curve& b, SumRange range) {
  return is_told_by_nanometres(a, b, range) && is_told_by_nanometres(b, a, range);
}

// What the three functions of an observer see of a light together.
const Curve& whole_of(Observer observer) {
  static const auto add = [](const ColorMatching& cmf) { return sum(cmf.x, sum(cmf.y, cmf.z)); };
  static const std::array<Curve, 2> both{add(color_matching(Observer::cie1931)),
                                         add(color_matching(Observer::cie1964))};
  return both[observer == Observer::cie1931 ? 0 : 1];
}

const Curve& even_light() {
  static const Curve even(1.0);
  return even;
}

// Half of its first and last nanometre lies beyond the ends of a sum.
constexpr double kBeyondNm = 0.5;

// The integral of the product of two lines over a width, by what each is at both ends.
double integral_of_lines(double width_nm, double a0, double a1, double b0, double b1) {
  return width_nm / 6 * (a0 * (2 * b0 + b1) + a1 * (b0 + 2 * b1));
}

// The means of a curve under the triangles from the nanometre before to the one after: each straight piece
// within a nanometre lies under the falling side of one triangle and the rising side of the next.
std::vector<Knot> means_by_nanometres(const Curve& curve) {
  std::vector<Knot> means;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) means.push_back({static_cast<double>(nm), 0});
  StraightPiece piece(curve, kMinWavelengthNm);
  for (double from = kMinWavelengthNm; from < kMaxWavelengthNm;) {
    const double nm = std::floor(from);
    const double to = std::min(piece.end_nm(), nm + 1);
    const auto under = [&](double side_from, double side_to) {
      return integral_of_lines(to - from, piece(from), piece(to), side_from, side_to);
    };
    const auto at = static_cast<std::size_t>(nm) - kMinWavelengthNm;
    means[at].value += under(nm + 1 - from, nm + 1 - to);
    means[at + 1].value += under(from - nm, to - nm);
    piece.go_to(to);
    from = to;
  }
  // Curves end in the middle of these two triangles, so that half of their area is left.
  means.front().value *= 2;
  means.back().value *= 2;
  return means;
}

// A curve as its values at whole nanometres tell it, as it counts by another, or its means around them.
Curve by_nanometres(const Curve& curve, const Curve& by, SumRange range) {
  return is_told_by_nanometres(curve, by, range) ? curve : Curve(means_by_nanometres(curve));
}

// X = k times the integral of S R xbar, and so on, k being 100 over that of S ybar [CIE15, sec. 7.1].
XYZ integrated_tristimulus(const Curve& illuminant, const Curve& reflectance, const ColorMatching& cmf,
                           SumRange range) {
  const double low_nm = range.low_nm - kBeyondNm;
  const double high_nm = range.high_nm + kBeyondNm;
  const double k = 100 / integral_of_product(illuminant, cmf.y, low_nm, high_nm);
  const auto seen = [&](const Curve& by) {
    return k * integral_of_product(illuminant, reflectance, by, low_nm, high_nm);
  };
  return {seen(cmf.x), seen(cmf.y), seen(cmf.z)};
}

}  // namespace

const ColorMatching& color_matching(Observer observer) {
  if (observer == Observer::cie1931) {
    static const ColorMatching cie1931 = load_color_matching("cie_1931_2deg", "");
    return cie1931;
  }
  static const ColorMatching cie1964 = load_color_matching("cie_1964_10deg", "10");
  return cie1964;
}

double sum_product(const Curve& a, const Curve& b, SumRange range) {
  if (!are_told_by_nanometres(a, b, range))
    return integral_of_product(a, b, range.low_nm - kBeyondNm, range.high_nm + kBeyondNm);
  double total = 0;
  for (int nm = range.low_nm; nm <= range.high_nm; ++nm) total += a(nm) * b(nm);
  return total;
}

double sum_product(const Curve& a, const Curve& b, const Curve& c, SumRange range) {
  if (!are_told_by_nanometres(a, b, range))
    return integral_of_product(a, b, c, range.low_nm - kBeyondNm, range.high_nm + kBeyondNm);
  const Curve told = by_nanometres(c, even_light(), range);
  double total = 0;
  for (int nm = range.low_nm; nm <= range.high_nm; ++nm) total += a(nm) * b(nm) * told(nm);
  return total;
}

std::vector<XYZ> tristimulus_weights(const Curve& illuminant, Observer observer, SumRange range) {
  const ColorMatching& cmf = color_matching(observer);
  const Curve told = by_nanometres(illuminant, whole_of(observer), range);
  const double k = 100 / sum_product(told, cmf.y, range);
  std::vector<XYZ> weights;
  for (int nm = range.low_nm; nm <= range.high_nm; ++nm) {
    const double power = k * told(nm);
    weights.push_back({power * cmf.x(nm), power * cmf.y(nm), power * cmf.z(nm)});
  }
  return weights;
}

XYZ tristimulus(const Curve& illuminant, const Curve& reflectance, Observer observer, SumRange range) {
  if (!is_told_by_nanometres(illuminant, whole_of(observer), range))
    return integrated_tristimulus(illuminant, reflectance, color_matching(observer), range);
  const Curve told = by_nanometres(reflectance, even_light(), range);
  XYZ sum{};
  int nm = range.low_nm;
  for (const XYZ& weight : tristimulus_weights(illuminant, observer, range)) {
    const double share = told(nm++);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight[k] * share;
  }
  return sum;
}

Chromaticity chromaticity(const XYZ& xyz) {
  const double total = xyz[0] + xyz[1] + xyz[2];
  if (total == 0) return {0, 0};
  return {xyz[0] / total, xyz[1] / total};
}

Chromaticity chromaticity(const Curve& light, Observer observer) {
  return chromaticity(tristimulus(light, Curve(1.0), observer));
}

XYZ lab_to_xyz(const Lab& lab, const XYZ& white) {
  const auto inverse = [](double f) {
    constexpr double kDelta = 6.0 / 29.0;
    return f > kDelta ? f * f * f : 3 * kDelta * kDelta * (f - 4.0 / 29.0);
  };
  const double fy = (lab[0] + 16) / 116;
  return {white[0] * inverse(fy + lab[1] / 500), white[1] * inverse(fy),
          white[2] * inverse(fy - lab[2] / 200)};
}

double photometric(const Curve& spectral) {
  return kLuminousEfficacy * integral_of_product(color_matching(Observer::cie1931).y, spectral);
}

}  // namespace abbe
