#include "spectral/rgb.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/LU>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

#include "io/error.h"
#include "io/exr.h"
#include "io/picture_codec.h"
#include "io/text.h"
#include "spectral/library.h"

namespace abbe {
namespace {

constexpr SumRange kSums;
constexpr SumRange kVaries = kVisibleRange;  // constant outside
constexpr std::size_t kCount = static_cast<std::size_t>(kSums.high_nm - kSums.low_nm) + 1;
constexpr Eigen::Index kUnknowns = 6;

// Rec.709 components of each unit of power per nanometre that the perfect diffuser reflects under D65.
std::array<LinearRgb, kCount> make_weights() {
  const Curve d65 = shipped_curve("illuminant", "D65");
  const ColorMatching& match = color_matching(Observer::cie1931);
  Eigen::Matrix3d primaries;  // one column each
  Eigen::Index c = 0;
  for (const auto& [x, y] : {kRec709.red, kRec709.green, kRec709.blue}) primaries.col(c++) << x, y, 1 - x - y;
  const Eigen::PartialPivLU<Eigen::Matrix3d> lu(primaries);
  std::array<LinearRgb, kCount> weights{};
  LinearRgb white{};
  for (std::size_t i = 0; i < kCount; ++i) {
    const double nm = kSums.low_nm + static_cast<double>(i);
    const double power = d65(nm);
    const Eigen::Vector3d at = lu.solve(power * Eigen::Vector3d(match.x(nm), match.y(nm), match.z(nm)));
    weights[i] = {at[0], at[1], at[2]};
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

// Red, green and blue basis at a wavelength: exp(p), 1 and exp(q) over their sum, with p and q quadratic in
// wavelength.
LinearRgb basis_at(const Eigen::VectorXd& u, int nm) {
  const double x = 2.0 * (std::clamp(nm, kVaries.low_nm, kVaries.high_nm) - kVaries.low_nm) /
                       (kVaries.high_nm - kVaries.low_nm) -
                   1;
  const double p = u[0] + x * (u[1] + x * u[2]);
  const double q = u[3] + x * (u[4] + x * u[5]);
  const double largest = std::max({p, q, 0.0});
  const LinearRgb e{std::exp(p - largest), std::exp(-largest), std::exp(q - largest)};
  const double total = e[0] + e[1] + e[2];
  return {e[0] / total, e[1] / total, e[2] / total};
}

// Residuals of the coefficients u: the colours of the red and blue basis minus their targets. Green needs no
// condition, since all three add up to white.
struct Conditions {
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  static constexpr int InputsAtCompileTime = Eigen::Dynamic;
  static constexpr int ValuesAtCompileTime = Eigen::Dynamic;

  [[nodiscard]] static Eigen::Index inputs() { return kUnknowns; }
  [[nodiscard]] static Eigen::Index values() { return kUnknowns; }
  int operator()(const Eigen::VectorXd& u, Eigen::VectorXd& r) const {
    r << -1, 0, 0, 0, 0, -1;
    for (std::size_t i = 0; i < kCount; ++i) {
      const LinearRgb basis = basis_at(u, kSums.low_nm + static_cast<int>(i));
      const Eigen::Map<const Eigen::Vector3d> weight(weights()[i].data());
      r.head<3>() += weight * basis[0];
      r.tail<3>() += weight * basis[2];
    }
    return 0;
  }
};

Eigen::VectorXd fit() {
  constexpr double kDone = 1e-12;
  Eigen::VectorXd u(kUnknowns);
  u << -1, 8, 4, -1, -8, 4;
  const Eigen::NumericalDiff<Conditions, Eigen::Central> conditions;
  Eigen::LevenbergMarquardt search(conditions);
  search.parameters.ftol = search.parameters.xtol = std::numeric_limits<double>::epsilon();
  search.minimize(u);
  if (!(search.fnorm <= kDone)) throw Error(ErrorCode::internal, "RGB basis", "the fit does not converge");
  return u;
}

RgbBasis make_basis() {
  const Eigen::VectorXd u = fit();
  std::array<std::vector<Knot>, 3> knots;
  for (int nm = kVaries.low_nm; nm <= kVaries.high_nm; ++nm) {
    const LinearRgb at = basis_at(u, nm);
    for (std::size_t c = 0; c < 3; ++c) knots[c].push_back({static_cast<double>(nm), at[c]});
  }
  return {Curve(std::move(knots[0])), Curve(std::move(knots[1])), Curve(std::move(knots[2]))};
}

// Primaries of Rec.709 in ICC profiles of sRGB, adapted by Bradford's transform to D50, the white of all
// profiles [ICC].
constexpr RgbSpace kRec709InProfiles{{0.6484, 0.3309}, {0.3212, 0.5979}, {0.1559, 0.0660}, {0.3457, 0.3585}};

// True if an image records the primaries of `space` to two digits, or records none.
bool records_primaries_of(const RgbSpace& space, const Image& image) {
  constexpr double kRounding = 5e-3;
  const auto near = [](const Chromaticity& a, const Chromaticity& b) {
    return std::abs(a[0] - b[0]) < kRounding && std::abs(a[1] - b[1]) < kRounding;
  };
  if (!image.metadata.contains(kPrimariesKey)) return true;
  const auto recorded = recorded_primaries(image);
  return recorded && near(recorded->red, space.red) && near(recorded->green, space.green) &&
         near(recorded->blue, space.blue) && near(recorded->white, space.white);
}

}  // namespace

XYZ unit_xyz(const Chromaticity& xy) {
  return {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]};
}

std::optional<RgbSpace> recorded_primaries(const Image& image) {
  const auto recorded = image.metadata.find(kPrimariesKey);
  if (recorded == image.metadata.end()) return std::nullopt;
  std::array<Chromaticity, 4> xy{};
  const std::vector<std::string> words = split(recorded->second, ' ');
  if (words.size() != 2 * xy.size()) return std::nullopt;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto number = parse_number(words[i]);
    if (!number) return std::nullopt;
    xy.at(i / 2).at(i % 2) = *number;
  }
  return RgbSpace{xy[0], xy[1], xy[2], xy[3]};
}

std::string primaries_text(const RgbSpace& space) {
  const auto& [red, green, blue, white] = space;
  return fmt::format("{} {} {} {}", fmt::join(red, " "), fmt::join(green, " "), fmt::join(blue, " "),
                     fmt::join(white, " "));
}

std::optional<std::string> rec709_fault(const Image& image) {
  const auto profile = image.metadata.find(kProfileKey);
  const bool is_profiled = profile != image.metadata.end();
  const bool is_encoded = recorded_encoding(image).has_value();
  if (is_encoded && records_primaries_of(is_profiled ? kRec709InProfiles : kRec709, image))
    return std::nullopt;
  if (is_profiled)
    return "its colours are those of the profile \"" + profile->second + "\" (" +
           (is_encoded ? "" : "got " + image.metadata.at(kColorSpace) + ", ") +
           "allowed the primaries of sRGB, with floats that are linear or codes that are linear, encoded as "
           "sRGB or by a gamma)";
  if (!is_encoded)
    return "its colour space is unknown (got \"" + image.metadata.at(kColorSpace) +
           "\", allowed linear, sRGB or a gamma)";
  return "its chromaticities are not those of Rec.709 (got " + image.metadata.at(kPrimariesKey) + ")";
}

Matrix3 rgb_to_xyz(const RgbSpace& space) {
  // The columns are proportional to the primaries, scaled so that they add up to the white.
  const auto z = [](const Chromaticity& c) { return 1 - c[0] - c[1]; };
  const auto& [r, g, b, white] = space;
  const Matrix3 primaries(r[0], g[0], b[0], r[1], g[1], b[1], z(r), z(g), z(b));
  return primaries * diagonal(multiply(primaries.inverse(true), unit_xyz(white)));
}

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

double Encoding::decoded(double value) const {
  if (gamma == 1.0) return value;
  return gamma ? std::pow(value, *gamma) : srgb_decoded(value);
}

std::optional<Encoding> recorded_encoding(const Image& image) {
  const auto recorded = image.metadata.find(kColorSpace);
  if (recorded == image.metadata.end() || recorded->second == "sRGB") return Encoding{};
  if (recorded->second == kLinear) return kLinearEncoding;
  if (!recorded->second.starts_with(kGamma)) return std::nullopt;
  const auto gamma = parse_number(recorded->second.substr(std::string_view(kGamma).size()));
  if (!gamma || !(*gamma > 0)) return std::nullopt;
  return Encoding{gamma};
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
  for (Knot& knot : knots) knot.value = std::clamp(knot.value, *low, *high);  // removes rounding errors
  return Curve(std::move(knots));
}

}  // namespace abbe
