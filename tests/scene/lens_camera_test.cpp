#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "lens/beam.h"
#include "lens/field.h"
#include "lens/spot.h"
#include "lens_cameras.h"
#include "scenes.h"
#include "tests/angles.h"

// A real lens in front of the film gives the results of the lens bench.

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using test::across_mm;
using test::height_mm;
using test::lens_named;
using test::looking_through;
using test::Random;
using test::spread_wavelengths;

TEST(LensCamera, ImageIsUpright) {
  const lens::System lens = lens_named("tessar");
  const Camera camera = looking_through(lens, lens::stop_radius(lens));
  const V3f right = sample_ray(camera, {390, 200}, {0.5F, 0.5F}, SampledSpectrum(550), 0, 0).ray.direction;
  EXPECT_LT(right.x, -0.02F) << "to the right, which is -x";
  const V3f top = sample_ray(camera, {200, 10}, {0.5F, 0.5F}, SampledSpectrum(550), 0, 0).ray.direction;
  EXPECT_GT(top.z, 0.02F) << "upwards";
}

// Mean weight of rays to a film position over jittered pupil points: its irradiance in a uniformly bright
// world.
double irradiance(const Camera& camera, const V2f& film, float nm, int side) {
  Random random(9);
  double sum = 0;
  for (int j = 0; j < side; ++j)
    for (int i = 0; i < side; ++i) {
      const V2f u =
          (V2f(static_cast<float>(i), static_cast<float>(j)) + random.pair()) / static_cast<float>(side);
      sum += static_cast<double>(sample_ray(camera, film, u, SampledSpectrum(nm), 0, 0).weight[0]);
    }
  return sum / side / side;
}

// Sine of the angle at which the image center sees the rim of the stop through the surfaces behind it.
double sine_of_rim(const lens::SpectralSystem& system, double nm) {
  const double depth = system.image_z() - system.last_z();
  double within = 0;
  double far = depth;
  for (int i = 0; i < 50; ++i) {
    const double middle = (within + far) / 2;
    const lens::Ray ray{{0, 0, system.image_z()}, V3d(0, middle, -depth).normalized()};
    const auto at_stop = system.at_stop(ray, nm);
    (at_stop && at_stop->length() < 1 ? within : far) = middle;
  }
  return within / std::hypot(within, depth);
}

// E = pi tau sin^2 U' for radiance 1: pi/4 divided by the squared T-number, measured at the film.
TEST(LensCamera, ExposesByItsStop) {
  for (const char* name : {"double_gauss", "cooke_triplet", "tessar", "achromat"}) {
    const lens::System lens = lens_named(name);
    const double full = lens::stop_radius(lens);
    for (const double share : {1.0, 0.4}) {
      const lens::SystemAt at(lens, 550);
      const auto speed = lens::speed(at, share * full, 128);
      ASSERT_TRUE(speed);
      const Camera camera = looking_through(lens, share * full);
      const auto& system = std::get<LensSystem>(camera.kind).optics->system;
      const double t_stop = 1 / (2 * sine_of_rim(system, 550) * std::sqrt(speed->transmittance));
      EXPECT_NEAR(irradiance(camera, {200, 200}, 550, 160) * 4 * t_stop * t_stop / kPi, 1, 0.001)
          << name << ", " << share;
      EXPECT_NEAR(1 / (2 * sine_of_rim(system, 550)) / speed->working_f_number, 1, 0.01) << name;
    }
  }
}

// A stop in the front focus of the lens behind it, once to the digits of a listing and once to the last bit
// of double. No clear aperture limits the light far off the axis. From f/16 on, spherical aberration changes
// the light at the film center by less than 0.003.
TEST(LensCamera, ExposesByItsTStopWhereItsExitPupilIsFarAway) {
  for (const char* gap : {"99.1597", "99.15966386554621"})
    for (const double f_number : {16.0, 25.0}) {
      const lens::System lens = test::sound_lens_of(fmt::format(
          R"({{"f_number": {}, "focus": "paraxial", "surfaces": [
            {{"stop": true, "thickness": {}}}, [100, 5, 1.5], [-100, 50]]}})",
          f_number, gap));
      const double stop = lens::stop_radius(lens);
      const auto speed = lens::speed(lens::SystemAt(lens, 550), stop, 128);
      ASSERT_TRUE(speed);
      const double told = kPi / (4 * speed->t_stop * speed->t_stop);
      EXPECT_NEAR(irradiance(looking_through(lens, stop), {200, 200}, 550, 160) / told, 1, 0.003)
          << gap << ", f/" << f_number;
    }
}

// The light that the T-stop leaves, if another aperture cuts the beam to half its width. At f/30, spherical
// aberration does not move rays of the film center within the stop.
TEST(LensCamera, ExposesByItsTStopWhereAnApertureCutsTheAxialBeam) {
  lens::System lens = lens_named("landscape");
  const double stop = lens::stop_radius(lens) / 3;
  lens.surfaces.back().semi_aperture_mm = 0.5 * stop;
  const auto speed = lens::speed(lens::SystemAt(lens, 550), stop, 512);
  ASSERT_TRUE(speed);
  EXPECT_GT(speed->t_stop, 1.9 * speed->f_number);
  const Camera camera = looking_through(lens, stop);
  const double sine = sine_of_rim(std::get<LensSystem>(camera.kind).optics->system, 550);
  const double told = kPi * std::pow(sine * speed->f_number / speed->t_stop, 2);
  EXPECT_NEAR(irradiance(camera, {200, 200}, 550, 300) / told, 1, 0.003);
}

