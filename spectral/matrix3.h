#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <Imath/ImathMatrix.h>

namespace abbe {

/// A 3x3 colour matrix acting on column vectors: y_i = sum_j m[i][j] x_j. Products and inverses are Imath's.
using Matrix3 = Imath::M33d;

/// Product of a colour matrix and a column vector.
[[nodiscard]] inline std::array<double, 3> multiply(const Matrix3& m, const std::array<double, 3>& x) {
  std::array<double, 3> y{};
  for (int i = 0; i < 3; ++i)
    y[static_cast<std::size_t>(i)] = m[i][0] * x[0] + m[i][1] * x[1] + m[i][2] * x[2];
  return y;
}

/// Elements of the matrix row by row, separated by single blanks, as in film attributes. The digits restore
/// the exact numbers.
[[nodiscard]] std::string to_text(const Matrix3& m);
/// Parses the text of `to_text`. Nothing unless `text` is nine numbers separated by single blanks.
[[nodiscard]] std::optional<Matrix3> parse_matrix3(std::string_view text);

/// True if the matrix has an inverse with finite elements.
[[nodiscard]] bool is_invertible(const Matrix3& m);

/// Diagonal matrix with the elements `d`.
[[nodiscard]] inline Matrix3 diagonal(const std::array<double, 3>& d) {
  return {d[0], 0, 0, 0, d[1], 0, 0, 0, d[2]};
}

}  // namespace abbe
