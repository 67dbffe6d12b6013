// Polarisers and wave plates against textbook results, from both sides and at oblique incidence.
#include "materials/bsdf/thin_element.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "materials/bsdf.h"
#include "materials/bsdf/warp.h"
#include "materials/material.h"
#include "sampling/angle.h"
#include "tests/materials/bsdf_examples.h"

namespace abbe {
namespace {

using Imath::V3d;
using Imath::V3f;

constexpr double kFloat = 1e-6;

// A Stokes vector in a frame whose first axis is `axis`; the second is k x axis.
struct Light {
  V3d k, axis;
  double i, q, u, v;

  [[nodiscard]] Light in_frame_of(const V3d& other) const {
    const double twice = 2 * std::atan2(k.cross(axis).dot(other), axis.dot(other));
    return {k, other, i, q * std::cos(twice) + u * std::sin(twice), u * std::cos(twice) - q * std::sin(twice),
            v};
  }
};

// The light that an element transmits; it arrives from -k.
Light through(const MaterialModel& model, const Light& light, double nm = 550) {
  const SampledSpectrum wavelengths(static_cast<float>(nm));
  const Bsdf bsdf = make_bsdf({"element", model}, {wavelengths});
  const V3f wo(-light.k);
  const auto event = sample(bsdf, wo, {0.5F, {}}, 3, TransportMode::power);
  EXPECT_TRUE(event && event->delta && event->transmitted);
  EXPECT_EQ(event->wi, -wo) << "straight on";
  const auto m = mueller(bsdf, wo, event->wi, true);
  const double power = event->weight[3];
  if (!m) return {light.k, light.axis, power * light.i, 0, 0, 0};
  const Light in = light.in_frame_of(V3d(m->axis));
  return {light.k,
          V3d(m->axis),
          power * (in.i + m->d[3] * in.q),
          power * (m->d[3] * in.i + m->p[3] * in.q),
          power * (m->c[3] * in.u - m->s[3] * in.v),
          power * (m->s[3] * in.u + m->c[3] * in.v)};
}

constexpr V3d kDown(0, 0, -1);
constexpr V3d kUp(0, 0, 1);
const V3d kX(1, 0, 0);

Light unpolarised(const V3d& k) {
  return {k, kX, 1, 0, 0, 0};
}
V3d at_angle(double degrees) {
  return {std::cos(degrees * kDegree), std::sin(degrees * kDegree), 0};
}
PolariserMaterial polariser(double angle_deg, double blocked = 0, double passed = 1) {
  return {{Curve(passed)}, Curve(blocked), angle_deg * kDegree};
}
WavePlateMaterial wave_plate(double retardance_deg, double angle_deg) {
  return {{Curve(1.0)}, WavePlateMaterial::Ideal{retardance_deg * kDegree}, angle_deg * kDegree};
}

// [Born1999, sec. 10.9] derives Malus' law; two polarisers with Mueller matrices obey it.
TEST(Polariser, ObeysMalusLawFromBothSides) {
  for (const V3d& k : {kDown, kUp})
    for (const double angle : {0.0, 20.0, 45.0, 90.0, 130.0}) {
      const Light once = through(polariser(10), unpolarised(k));
      EXPECT_NEAR(once.i, 0.5, kFloat);
      const Light twice = through(polariser(10 + angle), once);
      EXPECT_NEAR(twice.i, 0.5 * std::pow(std::cos(angle * kDegree), 2), kFloat) << angle;
      EXPECT_NEAR(std::hypot(twice.q, twice.u, twice.v), twice.i, kFloat) << "wholly polarised";
    }
}

TEST(Polariser, PassesFieldsAlongItsAxis) {
  const Light passed = through(polariser(30), unpolarised(kDown)).in_frame_of(at_angle(30));
  EXPECT_NEAR(passed.q, 0.5, kFloat) << "counterclockwise from u, as seen from outside";
}

TEST(Polariser, LetsThroughWhatItsExtinctionRatioSays) {
  const PolariserMaterial real = polariser(0, 1 / 50.0, 0.8);
  const Light crossed = through(real, through(polariser(90), unpolarised(kDown)));
  EXPECT_NEAR(crossed.i, 0.5 * 0.8 / 50, kFloat);
  EXPECT_NEAR(through(real, unpolarised(kDown)).i, 0.4 * (1 + 1 / 50.0), kFloat);
  const auto power = smooth_power({"polariser", real}, {550, 0.7, false});
  ASSERT_TRUE(power);
  EXPECT_NEAR(power->transmitted(), 0.408, 1e-12);
}

// A polariser at 45 degrees between crossed polarisers transmits an eighth.
TEST(Polariser, BetweenCrossedOnesLetsLightThrough) {
  const Light last =
      through(polariser(90), through(polariser(45), through(polariser(0), unpolarised(kDown))));
  EXPECT_NEAR(last.i, 0.125, kFloat);
}

// At oblique incidence the axis is projected perpendicular to the ray. Fields in the plane of incidence pass
// a polariser whose axis is in that plane.
TEST(Polariser, HasItsProjectedAxisForObliqueLight) {
  const V3d k = V3d(0.8, 0, -0.6);
  const Light light{k, V3d(0, 1, 0), 1, 0, 0, 0};
  const Light along = through(polariser(0), light);
  EXPECT_NEAR(along.in_frame_of(V3d(0, 1, 0)).q, -0.5, kFloat);
  EXPECT_NEAR(through(polariser(90), along).i, 0, kFloat);
}

// Fast axis along x: the field along y lags by a quarter wave, so linear light at 45 degrees becomes
// circular. The receiver sees it turn counterclockwise, V < 0, since E_y = i E_x at exp(-i omega t).
TEST(WavePlate, MakesCircularLightOfLinear) {
  for (const V3d& k : {kDown, kUp}) {
    const V3d y = k.cross(kX);
    const Light diagonal{k, (kX + y).normalized(), 1, 1, 0, 0};
    const Light circular = through(wave_plate(90, 0), diagonal);
    EXPECT_NEAR(circular.v, -1, kFloat);
    const Light other = through(wave_plate(90, 90), diagonal);
    EXPECT_NEAR(other.v, 1, kFloat);
  }
}

TEST(WavePlate, OfHalfAWaveTurnsLinearLightToTheOtherSideOfItsAxis) {
  const Light turned =
      through(wave_plate(180, 20), {kDown, at_angle(0), 1, 1, 0, 0}).in_frame_of(at_angle(40));
  EXPECT_NEAR(turned.q, 1, kFloat);
}

// Quartz of 0.1 mm, with its birefringence relative to air.
TEST(WavePlate, RetardsByBirefringenceAndThickness) {
  const WavePlateMaterial plate{{Curve(1.0)}, WavePlateMaterial::Crystal{1e-4, Curve(0.0092)}, 0};
  const Light diagonal{kDown, at_angle(45), 1, 1, 0, 0};
  for (const double nm : {400.0, 500.0, 700.0}) {
    const double waves = 0.0092 * 1e-4 / (nm * 1e-9);
    EXPECT_NEAR(plate.retardance(nm), 2 * std::numbers::pi * waves, 1e-12);
    EXPECT_NEAR(through(plate, diagonal, nm).in_frame_of(at_angle(45)).q,
                std::cos(2 * std::numbers::pi * waves), 1e-5);
  }
}

TEST(Depolariser, LeavesNothingOfPolarisation) {
  const Light left = through(DepolariserMaterial{{Curve(0.7)}}, through(polariser(0), unpolarised(kDown)));
  EXPECT_NEAR(left.i, 0.35, kFloat);
  EXPECT_EQ(std::hypot(left.q, left.u, left.v), 0);
}

}  // namespace
}  // namespace abbe