TEST(LensCamera, DarkensTowardsTheCornersAsOnTheBench) {
  for (const char* name : {"double_gauss", "cooke_triplet", "tessar"}) {
    const lens::System lens = lens_named(name);
    const double stop = lens::stop_radius(lens);
    const lens::SystemAt at(lens, 550);
    const Camera camera = looking_through(lens, stop, 1200);
    const double axis = irradiance(camera, {600, 600}, 550, 120);
    const auto spot_at = [&](double field) {
      return lens::spot(*lens::Beam::of(at, field, stop), field, 160);
    };
    const lens::Spot on_axis = spot_at(0);
    for (const double field : {5.0, 10.0, 14.0}) {
      const auto chief = lens::chief_ray(at, field, stop);
      const auto expected = lens::relative_illumination(at, field, stop, spot_at(field), on_axis);
      ASSERT_TRUE(chief && expected);
      const auto y = static_cast<float>(600 + chief->height_mm * 1e-3 / camera.pixel_pitch);
      if (!(y < 1200)) continue;
      EXPECT_NEAR(irradiance(camera, {600, y}, 550, 120) / axis / *expected, 1, 0.005)
          << name << ", " << field << " degrees";
    }
  }
}

// Image of a distant point through the whole front of the lens.
struct PointImage {
  V2d centroid{0, 0};
  double rms = 0;
};
PointImage image_of_far_point(const Camera& camera, double angle_deg, int lane) {
  const double angle = angle_deg * kPi / 180;
  const V3d towards(0, -std::cos(angle), std::sin(angle));
  const V3f point(V3d(1, 2, 3) + 1e5 * towards);  // above the axis: light propagates down, the picture is up
  Random random(11);
  double sum = 0;
  V2d first(0, 0);
  double second = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto seen = sample_towards(camera, point, random.pair(), spread_wavelengths(), 0);
    if (!seen || !(seen->weight[lane] > 0)) continue;
    const auto w = static_cast<double>(seen->weight[lane]);
    const V2d at(across_mm(camera, seen->images->x[lane]), height_mm(camera, seen->images->y[lane]));
    sum += w;
    first += w * at;
    second += w * at.length2();
  }
  const V2d centroid = first / sum;
  return {centroid, std::sqrt(second / sum - centroid.length2())};
}

TEST(LensCamera, ImagesAPointAsTheTracedSpot) {
  for (const char* name : {"landscape", "double_gauss"}) {
    const lens::System lens = lens_named(name);
    const double stop = lens::stop_radius(lens);
    const Camera camera = looking_through(lens, stop, 1200);
    for (const double field : {0.0, 8.0})
      for (const int lane : {0, 4, 7}) {
        const lens::SystemAt at(lens, static_cast<double>(spread_wavelengths()[lane]));
        // Light from above the axis propagates downwards.
        const lens::Spot spot = lens::spot(*lens::Beam::of(at, -field, stop), -field, 128);
        const auto size = lens::size_of({&spot, 1});
        ASSERT_TRUE(size);
        const PointImage image = image_of_far_point(camera, field, lane);
        // The picture is inverted. The noise of the centroid is 1/sqrt(20000) of the spot; the margin is 4
        // times that.
        EXPECT_NEAR(image.centroid.y, -size->centroid.y, 0.03 * size->rms_mm + 2e-4)
            << name << ", " << field << " degrees, lane " << lane;
        EXPECT_NEAR(image.centroid.x, 0, 0.03 * size->rms_mm + 2e-4);
        EXPECT_NEAR(image.rms / size->rms_mm, 1, 0.02) << name << ", " << field << " degrees, lane " << lane;
      }
  }
}

TEST(LensCamera, DistortsAndPartsColoursAsItsChiefRays) {
  const lens::System lens = lens_named("landscape");
  const double stop = lens::stop_radius(lens) / 20;  // makes the centroid that of the chief ray
  const Camera camera = looking_through(lens, stop, 1600);
  for (const double field : {4.0, 8.0, 12.0}) {
    std::array<double, 2> seen{};
    std::array<double, 2> traced{};
    for (const int end : {0, 1}) {
      const int lane = end * (kLanes - 1);
      const lens::SystemAt at(lens, static_cast<double>(spread_wavelengths()[lane]));
      const auto chief = lens::chief_ray(at, -field, stop);
      ASSERT_TRUE(chief);
      seen[static_cast<std::size_t>(end)] = image_of_far_point(camera, field, lane).centroid.y;
      traced[static_cast<std::size_t>(end)] = -chief->height_mm;
      EXPECT_NEAR(seen[static_cast<std::size_t>(end)], traced[static_cast<std::size_t>(end)],
                  0.1 * camera.pixel_pitch * 1e3)
          << "a tenth of a pixel, " << field << " degrees";
    }
    const double lateral = traced[1] - traced[0];
    EXPECT_GT(std::abs(lateral), 0.003);
    EXPECT_NEAR((seen[1] - seen[0]) / lateral, 1, 0.05) << "lateral colour, " << field << " degrees";
  }
}

