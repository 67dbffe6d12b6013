#pragma once

#include <cmath>
#include <optional>

#include <ImathVec.h>

namespace abbe {

/// Mirror direction of `wo` about the unit normal `n`, both pointing away from the surface.
template <typename T>
[[nodiscard]] Imath::Vec3<T> reflect(const Imath::Vec3<T>& wo, const Imath::Vec3<T>& n) {
  return n * (2 * wo.dot(n)) - wo;
}

/// The type in which to subtract nearly equal squares: the next wider type, or T itself if there is none
/// (dual numbers).
template <typename T>
struct Wider {
  using type = T;
};
template <>
struct Wider<float> {
  using type = double;
};
template <>
struct Wider<double> {
  using type = long double;
};

/// (eta cos_t)^2 = eta^2 - sin_i^2, rounded only after its terms have cancelled. It vanishes at the critical
/// angle, and cos_t would lose half as many digits as the radicand.
template <typename T>
[[nodiscard]] auto refraction_radicand(const T& cos_i, const T& eta) {
  using W = typename Wider<T>::type;
  const W c(cos_i);
  const W e(eta);
  return (e - W(1)) * (e + W(1)) + c * c;
}

/// The radicand for doubles. The squares of doubles do not fit a long double, so each is split into a head of
/// 24 bits and a tail.
[[nodiscard]] inline long double refraction_radicand(double cos_i, double eta) {
  const long double c = static_cast<float>(cos_i);
  const long double e = static_cast<float>(eta);
  const long double c_tail = cos_i - c;
  const long double e_tail = eta - e;
  return ((e - 1) * (e + 1) + c * c) + 2 * (e * e_tail + c * c_tail) + (e_tail * e_tail + c_tail * c_tail);
}

/// `yes` if `which` is true, else `no`. Types that hold several numbers overload this function element by
/// element.
template <typename T>
[[nodiscard]] T select(bool which, const T& yes, const T& no) {
  return which ? yes : no;
}

/// Cosine of the refracted angle for cos_i in [0, 1] and eta = n_t/n_i; 0 for total internal reflection. It
/// is exactly cos_i for eta = 1.
template <typename T>
[[nodiscard]] T refracted_cosine(const T& cos_i, const T& eta) {
  using std::sqrt;
  const auto d = refraction_radicand(cos_i, eta);
  return d > decltype(d)(0) ? T(sqrt(d) / eta) : T(0);
}

/// Direction of the refracted ray, pointing away from the surface on the side opposite to the unit vector
/// `wo`. The unit normal n points to the side of wo, n.wo > 0, and eta = n_t/n_i. Empty for total internal
/// reflection. [Marschner2021, sec. 14.1]
template <typename T>
[[nodiscard]] std::optional<Imath::Vec3<T>> refract(const Imath::Vec3<T>& wo, const Imath::Vec3<T>& n,
                                                    const T& eta) {
  const T cos_i = n.dot(wo);
  const T cos_t = refracted_cosine(cos_i, eta);
  if (!(cos_t > T(0))) return std::nullopt;
  const T inverse = T(1) / eta;
  return n * (cos_i * inverse - cos_t) - wo * inverse;
}

}  // namespace abbe
