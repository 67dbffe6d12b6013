#pragma once

#include <cmath>
#include <type_traits>

#include "materials/interface/snell.h"
#include "spectral/packet.h"

namespace abbe::lens {

/// What holds for each of several `Doubles`. As a condition it holds if it does for any, so that formulas
/// written for one number go on for all of them.
class Truths;

/// A double for each lane of a packet, held as vectors of the machine: a number type for the formulas of one
/// ray, which then trace all lanes of a packet at once.
class Doubles {
 public:
  using Four [[gnu::vector_size(4 * sizeof(double))]] = double;
  static constexpr int kParts = kLanes / 4;

  Doubles() = default;
  Doubles(double value) {  // not explicit, so that constants stand in formulas as they do for one number
    for (Four& part : parts_) part = value - Four{};
  }
  explicit Doubles(const SampledSpectrum& values) {
    for (int i = 0; i < kLanes; ++i) set(i, static_cast<double>(values[i]));
  }

  [[nodiscard]] double operator[](int lane) const { return parts_[lane / 4][lane % 4]; }
  void set(int lane, double value) { parts_[lane / 4][lane % 4] = value; }

  friend Doubles operator+(const Doubles& a, const Doubles& b) {
    return each([&](int i) { return a.parts_[i] + b.parts_[i]; });
  }
  friend Doubles operator-(const Doubles& a, const Doubles& b) {
    return each([&](int i) { return a.parts_[i] - b.parts_[i]; });
  }
  friend Doubles operator*(const Doubles& a, const Doubles& b) {
    return each([&](int i) { return a.parts_[i] * b.parts_[i]; });
  }
  friend Doubles operator/(const Doubles& a, const Doubles& b) {
    return each([&](int i) { return a.parts_[i] / b.parts_[i]; });
  }
  Doubles operator-() const {
    return each([&](int i) { return -parts_[i]; });
  }
  Doubles& operator+=(const Doubles& o) { return *this = *this + o; }
  Doubles& operator-=(const Doubles& o) { return *this = *this - o; }
  Doubles& operator*=(const Doubles& o) { return *this = *this * o; }
  Doubles& operator/=(const Doubles& o) { return *this = *this / o; }

  friend Truths operator<(const Doubles& a, const Doubles& b);
  friend Truths operator>(const Doubles& a, const Doubles& b);
  friend Truths operator<=(const Doubles& a, const Doubles& b);
  friend Doubles select(const Truths& which, const Doubles& yes, const Doubles& no);
  friend Doubles sqrt(const Doubles& x);
  friend Doubles abs(const Doubles& x);

 private:
  template <typename F>
  static Doubles each(F f) {
    Doubles result;
    for (int i = 0; i < kParts; ++i) result.parts_[i] = f(i);
    return result;
  }

  Four parts_[kParts]{};
};

class Truths {
 public:
  using Four = decltype(Doubles::Four{} < Doubles::Four{});

  Truths() = default;
  Truths(bool value) {  // not explicit, for the same reason
    for (Four& part : parts_) part = value ? ~Four{} : Four{};
  }

  [[nodiscard]] bool operator[](int lane) const { return parts_[lane / 4][lane % 4] != 0; }
  explicit operator bool() const {
    Four any{};
    for (const Four& part : parts_) any |= part;
    return (any[0] | any[1] | any[2] | any[3]) != 0;
  }

  friend Truths operator&&(const Truths& a, const Truths& b) {
    return each([&](int i) { return a.parts_[i] & b.parts_[i]; });
  }
  friend Truths operator||(const Truths& a, const Truths& b) {
    return each([&](int i) { return a.parts_[i] | b.parts_[i]; });
  }
  friend Truths operator<(const Doubles& a, const Doubles& b) {
    return each([&](int i) { return a.parts_[i] < b.parts_[i]; });
  }
  friend Truths operator>(const Doubles& a, const Doubles& b) { return b < a; }
  friend Truths operator<=(const Doubles& a, const Doubles& b) {
    return each([&](int i) { return a.parts_[i] <= b.parts_[i]; });
  }
  friend Doubles select(const Truths& which, const Doubles& yes, const Doubles& no) {
    return Doubles::each([&](int i) { return which.parts_[i] ? yes.parts_[i] : no.parts_[i]; });
  }

 private:
  template <typename F>
  static Truths each(F f) {
    Truths result;
    for (int i = 0; i < kParts; ++i) result.parts_[i] = f(i);
    return result;
  }
  static constexpr int kParts = Doubles::kParts;

  Four parts_[kParts]{};
};

inline Doubles sqrt(const Doubles& x) {
  return Doubles::each([&](int i) {
    Doubles::Four root = x.parts_[i];
    for (int j = 0; j < 4; ++j) root[j] = std::sqrt(root[j]);
    return root;
  });
}
inline Doubles abs(const Doubles& x) {
  return select(x < 0, -x, x);
}

/// The number of a lane.
[[nodiscard]] inline double lane_of(double x, int /*lane*/) {
  return x;
}
[[nodiscard]] inline double lane_of(const Doubles& x, int lane) {
  return x[lane];
}
/// The numbers that a function gives for each lane; for one number it is asked for lane 0.
template <typename Real, typename F>
[[nodiscard]] Real by_lane(F f) {
  if constexpr (std::is_same_v<Real, double>) {
    return f(0);
  } else {
    Real all;
    for (int j = 0; j < kLanes; ++j) all.set(j, f(j));
    return all;
  }
}

/// What comparing two numbers gives.
template <typename Real>
using Truth = decltype(Real() < Real());

[[nodiscard]] inline double select(bool which, double yes, double no) {
  return which ? yes : no;
}
template <typename Real>
[[nodiscard]] Imath::Vec3<Real> select(const Truth<Real>& which, const Imath::Vec3<Real>& yes,
                                       const Imath::Vec3<Real>& no) {
  return {select(which, yes.x, no.x), select(which, yes.y, no.y), select(which, yes.z, no.z)};
}

/// The vector over its length.
template <typename Real>
[[nodiscard]] Imath::Vec3<Real> unit(const Imath::Vec3<Real>& v) {
  using std::sqrt;
  return v * (Real(1) / sqrt(v.dot(v)));
}

}  // namespace abbe::lens

namespace abbe {

/// Lane by lane.
template <>
inline lens::Doubles refracted_cosine(const lens::Doubles& cos_i, const lens::Doubles& eta) {
  const lens::Doubles radicand = refraction_radicand(cos_i, eta);
  return sqrt(select(radicand > 0, radicand, 0)) / eta;
}

}  // namespace abbe
