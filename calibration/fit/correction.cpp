#include "calibration/fit/correction.h"

#include <algorithm>

namespace abbe {

std::vector<double> correction_terms(CorrectionModel model, const Raw& raw) {
  std::vector<double> terms(raw.begin(), raw.end());
  const auto [r, g, b] = raw;
  const auto add = [&terms](double product, auto root) { terms.push_back(product > 0 ? root(product) : 0); };
  if (model != CorrectionModel::linear)
    for (const double product : {r * g, g * b, r * b}) add(product, [](double x) { return std::sqrt(x); });
  if (model == CorrectionModel::root_polynomial_3)
    for (const double product : {r * g * g, g * b * b, r * b * b, g * r * r, b * g * g, b * r * r, r * g * b})
      add(product, [](double x) { return std::cbrt(x); });
  return terms;
}

XYZ ColorCorrection::operator()(const Raw& raw) const {
  const std::vector<double> terms = correction_terms(model, raw);
  XYZ xyz{};
  for (std::size_t t = 0; t < terms.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) xyz[i] += columns[t][i] * terms[t];
  return xyz;
}

ColorCorrection linear_correction(const Matrix3& m) {
  ColorCorrection correction;
  for (int j = 0; j < 3; ++j) correction.columns.push_back({m[0][j], m[1][j], m[2][j]});
  return correction;
}

Matrix3 linear_part(const ColorCorrection& correction) {
  const auto& c = correction.columns;
  return {c[0][0], c[1][0], c[2][0], c[0][1], c[1][1], c[2][1], c[0][2], c[1][2], c[2][2]};
}

}  // namespace abbe
