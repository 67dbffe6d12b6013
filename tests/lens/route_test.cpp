#include "lens/route.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "lens/beam.h"
#include "lens/paraxial.h"
#include "lens/spectral_system.h"
#include "lenses.h"
#include "materials/interface/fresnel.h"
#include "materials/interface/mueller.h"
#include "spectral/stokes.h"
#include "tests/materials/fresnel_amplitudes.h"

// Ghosts: light that surfaces of a lens reflect twice.

namespace abbe::lens {
namespace {

using abbe::test::lens_named;
using Imath::V2d;
using Imath::V3d;

constexpr double kNm = 550;

TEST(Ghosts, AreAllPairsOfSurfacesThatReflect) {
  const System lens = lens_named("double_gauss");
  const std::vector<Ghost> all = ghosts(lens, kNm, kNm);
  EXPECT_EQ(all.size(), 45U) << "of the ten surfaces of glass, not of the stop";
  const SystemAt at(lens, kNm);
  const auto along_normal = [&](std::size_t i) {
    const double r = (at.n[i + 1] - at.n[i]) / (at.n[i + 1] + at.n[i]);
    return r * r;
  };
  for (const Ghost& ghost : all) {
    EXPECT_LT(ghost.second, ghost.first);
    EXPECT_NEAR(ghost.reflectance / (along_normal(ghost.first) * along_normal(ghost.second)), 1, 1e-9);
  }
  EXPECT_TRUE(ghosts(test::double_gauss_of({1, 1, 1, 1}), kNm, kNm).empty()) << "what is like air";
}

TEST(Ghosts, OfACoatedSurfaceHaveTheReflectanceOfItsCoating) {
  System lens = lens_named("landscape");
  const SystemAt bare(lens, kNm);
  const std::size_t front = lens.surfaces[0].behind ? 0 : 1;
  const double glass = bare.n[front + 1];
  lens.surfaces[front].coating = {{{"film", RefractiveIndex(std::sqrt(glass))}},
                                  {{0, kNm / 4 / std::sqrt(glass)}}};
  const std::vector<Ghost> all = ghosts(lens, kNm, kNm);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_LT(all[0].reflectance, 1e-8) << "a quarter wave of the root of the index reflects nothing";
  EXPECT_GT(ghosts(lens, 400, 700)[0].reflectance, 1e-6);
}

TEST(Ghosts, GoThroughTheLensTheSameWayBackwards) {
  for (const char* name : {"tessar", "fisheye"}) {
    const System lens = lens_named(name);
    const SpectralSystem system(lens, stop_radius(lens));
    std::mt19937 numbers(5);
    const auto uniform = [&](double reach) { return std::uniform_real_distribution(-reach, reach)(numbers); };
    const std::vector<Ghost> of = ghosts(lens, kNm, kNm);
    std::size_t seen = 0;  // ghosts with at least one passing ray
    for (const Ghost& ghost : of) {
      const Route route = route_of(ghost, lens.surfaces.size());
      int passed = 0;
      for (int i = 0; i < 800; ++i) {
        const V3d film(uniform(5), uniform(5), system.image_z());
        const double reach = 0.9 * system.stop_radius_mm();
        const V3d to(uniform(reach), uniform(reach), system.last_z());
        const auto out = system.to_object({film, (to - film).normalized()}, kNm, route);
        if (!out) continue;
        const auto back = system.to_image({out->origin, -out->direction}, kNm, route);
        ASSERT_TRUE(back) << name;
        ++passed;
        EXPECT_NEAR(back->point.x, film.x, 1e-7) << name << ' ' << ghost.second << ' ' << ghost.first;
        EXPECT_NEAR(back->point.y, film.y, 1e-7);
        EXPECT_GT(back->transmittance, 0);
      }
      seen += passed > 0;
    }
    EXPECT_GT(seen, of.size() * 9 / 10) << name;
  }
}

// A stop with a plate behind it.
System stop_and_plate(double n, double thickness_mm) {
  System lens;
  lens.surfaces.resize(3);
  lens.surfaces[0].thickness_mm = 5;
  lens.surfaces[0].semi_aperture_mm = 10;
  lens.surfaces[1].thickness_mm = thickness_mm;
  lens.surfaces[1].behind = Glass{"glass", RefractiveIndex(n)};
  lens.surfaces[2].thickness_mm = 40;
  return lens;
}

// A plane plate does not mix s and p: each has the factor T^2 R^2, and leaves 2 d tan(t) farther along the
// plate.
TEST(Ghosts, OfAPlateHavePowerAndPlaceInClosedForm) {
  const double n = 1.9;
  const double thickness = 3;
  const SpectralSystem system(stop_and_plate(n, thickness), 10);
  const Route route = route_of({2, 1, 0}, 3);
  for (const double angle : {0.0, 0.3, 0.9, 1.3}) {
    const V3d direction(std::sin(angle) * 0.6, std::sin(angle) * 0.8, std::cos(angle));
    const Ray ray{{0.1, 0.2, 0}, direction};
    const auto image = system.to_image(ray, kNm);
    const auto ghost = system.to_image(ray, kNm, route);
    ASSERT_TRUE(image && ghost);
    const auto of = fresnel_dielectric<double>(std::cos(angle), n);
    EXPECT_NEAR(image->transmittance, (of.Ts * of.Ts + of.Tp * of.Tp) / 2, 1e-12);
    EXPECT_NEAR(ghost->transmittance, (std::pow(of.Ts * of.Rs, 2) + std::pow(of.Tp * of.Rp, 2)) / 2, 1e-12);
    const double further = 2 * thickness * std::sin(angle) / n / of.cos_t;
    EXPECT_NEAR(ghost->point.x - image->point.x, 0.6 * further, 1e-10);
    EXPECT_NEAR(ghost->point.y - image->point.y, 0.8 * further, 1e-10);
  }
}

// Airy's sum for a film between two media, with angles from Snell's law, is the same from both sides.
double film_reflectance(const std::array<double, 3>& n, double thickness_nm, double sine, bool p) {
  std::array<double, 3> cosine{};
  for (std::size_t i = 0; i < 3; ++i) cosine[i] = std::sqrt(1 - std::pow(sine / n[i], 2));
  const auto amplitude = [&](std::size_t i, std::size_t j) {
    const double a = p ? n[j] * cosine[i] : n[i] * cosine[i];
    const double b = p ? n[i] * cosine[j] : n[j] * cosine[j];
    return (a - b) / (a + b);
  };
  const auto turn = std::polar(1.0, 4 * std::numbers::pi * n[1] * thickness_nm * cosine[1] / kNm);
  const double first = amplitude(0, 1);
  const double second = amplitude(1, 2);
  return std::norm((first + second * turn) / (1.0 + first * second * turn));
}

TEST(Ghosts, OfACoatedPlateHavePowerInClosedForm) {
  const double n = 1.9;
  System lens = stop_and_plate(n, 3);
  lens.surfaces[1].coating = {{{"film", RefractiveIndex(1.38)}}, {{0, 80}}};
  lens.surfaces[2].coating = lens.surfaces[1].coating;
  const SpectralSystem system(lens, 10);
  for (const double angle : {0.0, 0.6, 1.1}) {
    const Ray ray{{0, 0, 0}, {std::sin(angle), 0, std::cos(angle)}};
    double image = 0;
    double ghost = 0;
    for (const bool p : {false, true}) {
      const double R = film_reflectance({1, 1.38, n}, 80, std::sin(angle), p);
      image += (1 - R) * (1 - R) / 2;
      ghost += std::pow((1 - R) * R, 2) / 2;
    }
    const auto left = [&](const Route& by) { return system.to_image(ray, kNm, by).value().transmittance; };
    EXPECT_NEAR(left(system.direct()), image, 1e-9) << angle;
    EXPECT_NEAR(left(route_of({2, 1, 0}, 3)), ghost, 1e-9) << angle;
  }
}

// A ghost crosses the plate three times, the image once.
TEST(Ghosts, AreAbsorbedOnTheirWholeWay) {
  const double thickness = 3;
  const double extinction = 5e-6;
  System lens = stop_and_plate(1.9, thickness);
  const SpectralSystem clear(lens, 10);
  lens.surfaces[1].behind->index = RefractiveIndex(1.9, extinction);
  const SpectralSystem grey(lens, 10);
  const Route route = route_of({2, 1, 0}, 3);
  const double angle = 0.7;
  const Ray ray{{0, 0, 0}, {std::sin(angle), 0, std::cos(angle)}};
  const auto left = [&](const Route& by) {
    return grey.to_image(ray, kNm, by).value().transmittance /
           clear.to_image(ray, kNm, by).value().transmittance;
  };
  const double through = thickness / std::sqrt(1 - std::pow(std::sin(angle) / 1.9, 2));
  const double depth = 4 * std::numbers::pi * extinction / (kNm * 1e-6) * through;
  EXPECT_NEAR(std::log(left(grey.direct())), -depth, 1e-6);
  EXPECT_NEAR(std::log(left(route)), -3 * depth, 1e-6);
}

// A thin lens of power 1/f focuses light reflected twice inside it at f (n - 1)/(3 n - 1).
TEST(Ghosts, OfAThinLensHaveItsFocus) {
  const double n = 1.6;
  const double focal_length = 80;
  const double curvature = 1 / (focal_length * (n - 1)) / 2;
  System lens;
  lens.surfaces.resize(2);
  lens.surfaces[0].profile.curvature = curvature;
  lens.surfaces[0].thickness_mm = 1e-6;
  lens.surfaces[0].behind = Glass{"glass", RefractiveIndex(n)};
  lens.surfaces[1].profile.curvature = -curvature;
  lens.surfaces[1].thickness_mm = focal_length;
  const SystemAt at(lens, kNm);
  const Ghost ghost{1, 0, 0};
  lens.surfaces[0].semi_aperture_mm = 2;
  const double focus = ghost_focus(at, ghost, 3).image_distance_mm;
  EXPECT_NEAR(focus / (focal_length * (n - 1) / (3 * n - 1)), 1, 1e-6);
  EXPECT_NEAR(ghost_focus(at, ghost, 3).diameter_mm, 2 * 2 * ((3 * n - 1) / (n - 1) - 1), 1e-4);
  lens.object_distance_mm = 100;
  const double near = ghost_focus(SystemAt(lens, kNm), ghost, 3).image_distance_mm;
  EXPECT_NEAR(1 / near, 1 / focus - 1 / 100.0, 1e-6);
}

TEST(Ghosts, OfRaysNearTheAxisMeetWhereParaxialOpticsSays) {
  const System lens = lens_named("tessar");
  const SpectralSystem system(lens, stop_radius(lens));
  const SystemAt at(lens, kNm);
  for (const Ghost& ghost : ghosts(lens, kNm, kNm)) {
    const Route route = route_of(ghost, lens.surfaces.size());
    const auto arrival = system.to_image({{0, 1e-3, -1}, {0, 0, 1}}, kNm, route);
    ASSERT_TRUE(arrival);
    const double slope = arrival->direction.y / arrival->direction.z;
    const double crosses = system.image_z() - arrival->point.y / slope - system.last_z();
    EXPECT_NEAR(ghost_focus(at, ghost, 1).image_distance_mm / crosses, 1, 1e-4)
        << ghost.first << ' ' << ghost.second;
  }
}

// The part of a small beam that the stop transmits, wherever the ghost passes it, forms a disc of that
// diameter.
TEST(Ghosts, EndAtTheStopOnTheirOwnWay) {
  System lens = lens_named("double_gauss");
  const double stop = 0.01;
  const SpectralSystem system(lens, stop);
  const SystemAt at(lens, kNm);
  int threefold = 0;
  for (const Ghost& ghost : ghosts(lens, kNm, kNm)) {
    const Route route = route_of(ghost, lens.surfaces.size());
    double highest = 0;
    constexpr int kRays = 4000;
    for (int i = 1; i <= kRays; ++i) {
      const auto arrival = system.to_image({{0, 0.1 * i / kRays, -1}, {0, 0, 1}}, kNm, route);
      if (arrival) highest = std::max(highest, std::abs(arrival->point.y));
    }
    EXPECT_NEAR(2 * highest / ghost_focus(at, ghost, stop).diameter_mm, 1, 0.01)
        << ghost.first << ' ' << ghost.second;
    threefold += ghost.first > lens.stop && ghost.second < lens.stop;
  }
  EXPECT_GT(threefold, 10);
}

// Two surfaces of equal indices reflect nothing at the wavelengths where they are equal.
TEST(Ghosts, OfEqualIndicesAreNone) {
  System lens = stop_and_plate(1.5, 3);
  lens.surfaces[2].behind = Glass{"like", RefractiveIndex(1.5)};
  const SpectralSystem system(lens, 10);
  const Ray ray{{0, 0, 0}, V3d(0.2, 0.1, 1).normalized()};
  const auto image = system.to_image(ray, kNm);
  const auto ghost = system.to_image(ray, kNm, route_of({2, 1, 0}, 3));
  ASSERT_TRUE(image && ghost);
  EXPECT_GT(image->transmittance, 0.9);
  EXPECT_EQ(ghost->transmittance, 0);
}

// Mueller matrices about the normal of each plane of incidence, one axis at a time.
class MuellerChain {
 public:
  MuellerChain(const V3d& axis, const StokesSpectrum& light) : axis_(axis), light_(light) {}
  void turn_to(const V3d& axis, const V3d& travels) {
    const double cosine = axis_.dot(axis);
    const double sine = travels.cross(axis_).dot(axis);
    light_ = turned(light_, static_cast<float>(cosine * cosine - sine * sine),
                    static_cast<float>(2 * sine * cosine));
    axis_ = axis;
  }
  void pass(const MuellerElements<double>& m, double power) {
    const auto by = [](const SampledSpectrum& s, double x) { return s * static_cast<float>(x); };
    const StokesSpectrum& l = light_;
    light_ = {by(l.i + by(l.q, m.d), power), by(by(l.i, m.d) + by(l.q, m.p), power),
              by(by(l.u, m.c) - by(l.v, m.s), power), by(by(l.u, m.s) + by(l.v, m.c), power)};
  }
  [[nodiscard]] const StokesSpectrum& light() const { return light_; }

