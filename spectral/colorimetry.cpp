#include "spectral/colorimetry.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "spectral/library.h"

namespace abbe {

namespace {

ColorMatching load_color_matching(const std::string& table, const std::string& suffix) {
  const auto load = [&](const char* column) { return shipped_curve("observer", table + column + suffix); };
  return {load(":xbar"), load(":ybar"), load(":zbar")};
}

// Tolerance [nm] for a knot at a whole nanometre, and for two knots that form a jump.
constexpr double kRoundingNm = 1e-9;

// Largest jump of a curve inside the range of a sum, times the magnitude of `weight` there. The ends of a
// table are jumps.
double largest_jump(const Curve& curve, const Curve& weight, SumRange range) {
  double largest = 0;
  const std::span<const Knot> knots = curve.knots();
  for (std::size_t i = 1; i < knots.size(); ++i) {
    const double nm = knots[i].wavelength_nm;
    if (nm - knots[i - 1].wavelength_nm > kRoundingNm || nm < range.low_nm + kRoundingNm ||
        nm > range.high_nm - kRoundingNm)
      continue;
    const double largest_weight =
        std::max(std::abs(weight(nm - kRoundingNm)), std::abs(weight(nm + kRoundingNm)));
    largest = std::max(largest, std::abs(knots[i].value - knots[i - 1].value) * largest_weight);
  }
  return largest;
}

// True if the values of a curve at whole nanometres determine its weighted sum. Narrow lines can lie between
// or on the nanometres, so that a sum would miss them or count them several times. A sum takes only one side
// of a jump, such as the edge of a band, which is accurate enough for jumps below a thousandth.
bool is_resolved_at_1_nm(const Curve& curve, const Curve& weight, SumRange range) {
  constexpr double kSmall = 1e-3;
  if (!std::ranges::all_of(curve.knots(), [](const Knot& knot) {
        return std::abs(knot.wavelength_nm - std::round(knot.wavelength_nm)) < kRoundingNm;
      }))
    return false;
  const double jump = largest_jump(curve, weight, range);
  if (jump == 0) return true;
  for (int nm = range.low_nm; nm <= range.high_nm; ++nm)
    if (std::abs(curve(nm) * weight(nm)) >= jump / kSmall) return true;
  return false;
}

// Sum of the three colour-matching functions of an observer.
const Curve& summed_color_matching(Observer observer) {
  static const auto add = [](const ColorMatching& cmf) { return sum(cmf.x, sum(cmf.y, cmf.z)); };
  static const std::array<Curve, 2> both{add(color_matching(Observer::cie1931)),
                                         add(color_matching(Observer::cie1964))};
  return both[observer == Observer::cie1931 ? 0 : 1];
}

const Curve& equal_energy() {
  static const Curve even(1.0);
  return even;
}

// The first and last nanometre of a sum extend half a step outside its range.
constexpr double kHalfStepNm = 0.5;

// Integral over a width of the product of two lines, given by their values at both ends.
double integral_of_lines(double width_nm, double a0, double a1, double b0, double b1) {
  return width_nm / 6 * (a0 * (2 * b0 + b1) + a1 * (b0 + 2 * b1));
}

// Means of a curve under the triangles that span the nanometres before and after each whole one. Each linear
// segment within a nanometre lies under the falling side of one triangle and the rising side of the next.
std::vector<Knot> triangle_means(const Curve& curve) {
  std::vector<Knot> means;
  for (int nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; ++nm) means.push_back({static_cast<double>(nm), 0});
  CurveCursor piece(curve, kMinWavelengthNm);
  for (double from = kMinWavelengthNm; from < kMaxWavelengthNm;) {
    const double nm = std::floor(from);
    const double to = std::min(piece.end_nm(), nm + 1);
    const auto under = [&](double side_from, double side_to) {
      return integral_of_lines(to - from, piece(from), piece(to), side_from, side_to);
    };
    const auto at = static_cast<std::size_t>(nm) - kMinWavelengthNm;
    means[at].value += under(nm + 1 - from, nm + 1 - to);
    means[at + 1].value += under(from - nm, to - nm);
    piece.advance_to(to);
    from = to;
  }
  // Curves end at the peak of these two triangles, so only half of their area remains.
  means.front().value *= 2;
  means.back().value *= 2;
  return means;
}

// The curve itself if whole nanometres resolve it, otherwise its means around them.
Curve resampled_at_1_nm(const Curve& curve, const Curve& weight, SumRange range) {
  return is_resolved_at_1_nm(curve, weight, range) ? curve : Curve(triangle_means(curve));
}

// X = k integral(S R xbar) and Y and Z in the same way, with k = 100 / integral(S ybar) [CIE15, sec. 7.1].
XYZ integrated_tristimulus(const Curve& illuminant, const Curve& reflectance, const ColorMatching& cmf,
                           SumRange range) {
  const double low_nm = range.low_nm - kHalfStepNm;
  const double high_nm = range.high_nm + kHalfStepNm;
  const double k = 100 / integral_of_product(illuminant, cmf.y, low_nm, high_nm);
  const auto component = [&](const Curve& weight) {
    return k * integral_of_product(illuminant, reflectance, weight, low_nm, high_nm);
  };
  return {component(cmf.x), component(cmf.y), component(cmf.z)};
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
  return sum_product(a, b, equal_energy(), range);
}

double sum_product(const Curve& a, const Curve& b, const Curve& c, SumRange range) {
  if (!is_resolved_at_1_nm(a, b, range) || !is_resolved_at_1_nm(b, a, range))
    return integral_of_product(a, b, c, range.low_nm - kHalfStepNm, range.high_nm + kHalfStepNm);
  const Curve resampled = resampled_at_1_nm(c, equal_energy(), range);
  double total = 0;
  for (int nm = range.low_nm; nm <= range.high_nm; ++nm) total += a(nm) * b(nm) * resampled(nm);
  return total;
}

std::vector<XYZ> tristimulus_weights(const Curve& illuminant, Observer observer, SumRange range) {
  const ColorMatching& cmf = color_matching(observer);
  const Curve resampled = resampled_at_1_nm(illuminant, summed_color_matching(observer), range);
  const double k = 100 / sum_product(resampled, cmf.y, range);
  std::vector<XYZ> weights;
  for (int nm = range.low_nm; nm <= range.high_nm; ++nm) {
    const double power = k * resampled(nm);
    weights.push_back({power * cmf.x(nm), power * cmf.y(nm), power * cmf.z(nm)});
  }
  return weights;
}

XYZ tristimulus(const Curve& illuminant, const Curve& reflectance, Observer observer, SumRange range) {
  if (!is_resolved_at_1_nm(illuminant, summed_color_matching(observer), range))
    return integrated_tristimulus(illuminant, reflectance, color_matching(observer), range);
  const Curve resampled = resampled_at_1_nm(reflectance, equal_energy(), range);
  XYZ sum{};
  int nm = range.low_nm;
  for (const XYZ& weight : tristimulus_weights(illuminant, observer, range)) {
    const double reflected = resampled(nm++);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight[k] * reflected;
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

Curve in_bands(const Curve& light, std::span<const double> edges_nm) {
  std::vector<Knot> knots{{edges_nm.front(), 0}};
  for (std::size_t i = 0; i + 1 < edges_nm.size(); ++i) {
    const double from = edges_nm[i];
    const double to = edges_nm[i + 1];
    const double mean = light.integral(from, to) / (to - from);
    knots.push_back({from, mean});
    knots.push_back({to, mean});
  }
  knots.push_back({edges_nm.back(), 0});
  return Curve(std::move(knots));
}

Chromaticity chromaticity(const Curve& light, const FilmObserver& film_observer) {
  const Chromaticity own = chromaticity(light, film_observer.observer);
  if (film_observer.band_edges_nm.empty()) return own;
  // The observer tables end at 830 nm. In near infrared they give the colour of deep red at a millionth of
  // its luminance, which is unusable for display.
  const Curve banded = in_bands(light, film_observer.band_edges_nm);
  const bool is_visible = banded.integral(kVisibleRange.low_nm, kVisibleRange.high_nm) > 0;
  return is_visible ? chromaticity(banded, film_observer.observer) : own;
}

}  // namespace abbe
