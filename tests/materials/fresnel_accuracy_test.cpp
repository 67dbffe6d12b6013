// The closed forms against the textbook formulas in a type of 113 bits, for the same inputs after rounding.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include <cmath>
#include <random>

#include "materials/interface/fresnel.h"
#include "tests/tier.h"

namespace abbe {
namespace {

using Quad = boost::multiprecision::cpp_bin_float_quad;

// Runs that are not nightly use one of thirty inputs, of the same kinds.
int inputs() {
  return test::nightly() ? 1'000'000 : 33'000;
}

struct Tolerance {
  double relative;  ///< Of T and A outside the zone around the critical angle.
  double zone;      ///< Half width of that zone in |1 - sin/eta|.
  double absolute;  ///< Of R everywhere, and of T within the zone.
};
template <typename T>
constexpr Tolerance kTolerance{};
template <>
constexpr Tolerance kTolerance<float>{1e-5, 1e-3, 1e-6};
template <>
constexpr Tolerance kTolerance<double>{1e-12, 1e-5, 1e-13};

FresnelPower<Quad> textbook_dielectric(const Quad& c, const Quad& eta) {
  const Quad sin2 = 1 - c * c;
  if (sin2 >= eta * eta) return {1, 1, 0, 0, 0};
  const Quad ct = sqrt(1 - sin2 / (eta * eta));
  const Quad rs = (c - eta * ct) / (c + eta * ct);
  const Quad rp = (eta * c - ct) / (eta * c + ct);
  return {rs * rs, rp * rp, 1 - rs * rs, 1 - rp * rp, ct};
}

FresnelPower<Quad> textbook_conductor(const Quad& c, const Quad& n, const Quad& k) {
  const Quad sin2 = 1 - c * c;
  const Quad re = n * n - k * k - sin2;
  const Quad im = 2 * n * k;
  const Quad size = sqrt(re * re + im * im);
  // The larger part comes from the sum, the other from im/2 divided by it. This preserves at any precision
  // what size - |re| loses.
  const Quad large = sqrt((size + (re < 0 ? -re : re)) / 2);
  const Quad small = large > 0 ? Quad(im / (2 * large)) : Quad(0);
  const Quad a = re < 0 ? small : large;
  const Quad b = re < 0 ? large : small;
  const Quad Rs = ((c - a) * (c - a) + b * b) / ((c + a) * (c + a) + b * b);
  const Quad st = sin2 / c;
  const Quad Rp = Rs * ((a - st) * (a - st) + b * b) / ((a + st) * (a + st) + b * b);
  return {Rs, Rp, 1 - Rs, 1 - Rp, 0};
}

double to_double(const Quad& x) {
  return x.convert_to<double>();
}

template <typename T>
void expect_close(const FresnelPower<T>& got, const FresnelPower<Quad>& exact, double distance,
                  const std::string& at) {
  const Tolerance tolerance = kTolerance<T>;
  ASSERT_NEAR(got.Rs, to_double(exact.Rs), tolerance.absolute) << at;
  ASSERT_NEAR(got.Rp, to_double(exact.Rp), tolerance.absolute) << at;
  const auto bound = [&](double t) {
    return distance > tolerance.zone ? tolerance.relative * t : tolerance.absolute;
  };
  ASSERT_NEAR(got.Ts, to_double(exact.Ts), bound(to_double(exact.Ts))) << at;
  ASSERT_NEAR(got.Tp, to_double(exact.Tp), bound(to_double(exact.Tp))) << at;
}

// Cosines that cover all angles, grazing angles, and those around the critical angle of `eta`.
class Angles {
 public:
  double cosine(double eta) {
    const double u = uniform_(rng_);
    switch (rng_() % 3) {
      case 0:
        return 1 - u;
      case 1:
        return std::pow(10.0, -8 * u);
      default: {
        const double s = std::min(eta, 1.0) * (1 + (rng_() % 2 ? 1 : -1) * std::pow(10.0, -12 * u));
        return s < 1 ? std::sqrt((1 - s) * (1 + s)) : 1 - u;
      }
    }
  }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform_(rng_)); }

 private:
  std::mt19937 rng_{7};
  std::uniform_real_distribution<double> uniform_;
};

template <typename T>
class FresnelAccuracy : public testing::Test {};
using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(FresnelAccuracy, Scalars);

template <typename T>
std::string describe(T c, T eta, T k = 0) {
  std::ostringstream text;
  text << std::setprecision(17) << "cos " << c << " eta " << eta << " k " << k;
  return text.str();
}

template <typename T>
double distance_to_critical(T c, T eta) {
  const auto cosine = static_cast<long double>(c);
  return static_cast<double>(
      std::abs(1 - std::sqrt((1 - cosine) * (1 + cosine)) / static_cast<long double>(eta)));
}

TYPED_TEST(FresnelAccuracy, Dielectric) {
  using T = TypeParam;
  Angles angles;
  for (int i = 0; i < inputs() && !this->HasFatalFailure(); ++i) {
    const T eta =
        static_cast<T>(i % 4 == 0 ? 1 + angles.log_uniform(1e-7, 1e-2) : angles.log_uniform(0.3, 4));
    const T c = static_cast<T>(angles.cosine(eta));
    expect_close<T>(fresnel_dielectric(c, eta), textbook_dielectric(Quad(c), Quad(eta)),
                    distance_to_critical(c, eta), describe(c, eta));
  }
}

TYPED_TEST(FresnelAccuracy, Conductor) {
  using T = TypeParam;
  Angles angles;
  for (int i = 0; i < inputs() && !this->HasFatalFailure(); ++i) {
    const T n = static_cast<T>(angles.log_uniform(0.01, 10));
    const T k = static_cast<T>(angles.log_uniform(0.01, 50));
    const T c = static_cast<T>(angles.cosine(n));
    expect_close<T>(fresnel_conductor(c, n, k), textbook_conductor(Quad(c), Quad(n), Quad(k)), 1,
                    describe(c, n, k));
  }
}

TYPED_TEST(FresnelAccuracy, ExtremeConductors) {
  using T = TypeParam;
  const std::pair<double, double> extremes[] = {{0.01, 50}, {0.001, 1000}, {1000, 0.001}, {300, 300},
                                                {0.05, 1},  {1.5, 1e-6},   {0.5, 1e-4},   {1, 1e-5}};
  Angles angles;
  for (const auto& [wide_n, wide_k] : extremes) {
    for (int i = 0; i < 2000 && !this->HasFatalFailure(); ++i) {
      const T n = static_cast<T>(wide_n);
      const T k = static_cast<T>(wide_k);
      const T c = static_cast<T>(angles.cosine(wide_n));
      expect_close<T>(fresnel_conductor(c, n, k), textbook_conductor(Quad(c), Quad(n), Quad(k)),
                      distance_to_critical(c, n), describe(c, n, k));
    }
  }
}

}  // namespace
}  // namespace abbe
