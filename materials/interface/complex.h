#pragma once

namespace abbe {

/// A complex number of any scalar type. std::complex supports the built-in types only and checks every
/// product for NaN.
template <typename T>
struct Complex {
  T re, im;
};

template <typename T>
Complex<T> operator+(const Complex<T>& a, const Complex<T>& b) {
  return {a.re + b.re, a.im + b.im};
}
template <typename T>
Complex<T> operator*(const Complex<T>& a, const Complex<T>& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
/// |a|^2, as std::norm.
template <typename T>
T norm(const Complex<T>& a) {
  return a.re * a.re + a.im * a.im;
}
/// a times the real number s.
template <typename T>
Complex<T> scaled(const Complex<T>& a, const T& s) {
  return {a.re * s, a.im * s};
}
template <typename T>
Complex<T> conjugate(const Complex<T>& a) {
  return {a.re, -a.im};
}
template <typename T>
Complex<T> operator/(const Complex<T>& a, const Complex<T>& b) {
  return scaled(a * conjugate(b), T(1) / norm(b));
}

/// -i a.
template <typename T>
Complex<T> minus_i(const Complex<T>& a) {
  return {a.im, -a.re};
}

/// (re + i im)^2.
template <typename T>
Complex<T> square(const T& re, const T& im) {
  return {(re - im) * (re + im), T(2) * re * im};
}

}  // namespace abbe
