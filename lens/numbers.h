#pragma once

#include <cmath>
#include <type_traits>

#include <ImathVec.h>

#include "materials/interface/snell.h"
#include "spectral/sampled_spectrum.h"

namespace abbe::lens {

/// Results of comparing several numbers. As a condition it is true if any of them is true, so that formulas
/// for one number apply to several. `&&` and `||` act on each lane and evaluate both sides.
template <typename Scalar, int Count>
class MaskOf;

/// `Count` numbers in SIMD registers: a number type for the formulas of one ray, which then trace `Count`
/// rays at once. Operators, `sqrt` and `abs` act on each lane; a number converts to the same value in all
/// lanes.
template <typename Scalar, int Count>
class NumbersOf {
 public:
  static constexpr int kCount = Count;
  static constexpr int kBytes = 32;
  static constexpr int kPerRegister = kBytes / sizeof(Scalar);
  static constexpr int kRegisters = Count / kPerRegister;
  using Register [[gnu::vector_size(kBytes)]] = Scalar;
  using Masks = MaskOf<Scalar, Count>;

  NumbersOf() = default;
  NumbersOf(double value) {  // not explicit, so that formulas can use constants
    for (Register& reg : registers_) reg = static_cast<Scalar>(value) - Register{};
  }
  [[nodiscard]] Scalar operator[](int lane) const {
    return registers_[lane / kPerRegister][lane % kPerRegister];
  }
  void set(int lane, Scalar value) { registers_[lane / kPerRegister][lane % kPerRegister] = value; }

  friend NumbersOf operator+(const NumbersOf& a, const NumbersOf& b) {
    return each([&](int i) { return a.registers_[i] + b.registers_[i]; });
  }
  friend NumbersOf operator-(const NumbersOf& a, const NumbersOf& b) {
    return each([&](int i) { return a.registers_[i] - b.registers_[i]; });
  }
  friend NumbersOf operator*(const NumbersOf& a, const NumbersOf& b) {
    return each([&](int i) { return a.registers_[i] * b.registers_[i]; });
  }
  friend NumbersOf operator/(const NumbersOf& a, const NumbersOf& b) {
    return each([&](int i) { return a.registers_[i] / b.registers_[i]; });
  }
  NumbersOf operator-() const {
    return each([&](int i) { return -registers_[i]; });
  }
  NumbersOf& operator+=(const NumbersOf& o) { return *this = *this + o; }
  NumbersOf& operator-=(const NumbersOf& o) { return *this = *this - o; }
  NumbersOf& operator*=(const NumbersOf& o) { return *this = *this * o; }
  NumbersOf& operator/=(const NumbersOf& o) { return *this = *this / o; }

  friend Masks operator<(const NumbersOf& a, const NumbersOf& b) {
    return compare([&](int i) { return a.registers_[i] < b.registers_[i]; });
  }
  friend Masks operator>(const NumbersOf& a, const NumbersOf& b) { return b < a; }
  friend Masks operator<=(const NumbersOf& a, const NumbersOf& b) {
    return compare([&](int i) { return a.registers_[i] <= b.registers_[i]; });
  }
  friend NumbersOf select(const Masks& which, const NumbersOf& yes, const NumbersOf& no) {
    return each([&](int i) { return reg(which, i) ? yes.registers_[i] : no.registers_[i]; });
  }
  friend NumbersOf sqrt(const NumbersOf& x) {
    return each([&](int i) {
      Register root = x.registers_[i];
      for (int j = 0; j < kPerRegister; ++j) root[j] = std::sqrt(root[j]);
      return root;
    });
  }
  friend NumbersOf abs(const NumbersOf& x) { return select(x < 0, -x, x); }

 private:
  template <typename F>
  static NumbersOf each(F f) {
    NumbersOf result;
    for (int i = 0; i < kRegisters; ++i) result.registers_[i] = f(i);
    return result;
  }
  template <typename F>
  static Masks compare(F f) {
    return Masks::each(f);
  }
  static const auto& reg(const Masks& of, int i) { return of.registers_[i]; }

  Register registers_[kRegisters]{};
};
/// One number per lane of a packet.
using Doubles = NumbersOf<double, kLanes>;
/// One number per lane of two packets, so that the latency of one is hidden by the other.
using Floats = NumbersOf<float, 2 * kLanes>;

template <typename Scalar, int Count>
class MaskOf {
 public:
  using Numbers = NumbersOf<Scalar, Count>;
  using Register = decltype(typename Numbers::Register{} < typename Numbers::Register{});