 private:
  V3d axis_;
  StokesSpectrum light_;
};

// At normal incidence both fields are reversed alike. At other angles s and p follow Fresnel's amplitudes, on
// both sides of Brewster's angle.
TEST(Ghosts, ReflectedFieldsHaveFresnelsSigns) {
  const double n = 1.7;
  const System lens = stop_and_plate(n, 3);
  const SystemAt at(lens, kNm);
  const SurfaceBetween<double> front{at.surface(1), at.frames[1], 1, n};
  for (const double angle : {1e-4, 0.5, 0.9, 1.2, 1.5}) {  // Brewster's angle is 1.04
    const V3d from(std::sin(angle) * 0.6, std::sin(angle) * 0.8, std::cos(angle));
    const Crossing<double> crossing = reflect(front, Ray{{0, 0, 0}, from}, true);
    EXPECT_NEAR(crossing.hit.direction.z, -from.z, 1e-12);
    UnpolarisedFields<double> light(from);
    const V3d first = light.first();
    const V3d second = light.second();
    light.apply(front, kNm, from, crossing.hit, {true, true});
    const V3d s(0.8, -0.6, 0);
    const V3d p = s.cross(from);
    const V3d p_behind = s.cross(crossing.hit.direction);
    const FresnelAmplitudes of = fresnel_amplitudes(std::cos(angle), n);
    const double ratio = std::real(of.rp / of.rs);
    const double along_s = first.dot(s) * std::abs(of.rs);
    EXPECT_NEAR(std::abs(light.first().dot(s)), std::abs(along_s), 1e-9);
    const double sign = light.first().dot(s) / along_s;
    EXPECT_NEAR(light.first().dot(p_behind) * sign, first.dot(p) * ratio * std::abs(of.rs), 1e-9) << angle;
    EXPECT_NEAR(light.second().dot(p_behind) * sign, second.dot(p) * ratio * std::abs(of.rs), 1e-9) << angle;
  }
}

// The fields along both axes determine the effect of all surfaces' matrices on any polarisation.
TEST(Ghosts, AndTheImageArePolarisedByEverySurface) {
  System lens = lens_named("tessar");
  lens.surfaces[0].decenter_mm = {0.4, -0.3};
  const SpectralSystem system(lens, stop_radius(lens));
  const SystemAt at(lens, kNm);
  std::vector<Route> routes{system.direct()};
  for (const Ghost& ghost : ghosts(lens, kNm, kNm)) routes.push_back(route_of(ghost, lens.surfaces.size()));
  std::mt19937 numbers(8);
  const auto uniform = [&](double reach) { return std::uniform_real_distribution(-reach, reach)(numbers); };
  int compared = 0;
  double strongest = 0;
  for (const Route& route : routes)
    for (int i = 0; i < 60; ++i) {
      const Ray start{{uniform(12), uniform(12), -3}, V3d(uniform(0.4), uniform(0.4), 1).normalized()};
      const auto arrival = system.to_image(start, kNm, route);
      if (!arrival) continue;
      const V3d& first = arrival->first;
      const V3d& second = arrival->second;
      const V3d& out = arrival->direction;
      const V3d x = V3d(0, 1, 0).cross(out).normalized();
      const V3d y = out.cross(x);
      const double turn = uniform(3);
      const double cosine = std::cos(turn);
      const double sine = std::sin(turn);
      const V3d field = first * cosine + second * sine;  // for linearly polarised light

      const V3d axis = UnpolarisedFields<double>(start.direction).first();
      MuellerChain chain(axis,
                         {SampledSpectrum(1.0F), SampledSpectrum(static_cast<float>(std::cos(2 * turn))),
                          SampledSpectrum(static_cast<float>(std::sin(2 * turn))), SampledSpectrum()});
      Ray ray = start;
      for (const auto& [k, how] : route) {
        const SurfaceBetween<double> between{at.surface(k), at.frames[k], at.n[k], at.n[k + 1]};
        const Crossing<double> crossing = how.reflects   ? reflect(between, ray, how.forwards)
                                          : how.forwards ? cross(between, ray)
                                                         : cross_back(between, ray);
        const double cos_i = std::abs(ray.direction.dot(crossing.hit.normal));
        const double eta = how.forwards ? at.n[k + 1] / at.n[k] : at.n[k] / at.n[k + 1];
        const V3d s = ray.direction.cross(crossing.hit.normal).normalized();
        const auto power = fresnel_dielectric<double>(cos_i, eta);
        chain.turn_to(s, ray.direction);
        if (eta != 1)
          how.reflects ? chain.pass(reflection_mueller(cos_i, eta, 0.0), power.R())
                       : chain.pass(refraction_mueller(cos_i, eta), power.transmitted());
        ray = {crossing.hit.point, crossing.hit.direction};
      }
      chain.turn_to(x, out);
      const auto told = [](const SampledSpectrum& s) { return static_cast<double>(s[0]); };
      const double power = field.length2();
      ++compared;
      EXPECT_NEAR(told(chain.light().i) / power, 1, 2e-5);
      EXPECT_NEAR(told(chain.light().q) / power,
                  (std::pow(field.dot(x), 2) - std::pow(field.dot(y), 2)) / power, 2e-5);
      EXPECT_NEAR(told(chain.light().u) / power, 2 * field.dot(x) * field.dot(y) / power, 2e-5);
      EXPECT_NEAR(told(chain.light().v) / power, 0, 2e-5);
      strongest = std::max(strongest, std::abs(power / (first.length2() + second.length2()) * 2 - 1));
    }
  EXPECT_GT(compared, 300);
  EXPECT_GT(strongest, 0.1) << "something to tell apart";
}

}  // namespace
}  // namespace abbe::lens
