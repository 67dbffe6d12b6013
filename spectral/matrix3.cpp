#include "spectral/matrix3.h"

#include <stdexcept>
#include <vector>

#include <fmt/format.h>

#include "io/text.h"

namespace abbe {

std::string to_text(const Matrix3& m) {
  return fmt::format("{} {} {} {} {} {} {} {} {}", m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2],
                     m[2][0], m[2][1], m[2][2]);
}

std::optional<Matrix3> parse_matrix3(std::string_view text) {
  const std::vector<std::string> words = split(text, ' ');
  if (words.size() != 9) return std::nullopt;
  Matrix3 m;
  for (int i = 0; i < 9; ++i) {
    const auto number = parse_number(words[static_cast<std::size_t>(i)]);
    if (!number) return std::nullopt;
    m[i / 3][i % 3] = *number;
  }
  return m;
}

bool is_invertible(const Matrix3& m) {
  try {
    (void)m.inverse(true);
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

}  // namespace abbe