  MaskOf() = default;
  MaskOf(bool value) {  // not explicit, like that of NumbersOf
    for (Register& reg : registers_) reg = value ? ~Register{} : Register{};
  }

  [[nodiscard]] bool operator[](int lane) const {
    return registers_[lane / Numbers::kPerRegister][lane % Numbers::kPerRegister] != 0;
  }
  explicit operator bool() const {
    Register any{};
    for (const Register& reg : registers_) any |= reg;
    bool any_set = false;
    for (int i = 0; i < Numbers::kPerRegister; ++i) any_set = any_set || any[i] != 0;
    return any_set;
  }

  friend MaskOf operator&&(const MaskOf& a, const MaskOf& b) {
    return each([&](int i) { return a.registers_[i] & b.registers_[i]; });
  }
  friend MaskOf operator||(const MaskOf& a, const MaskOf& b) {
    return each([&](int i) { return a.registers_[i] | b.registers_[i]; });
  }

 private:
  friend Numbers;
  template <typename F>
  static MaskOf each(F f) {
    MaskOf result;
    for (int i = 0; i < Numbers::kRegisters; ++i) result.registers_[i] = f(i);
    return result;
  }

  Register registers_[Numbers::kRegisters]{};
};

/// Number in a lane; a single number is that of every lane.
[[nodiscard]] inline double lane_of(double x, int /*lane*/) {
  return x;
}
template <typename Scalar, int Count>
[[nodiscard]] Scalar lane_of(const NumbersOf<Scalar, Count>& x, int lane) {
  return x[lane];
}
/// Type of one of the numbers.
template <typename Real>
using ScalarOf = decltype(lane_of(Real(), 0));

/// Vector in a lane.
template <typename Scalar, int Count>
[[nodiscard]] Imath::Vec3<Scalar> lane_of(const Imath::Vec3<NumbersOf<Scalar, Count>>& v, int lane) {
  return {v.x[lane], v.y[lane], v.z[lane]};
}
template <typename Scalar, int Count>
void set_lane(Imath::Vec3<NumbersOf<Scalar, Count>>& v, int lane, const Imath::Vec3<Scalar>& value) {
  v.x.set(lane, value.x);
  v.y.set(lane, value.y);
  v.z.set(lane, value.z);
}
/// Calls `f(lane)` for each lane and returns the results. A `double` has only lane 0.
template <typename Real, typename F>
[[nodiscard]] Real by_lane(F f) {
  if constexpr (std::is_same_v<Real, double>) {
    return f(0);
  } else {
    Real all;
    for (int j = 0; j < Real::kCount; ++j) all.set(j, static_cast<ScalarOf<Real>>(f(j)));
    return all;
  }
}

/// Result of comparing two numbers: `bool` or a `MaskOf`.
template <typename Real>
using Mask = decltype(Real() < Real());

/// `yes` where `which` is true, otherwise `no`, in each lane.
[[nodiscard]] inline double select(bool which, double yes, double no) {
  return which ? yes : no;
}
template <typename Real>
[[nodiscard]] Imath::Vec3<Real> select(const Mask<Real>& which, const Imath::Vec3<Real>& yes,
                                       const Imath::Vec3<Real>& no) {
  return {select(which, yes.x, no.x), select(which, yes.y, no.y), select(which, yes.z, no.z)};
}

/// Normalised vector, which must not be 0.
template <typename Real>
[[nodiscard]] Imath::Vec3<Real> unit(const Imath::Vec3<Real>& v) {
  using std::sqrt;
  return v * (Real(1) / sqrt(v.dot(v)));
}

/// Cosine of the refraction angle in each lane; 0 for total reflection. `cos_i` is that of the angle of
/// incidence, eta = n_t/n_i.
template <typename Scalar, int Count>
[[nodiscard]] NumbersOf<Scalar, Count> refracted_cosine(const NumbersOf<Scalar, Count>& cos_i,
                                                        const NumbersOf<Scalar, Count>& eta) {
  const NumbersOf<Scalar, Count> radicand = refraction_radicand(cos_i, eta);
  return sqrt(select(radicand > 0, radicand, 0)) / eta;
}

}  // namespace abbe::lens
