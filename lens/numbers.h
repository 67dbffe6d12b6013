#pragma once

#include <cmath>
#include <type_traits>

#include <ImathVec.h>

#include "materials/interface/snell.h"
#include "spectral/packet.h"

namespace abbe::lens {

/// What holds for each of some numbers. As a condition it holds if it does for any, so that formulas written
/// for one number go on for all of them.
template <typename Scalar, int Count>
class TruthsOf;

/// So many numbers, held as vectors of the machine: a number type for the formulas of one ray, which then
/// trace as many rays at once.
template <typename Scalar, int Count>
class NumbersOf {
 public:
  static constexpr int kCount = Count;
  static constexpr int kBytes = 32;
  static constexpr int kOfPart = kBytes / sizeof(Scalar);
  static constexpr int kParts = Count / kOfPart;
  using Part [[gnu::vector_size(kBytes)]] = Scalar;
  using Truths = TruthsOf<Scalar, Count>;

  NumbersOf() = default;
  NumbersOf(double value) {  // not explicit, so that constants stand in formulas as they do for one number
    for (Part& part : parts_) part = static_cast<Scalar>(value) - Part{};
  }
  [[nodiscard]] Scalar operator[](int lane) const { return parts_[lane / kOfPart][lane % kOfPart]; }
  void set(int lane, Scalar value) { parts_[lane / kOfPart][lane % kOfPart] = value; }

  friend NumbersOf operator+(const NumbersOf& a, const NumbersOf& b) {
    return each([&](int i) { return a.parts_[i] + b.parts_[i]; });
  }
  friend NumbersOf operator-(const NumbersOf& a, const NumbersOf& b) {
    return each([&](int i) { return a.parts_[i] - b.parts_[i]; });
  }
  friend NumbersOf operator*(const NumbersOf& a, const NumbersOf& b) {
    return each([&](int i) { return a.parts_[i] * b.parts_[i]; });
  }
  friend NumbersOf operator/(const NumbersOf& a, const NumbersOf& b) {
    return each([&](int i) { return a.parts_[i] / b.parts_[i]; });
  }
  NumbersOf operator-() const {
    return each([&](int i) { return -parts_[i]; });
  }
  NumbersOf& operator+=(const NumbersOf& o) { return *this = *this + o; }
  NumbersOf& operator-=(const NumbersOf& o) { return *this = *this - o; }
  NumbersOf& operator*=(const NumbersOf& o) { return *this = *this * o; }
  NumbersOf& operator/=(const NumbersOf& o) { return *this = *this / o; }

  friend Truths operator<(const NumbersOf& a, const NumbersOf& b) {
    return compare([&](int i) { return a.parts_[i] < b.parts_[i]; });
  }
  friend Truths operator>(const NumbersOf& a, const NumbersOf& b) { return b < a; }
  friend Truths operator<=(const NumbersOf& a, const NumbersOf& b) {
    return compare([&](int i) { return a.parts_[i] <= b.parts_[i]; });
  }
  friend NumbersOf select(const Truths& which, const NumbersOf& yes, const NumbersOf& no) {
    return each([&](int i) { return part(which, i) ? yes.parts_[i] : no.parts_[i]; });
  }
  friend NumbersOf sqrt(const NumbersOf& x) {
    return each([&](int i) {
      Part root = x.parts_[i];
      for (int j = 0; j < kOfPart; ++j) root[j] = std::sqrt(root[j]);
      return root;
    });
  }
  friend NumbersOf abs(const NumbersOf& x) { return select(x < 0, -x, x); }

 private:
  template <typename F>
  static NumbersOf each(F f) {
    NumbersOf result;
    for (int i = 0; i < kParts; ++i) result.parts_[i] = f(i);
    return result;
  }
  template <typename F>
  static Truths compare(F f) {
    return Truths::each(f);
  }
  static const auto& part(const Truths& of, int i) { return of.parts_[i]; }

  Part parts_[kParts]{};
};
/// One for each of as many rays as a packet has lanes.
using Doubles = NumbersOf<double, kLanes>;
/// One for each lane of two packets: what one alone would wait for goes on with the other.
using Floats = NumbersOf<float, 2 * kLanes>;

template <typename Scalar, int Count>
class TruthsOf {
 public:
  using Numbers = NumbersOf<Scalar, Count>;
  using Part = decltype(typename Numbers::Part{} < typename Numbers::Part{});

  TruthsOf() = default;
  TruthsOf(bool value) {  // not explicit, for the same reason
    for (Part& part : parts_) part = value ? ~Part{} : Part{};
  }

  [[nodiscard]] bool operator[](int lane) const {
    return parts_[lane / Numbers::kOfPart][lane % Numbers::kOfPart] != 0;
  }
  explicit operator bool() const {
    Part any{};
    for (const Part& part : parts_) any |= part;
    bool found = false;
    for (int i = 0; i < Numbers::kOfPart; ++i) found = found || any[i] != 0;
    return found;
  }

  friend TruthsOf operator&&(const TruthsOf& a, const TruthsOf& b) {
    return each([&](int i) { return a.parts_[i] & b.parts_[i]; });
  }
  friend TruthsOf operator||(const TruthsOf& a, const TruthsOf& b) {
    return each([&](int i) { return a.parts_[i] | b.parts_[i]; });
  }

 private:
  friend Numbers;
  template <typename F>
  static TruthsOf each(F f) {
    TruthsOf result;
    for (int i = 0; i < Numbers::kParts; ++i) result.parts_[i] = f(i);
    return result;
  }

  Part parts_[Numbers::kParts]{};
};

/// The number of a lane.
[[nodiscard]] inline double lane_of(double x, int /*lane*/) {
  return x;
}
template <typename Scalar, int Count>
[[nodiscard]] Scalar lane_of(const NumbersOf<Scalar, Count>& x, int lane) {
  return x[lane];
}
/// The type of one of them.
template <typename Real>
using ScalarOf = decltype(lane_of(Real(), 0));

/// The vector of a lane.
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
/// The numbers that a function gives for each lane; for one number it is asked for lane 0.
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

/// Lane by lane.
template <typename Scalar, int Count>
[[nodiscard]] NumbersOf<Scalar, Count> refracted_cosine(const NumbersOf<Scalar, Count>& cos_i,
                                                        const NumbersOf<Scalar, Count>& eta) {
  const NumbersOf<Scalar, Count> radicand = refraction_radicand(cos_i, eta);
  return sqrt(select(radicand > 0, radicand, 0)) / eta;
}

}  // namespace abbe::lens