TEST(LensCamera, IsAnEventForPolarisedLight) {
  const lens::System lens = lens_named("achromat");
  Scene scene{};
  scene.camera = looking_through(lens, lens::stop_radius(lens), 20);
  scene.materials = {test::glass()};
  scene.channels.push_back(energy_channel("Y", Curve(1.0)));
  scene.commit();
  EXPECT_FALSE(scene.features.polarisation_relevant);
  scene.lights.push_back(
      {"sky", EnvironmentLight{}, Curve(1.0), LightPolarisation{1, LinearPolarisation{{1, 0, 0}}}});
  scene.commit();
  EXPECT_TRUE(scene.features.polarisation_relevant) << "without shapes";
  scene.lights.clear();
  scene.shapes = {{"pane", Quad{{-1, -1, 2}, {0, 2, 0}, {2, 0, 0}}, 0}};
  scene.commit();
  EXPECT_TRUE(scene.features.polarisation_relevant);
}

// A thick lens has 1/f' = (n - 1)(2/R - (n - 1) t/(n R^2)). Its principal planes are f' (n - 1) t/(n R)
// inside its vertices. The image of an object 150 mm in front is 1/(1/f' - 1/u) behind the second one.
TEST(LensCamera, TellsHowFarItsFilmIsFromThePrincipalPlane) {
  const lens::System lens = test::sound_lens_of(R"({"entrance_pupil": 2, "object_distance": 149,
      "focus": "paraxial", "surfaces": [{"stop": true, "thickness": 1}, [50, 3, 1.5], [-50, 70]]})");
  const double focal_length = 1 / (0.5 * (2 / 50.0 - 0.5 * 3 / (1.5 * 50 * 50)));
  const double within = focal_length * 0.5 * 3 / (1.5 * 50);
  const double object = 150 + within;
  const double image = 1 / (1 / focal_length - 1 / object);
  const CameraTraits told = traits(looking_through(lens, lens::stop_radius(lens)));
  EXPECT_NEAR(*told.image_distance, image * 1e-3, 1e-8);
  EXPECT_NEAR(*told.pinhole_distance, image / object * 149 * 1e-3, 1e-8);
}

// No surface of this lens has a clear aperture, and its entrance pupil is behind the first one.
TEST(LensCamera, TakesInItsRaysWithoutClearApertures) {
  const lens::System lens = lens_named("double_gauss");
  ASSERT_FALSE(lens.surfaces.front().semi_aperture_mm);
  const Camera camera = looking_through(lens, lens::stop_radius(lens));
  const lens::ExitPupil& pupil = std::get<LensSystem>(camera.kind).optics->pupil;
  ASSERT_GT(pupil.entrance().z, 0);
  const Opening opening = traits(camera).opening.value();
  EXPECT_NEAR(std::get<FlatOpening>(opening).u.length(), pupil.front_radius() * 1e-3, 1e-12);
  Random random(7);
  int through = 0;
  float widest = 0;
  for (int i = 0; i < 2000; ++i) {
    const V2f film = random.pair() * 400;
    const CameraRay out = sample_ray(camera, film, random.pair(), SampledSpectrum(550), 0, 0);
    if (!(out.weight[0] > 0)) continue;
    ++through;
    widest = std::max(widest, std::hypot(out.ray.origin.x, out.ray.origin.y));
    const Ray light = ray_at(out.ray.origin + out.ray.direction, -out.ray.direction, 0);
    EXPECT_TRUE(crossing(opening, light)) << film.x << " " << film.y;
  }
  EXPECT_GT(through, 1000);
  EXPECT_LT(pupil.front_radius() * 1e-3, 1.25 * static_cast<double>(widest));
}

TEST(LensCamera, TellsOfItself) {
  const lens::System lens = lens_named("double_gauss");
  const Camera camera = looking_through(lens, lens::stop_radius(lens));
  EXPECT_NEAR(*traits(camera).f_number, 2, 0.01);
  EXPECT_NEAR(*traits(camera).image_distance, 0.1, 0.001);
  EXPECT_TRUE(traits(camera).displaces_wavelengths);
  EXPECT_FALSE(traits(Camera{}).displaces_wavelengths);
  EXPECT_FALSE(sample_towards(camera, {1, 3, 3}, {0.5F, 0.5F}, SampledSpectrum(550), 0)) << "behind";
  Ray back = sample_ray(camera, {200, 200}, {0.5F, 0.5F}, SampledSpectrum(550), 0, 0).ray;
  EXPECT_TRUE(density(camera, back, SampledSpectrum(550)));
  back.direction = -back.direction;
  EXPECT_FALSE(density(camera, back, SampledSpectrum(550)));
}

}  // namespace
}  // namespace abbe
