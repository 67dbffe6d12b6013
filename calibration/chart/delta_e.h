#pragma once

#include <array>
#include <cmath>
#include <numbers>

namespace abbe {

/// Colour differences as templates on the scalar type, so that a fit differentiates the reported formula.
/// Arguments are CIE 1976 L*, a*, b*. Derivatives with respect to dual numbers are finite everywhere, also at
/// zero difference and on the neutral axis.

namespace delta_e_detail {

// Square root whose derivative at zero is zero instead of infinite. Slightly negative arguments are rounded
// zeros.
template <typename T>
[[nodiscard]] T root(const T& x) {
  using std::sqrt;
  return x <= T(0.0) ? T(0.0) : T(sqrt(x));
}

template <typename T>
[[nodiscard]] T square(const T& x) {
  return x * x;
}

template <typename T>
[[nodiscard]] T length(const T& a, const T& b) {
  return root(T(a * a + b * b));
}

template <typename T>
[[nodiscard]] T radians(const T& degrees) {
  return degrees * (std::numbers::pi / 180.0);
}

// sqrt(C^7 / (C^7 + 25^7)), the sigmoid of eq. 4 and of R_C.
template <typename T>
[[nodiscard]] T chroma_sigmoid(const T& c) {
  constexpr double k25Power7 = 6103515625.0;
  const T c7 = c * c * c * c * c * c * c;
  return root(T(c7 / (c7 + k25Power7)));
}

// Hue angle in [0, 360) degrees; 0 for grey.
template <typename T>
[[nodiscard]] T hue_degrees(const T& a, const T& b) {
  using std::atan2;
  if (a == T(0.0) && b == T(0.0)) return T(0.0);
  const T h = atan2(b, a) * (180.0 / std::numbers::pi);
  return h < T(0.0) ? T(h + 360.0) : h;
}

// The published tests include exactly opposite hues; rounding must not move them across the discontinuity.
inline constexpr double kOppositeHues = 180.0 + 1e-9;

// Mean hue in degrees, eq. 14: over the shorter arc, and (h1 + h2)/2 for opposite hues. A grey colour needs
// no special case. Its hue difference is zero, and so are all terms in which the mean hue appears.
template <typename T>
[[nodiscard]] T mean_hue(const T& h1, const T& h2) {
  using std::abs;
  const T total = h1 + h2;
  if (abs(h1 - h2) <= T(kOppositeHues)) return total / 2.0;
  return total < T(360.0) ? T((total + 360.0) / 2.0) : T((total - 360.0) / 2.0);
}

// Hue difference 2 sqrt(C1 C2) sin(dh/2), eq. 11, from the vectors. The cross-product form is smooth for
// equal hues; for opposite hues the sign is that of h2 - h1.
template <typename T>
[[nodiscard]] T hue_difference(const T& a1, const T& b1, const T& a2, const T& b2, const T& c1c2, const T& h1,
                               const T& h2) {
  using std::abs;
  const T dot = a1 * a2 + b1 * b2;
  const T cross = a1 * (b2 - b1) - b1 * (a2 - a1);  // exactly zero for equal colours
  if (c1c2 <= T(0.0)) return T(0.0);
  if (dot >= T(0.0)) return cross / root(T((c1c2 + dot) / 2.0));
  const T size = root(T(2.0 * (c1c2 - dot)));
  const T turn = h2 - h1;
  const bool wraps = abs(turn) > T(kOppositeHues);
  return (turn < T(0.0)) != wraps ? T(-size) : size;
}

}  // namespace delta_e_detail

/// CIEDE2000 (k_L = k_C = k_H = 1) as a vector whose length is the difference [Sharma2005, eqs. 2-22]. Its
/// components are the weighted differences in lightness, chroma and hue, `lab2` minus `lab1`. The rotation
/// term is included by completing the square, C'^2 + H'^2 + R_T C' H' = (C' + R_T H'/2)^2 + (1 - R_T^2/4)
/// H'^2. The vector is therefore smooth at zero difference, where its length is not.
template <typename T>
[[nodiscard]] std::array<T, 3> delta_e_2000_vector(const std::array<T, 3>& lab1,
                                                   const std::array<T, 3>& lab2) {
  using namespace delta_e_detail;
  using std::cos;
  using std::exp;
  using std::sin;
  const T c_mean = (length(lab1[1], lab1[2]) + length(lab2[1], lab2[2])) / 2.0;
  const T a_factor = 1.5 - 0.5 * chroma_sigmoid(c_mean);
  const T a1 = a_factor * lab1[1];
  const T a2 = a_factor * lab2[1];
  const T c1 = length(a1, lab1[2]);
  const T c2 = length(a2, lab2[2]);
  const T h1 = hue_degrees(a1, lab1[2]);
  const T h2 = hue_degrees(a2, lab2[2]);
  const T c1c2 = c1 * c2;

  const T l50 = square(T((lab1[0] + lab2[0]) / 2.0 - 50.0));
  const T c_bar = (c1 + c2) / 2.0;
  const T h_bar = mean_hue(h1, h2);
  const T t = 1.0 - 0.17 * cos(radians(T(h_bar - 30.0))) + 0.24 * cos(radians(T(2.0 * h_bar))) +
              0.32 * cos(radians(T(3.0 * h_bar + 6.0))) - 0.20 * cos(radians(T(4.0 * h_bar - 63.0)));
  const T s_l = 1.0 + 0.015 * l50 / root(T(20.0 + l50));
  const T s_c = 1.0 + 0.045 * c_bar;
  const T s_h = 1.0 + 0.015 * c_bar * t;
  const T rotation = 30.0 * exp(-square(T((h_bar - 275.0) / 25.0)));
  const T r_t = -sin(radians(T(2.0 * rotation))) * 2.0 * chroma_sigmoid(c_bar);

  const T dl = (lab2[0] - lab1[0]) / s_l;
  const T dc = (c2 - c1) / s_c;
  const T dh = hue_difference(a1, lab1[2], a2, lab2[2], c1c2, h1, h2) / s_h;
  return {dl, T(dc + r_t * dh / 2.0), T(dh * root(T(1.0 - r_t * r_t / 4.0)))};
}

/// CIEDE2000 colour difference, k_L = k_C = k_H = 1 [Sharma2005, eq. 22]; symmetric in its arguments. Exactly
/// opposite hues take the branch |h1 - h2| <= 180.
template <typename T>
[[nodiscard]] T delta_e_2000(const std::array<T, 3>& lab1, const std::array<T, 3>& lab2) {
  using namespace delta_e_detail;
  const std::array<T, 3> d = delta_e_2000_vector(lab1, lab2);
  return root(T(square(d[0]) + square(d[1]) + square(d[2])));
}

/// CIE 1994 colour difference with the weights of the graphic arts [CIE116]. It is not symmetric: `lab1` is
/// the standard.
template <typename T>
[[nodiscard]] T delta_e_94(const std::array<T, 3>& lab1, const std::array<T, 3>& lab2) {
  using namespace delta_e_detail;
  const T c1 = length(lab1[1], lab1[2]);
  const T dc = length(lab2[1], lab2[2]) - c1;
  const T dh2 = square(T(lab2[1] - lab1[1])) + square(T(lab2[2] - lab1[2])) - dc * dc;
  return root(T(square(T(lab2[0] - lab1[0])) + square(T(dc / (1.0 + 0.045 * c1))) +
                dh2 / square(T(1.0 + 0.015 * c1))));
}

/// CIE 1976 colour difference: the distance in L*a*b* [CIE15, sec. 8.2.1].
template <typename T>
[[nodiscard]] T delta_e_76(const std::array<T, 3>& lab1, const std::array<T, 3>& lab2) {
  using namespace delta_e_detail;
  return root(T(square(T(lab2[0] - lab1[0])) + square(T(lab2[1] - lab1[1])) + square(T(lab2[2] - lab1[2]))));
}

}  // namespace abbe
