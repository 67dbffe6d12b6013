#include <gtest/gtest.h>

#include "scenes.h"
#include "tests/angles.h"
#include "tests/scene/cameras.h"
#include "tests/scene/solid_angle.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using test::bladed_lens;
using test::disc_meter;
using test::frame;
using test::kWavelengths;
using test::lens;
using test::meter;
using test::narrow_pinhole;
using test::point_meter;
using test::Random;
using test::ray_of;
using test::solid_angle;
using test::sphere_meter;
using test::turned_lens;
using test::wide_lens;
using test::wide_pinhole;

std::optional<CameraConnection> connection(const Camera& camera, const V3f& point, V2f u) {
  return sample_towards(camera, point, u, kWavelengths, 0.25F);
}

TEST(Camera, ImageIsUpright) {
  const CameraRay center = ray_of(narrow_pinhole(), {3, 2}, {0, 0});
  EXPECT_EQ(center.ray.origin, V3f(1, 2, 3));
  EXPECT_EQ(center.ray.direction, V3f(0, -1, 0));
  EXPECT_EQ(center.cos_film, 1);
  const V3f right_edge = ray_of(narrow_pinhole(), {6, 2}, {0, 0}).ray.direction;
  EXPECT_NEAR(right_edge.x / right_edge.y, 0.015 / 0.05, 1e-6) << "3 pixels of 5 mm at 50 mm, to the right";
  const V3f top_edge = ray_of(narrow_pinhole(), {3, 0}, {0, 0}).ray.direction;
  EXPECT_NEAR(top_edge.z / -top_edge.y, 0.010 / 0.05, 1e-6) << "upwards";
}

// Expects `film_right` to point to the right of the image. With the direction of the light it determines up.
void expect_right_is_right(const Camera& camera, float time) {
  const auto right = film_right(camera, time);
  ASSERT_TRUE(right);
  EXPECT_NEAR(right->length(), 1, 1e-6F);
  const auto looks = [&](V2f film) {
    return sample_ray(camera, film, {0.5F, 0.5F}, kWavelengths, 0, time).ray.direction;
  };
  EXPECT_NEAR((looks({6, 2}) - looks({0, 2})).normalized().dot(*right), 1, 1e-6F);
  const V3f up = (-looks({3, 2})).cross(*right);
  EXPECT_NEAR((looks({3, 0}) - looks({3, 4})).normalized().dot(up), 1, 1e-6F);
}

TEST(Camera, TellsTheRightOfItsPicture) {
  expect_right_is_right(narrow_pinhole(), 0);
  expect_right_is_right(wide_lens(), 0);
  Camera turning = narrow_pinhole();
  turning.motion = std::make_shared<const Motion>(
      std::vector<Motion::Keyframe>{{0, {0, 1, 0}, 0, {0, 0, 0}}, {1, {0, 1, 0}, 1.2, {0, 0, 0}}});
  for (const float time : {0.0F, 0.5F, 1.0F}) expect_right_is_right(turning, time);
  EXPECT_GT((*film_right(turning, 1) - *film_right(turning, 0)).length(), 1);
  EXPECT_FALSE(film_right(meter(), 0));
}

TEST(Camera, ExposureIsThatOfTheLensFormula) {
  // For focus at infinity: E = pi L cos^4 / (4 N^2).
  const double n = 4;
  const Camera camera{ThinLens{frame(), 0.05, INFINITY, 0.05 / (2 * n)}, 6, 4, 0.005};
  EXPECT_NEAR(static_cast<double>(ray_of(camera, {3, 2}, {0.3F, 0.9F}).weight[0]), kPi / (4 * n * n), 1e-8);
  const double cosine = 1 / std::hypot(1, 0.015 / 0.05);
  const CameraRay edge = ray_of(camera, {6, 2}, {0.5F, 0.5F});
  EXPECT_NEAR(static_cast<double>(edge.weight[0]), kPi / (4 * n * n) * std::pow(cosine, 4), 1e-8);
  EXPECT_NEAR(static_cast<double>(edge.cos_film), cosine, 1e-6);
  EXPECT_NEAR(static_cast<double>(ray_of(narrow_pinhole(), {6, 2}, {0, 0}).weight[0]),
              kPi / 64 * std::pow(cosine, 4), 1e-7)
      << "a pinhole exposes as its nominal aperture would";
}

TEST(Camera, RaysOfAFilmPointMeetInThePlaneInFocus) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const V2f film(6 * random.uniform(), 4 * random.uniform());
    const auto at_focus = [&](V2f u) {
      const Ray ray = ray_of(lens(), film, u).ray;
      return V3d(ray.origin) + V3d(ray.direction) * ((1.5 - static_cast<double>(ray.origin.y)) /
                                                     static_cast<double>(ray.direction.y));
    };
    const V3d a = at_focus(random.pair());
    const V3d b = at_focus(random.pair());
    EXPECT_LT((a - b).length(), 1e-6);
  }
}

// With a narrow opening the ray is straight from the film to the lens.
TEST(Camera, FilmCosineIsThatOfTheRayInsideTheCamera) {
  // The right edge of the picture is on the left of the film, which is behind the lens.
  const double opening = 0.0005;
  const Camera narrow{ThinLens{frame(), 1 / (1 / 0.05 - 1 / 0.5), 0.5, opening}, 6, 4, 0.005};
  const V3d film_point = V3d(1, 2, 3) + V3d(1, 0, 0) * 0.015 + V3d(0, 1, 0) * *traits(narrow).image_distance;
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const CameraRay start = ray_of(narrow, {6, 2}, random.pair());
    const V3d inside = (V3d(start.ray.origin) - film_point).normalized();
    EXPECT_NEAR(static_cast<double>(start.cos_film), -inside.y, 2e-5);
  }
}

// On the axis the exposure is E = pi sin^2 U', where U' is the half-angle of the cone of light on the film,
// up to f/0.5, which fills the hemisphere. Light of a uniform scene is uniform in the cone's projected solid
// angle.
TEST(Camera, ExposesByTheConeOfLightOnItsFilm) {
  constexpr int kSide = 200;
  const double focal_length = 0.05;
  for (const double n : {0.5, 0.7, 1.0, 1.4, 8.0})
    for (const double s : {static_cast<double>(INFINITY), 0.5, 0.1}) {
      const double v = focal_length / (1 - focal_length / s);
      const Camera camera{ThinLens{frame(), v, s, focal_length / (2 * n)}, 6, 4, 0.005};
      double exposure = 0;
      double largest = 0;  // sin^2 of the angle on the film
      double mean = 0;
      for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
          const V2f u((static_cast<float>(i) + 0.5F) / kSide, (static_cast<float>(j) + 0.5F) / kSide);
          const CameraRay start = ray_of(camera, {3, 2}, u);
          const auto weight = static_cast<double>(start.weight[0]);
          const double sine2 = 1 - std::pow(static_cast<double>(start.cos_film), 2);
          exposure += weight / (kSide * kSide);
          mean += weight * sine2 / (kSide * kSide);
          largest = std::max(largest, sine2);
        }
      EXPECT_LT(exposure, kPi * 1.00001) << n << ' ' << s;
      EXPECT_NEAR(exposure / (kPi * largest), 1, 0.012) << n << ' ' << s << ": the grid ends before the rim";
      EXPECT_NEAR(mean / exposure / largest, 0.5, 0.006) << n << ' ' << s;
      if (s > 1) {
        EXPECT_NEAR(exposure, kPi / (4 * n * n), 1e-6) << n;
      }
    }
}

// No light arrives at a larger angle than the bound that limits the wavelengths.
TEST(Camera, FilmAnglesStayWithinTheirBound) {
  Random random(11);
  for (const Camera& camera :
       {narrow_pinhole(), wide_pinhole(), lens(), bladed_lens(), turned_lens(), wide_lens()}) {
    const double least = min_film_cosine(camera);
    double found = 1;
    for (int i = 0; i < 20000; ++i) {
      const V2f film(i % 2 == 0 ? 0 : 6 * random.uniform(), i % 2 == 0 ? 0 : 4 * random.uniform());
      found = std::min(found, static_cast<double>(ray_of(camera, film, random.pair()).cos_film));
    }
    EXPECT_GE(found, least);
  }
}

TEST(Camera, LensPointsFillTheAperture) {
  Random random(2);
  double mean_square = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const double r = (V3d(ray_of(lens(), {3, 2}, random.pair()).ray.origin) - V3d(1, 2, 3)).length();
    EXPECT_LE(r, 0.0125 * 1.0001);
    mean_square += r * r / kCount;
  }
  EXPECT_NEAR(mean_square / (0.0125 * 0.0125), 0.5, 0.01);
}

// The camera looks along -y, so that right is -x: a corner at the clockwise angle c is at (-sin c, cos c) in
// x and z. Light rays can hit the opening exactly where camera rays leave it.
TEST(Camera, BladesLeaveAPolygonOfTheAperture) {
  const Camera camera = bladed_lens();
  const Opening opening = traits(camera).opening.value();
  const lens::Iris iris(5, 0);
  Random random(12);
  double highest = 0;
  for (int i = 0; i < 20000; ++i) {
    const V3d from = V3d(ray_of(camera, {3, 2}, random.pair()).ray.origin) - V3d(1, 2, 3);
    EXPECT_TRUE(iris.contains(Imath::V2d(-from.x, from.z) * (0.9999 / 0.0125)));
    highest = std::max(highest, from.z / 0.0125);
  }
  EXPECT_GT(highest, 0.97) << "a corner is up";
  int within = 0;
  constexpr int kSide = 400;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const Imath::V2d point((2 * i + 1.0) / kSide - 1, (2 * j + 1.0) / kSide - 1);
      const V3f at(V3d(1 - point.x * 0.0125, 1, 3 + point.y * 0.0125));
      const bool crossed = crossing(opening, {at, {0, 1, 0}}).has_value();
      EXPECT_TRUE(!crossed || point.length() < 1 + 1e-3);
      within += crossed;
    }
  EXPECT_NEAR(4.0 * within / kSide / kSide / kPi, iris.area_fraction(), 0.002);
}

// Rounding at the edge still gives the last pixel.
TEST(Camera, EdgesOfMetersAreOnTheirFilm) {
  const Camera meter{IrradianceProbe{Quad{{0, 0, 0}, {0.9, 0, 0}, {0, 0.7, 0}}}, 48, 64, 1};
  const Ray light{{0.9F, 0.7F, 1}, {0, 0, -1}};
  const auto seen = connection_through(meter, traits(meter).opening.value(), light, SampledSpectrum(550));
  ASSERT_TRUE(seen);
  EXPECT_EQ(static_cast<int>(seen->film.x), 47);
  EXPECT_EQ(static_cast<int>(seen->film.y), 63);
  EXPECT_GT(seen->lens_point.z, 0) << "off what the meter lies on";
}

// From outside and inside, to the near side and the far one.
TEST(Camera, RaysComeToTheSideOfASphereThatTakesThem) {
  const SphereSide out{{{1, 0, 0}, 2}, false};
  const SphereSide in{{{1, 0, 0}, 2}, true};
  const Ray outside{{-9, 0, 0}, {1, 0, 0}};
  const Ray inside{{0, 0, 0}, {1, 0, 0}};
  EXPECT_NEAR(crossing(out, outside).value(), 8, 1e-9);
  EXPECT_NEAR(crossing(in, outside).value(), 12, 1e-9);
  EXPECT_FALSE(crossing(out, inside));
  EXPECT_NEAR(crossing(in, inside).value(), 3, 1e-9);
  for (const SphereSide& side : {out, in}) {
    EXPECT_FALSE(crossing(side, Ray{{9, 0, 0}, {1, 0, 0}})) << "behind";
    EXPECT_FALSE(crossing(side, Ray{{-9, 2.1F, 0}, {1, 0, 0}})) << "beside";
  }
}

TEST(Camera, ConnectionsAreTheReverseOfRays) {
  Random random(3);
  for (const Camera& camera : {narrow_pinhole(), lens(), bladed_lens(), turned_lens()})
    for (int i = 0; i < 10000; ++i) {
      const V2f film(6 * random.uniform(), 4 * random.uniform());
      const V2f u = random.pair();
      const CameraRay start = ray_of(camera, film, u);
      const auto d = static_cast<float>(random.between(0.1, 5));
      const auto back = connection(camera, start.ray.origin + start.ray.direction * d, u);
      if (!back) {
        EXPECT_LT(std::min({film.x, film.y, 6 - film.x, 4 - film.y}), 1e-3F);
        continue;
      }
      EXPECT_LT((back->film - film).length(), 1e-3F);
      EXPECT_LT((back->lens_point - start.ray.origin).length(), 1e-6F);
      EXPECT_NEAR(back->cos_film, start.cos_film, 1e-5);
      // Both weights belong to the same lens element and pixel: one is per film area, one per solid angle.
      const double cosine = -static_cast<double>(start.ray.direction.y);
      const double film_per_sr = std::pow(*traits(camera).image_distance, 2) / std::pow(cosine, 3);
      EXPECT_NEAR(static_cast<double>(back->weight[0]) * d * d * camera.pixel_pitch * camera.pixel_pitch /
                      (static_cast<double>(start.weight[0]) * film_per_sr),
                  1, 1e-4);
    }
}

TEST(Camera, NothingBehindOrBesideIsImaged) {
  EXPECT_FALSE(connection(narrow_pinhole(), {1, 3, 3}, {0, 0})) << "behind";
  EXPECT_FALSE(connection(narrow_pinhole(), {1, 2, 4}, {0, 0})) << "in the plane of the lens";
  EXPECT_FALSE(connection(narrow_pinhole(), {0.5F, 1, 3}, {0, 0})) << "beyond the right edge";
  EXPECT_TRUE(connection(narrow_pinhole(), {0.75F, 1, 3}, {0, 0}));
  const Camera probe{IrradianceProbe{Quad{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, 1, 1, 1};
  EXPECT_FALSE(connection(probe, {0, 0, 1}, {0, 0}));
}

// Irradiance of each pixel by a Lambertian patch of radiance 1, from the film and from the patch.
using Film = std::array<double, 24>;
struct Estimate {
  Film mean{};
  Film square{};
  void add(std::size_t pixel, double value) {
    mean[pixel] += value;
    square[pixel] += value * value;
  }
};

TEST(Camera, BothWaysCollectTheSameEnergy) {
  const Disc patch{{1.04, 0.6, 2.98}, V3d(0.3, 1, 0.2).normalized(), 0.2};
  constexpr int kCount = 400000;
  for (const Camera& camera : {narrow_pinhole(), lens(), bladed_lens()}) {
    Random random(4);
    Estimate film_to_patch;
    Estimate patch_to_film;
    for (int i = 0; i < kCount; ++i) {
      const V2f film(6 * random.uniform(), 4 * random.uniform());
      const CameraRay start = ray_of(camera, film, random.pair());
      const std::size_t pixel = static_cast<std::size_t>(film.y) * 6 + static_cast<std::size_t>(film.x);
      if (intersect<float>(patch, start.ray, 0))
        film_to_patch.add(pixel, 24 * static_cast<double>(start.weight[0]));

      const SurfacePoint at = sample_area(patch, {}, random.pair());
      const auto back = connection(camera, at.point, random.pair());
      if (!back) continue;
      const double cosine =
          std::max(0.0, static_cast<double>(at.normal.dot((back->lens_point - at.point).normalized())));
      patch_to_film.add(static_cast<std::size_t>(back->film.y) * 6 + static_cast<std::size_t>(back->film.x),
                        static_cast<double>(back->weight[0]) * cosine * area(patch));
    }
    int lit = 0;
    for (std::size_t p = 0; p < 24; ++p) {
      const double a = film_to_patch.mean[p] / kCount;
      const double b = patch_to_film.mean[p] / kCount;
      const double variance = (film_to_patch.square[p] + patch_to_film.square[p]) / kCount / kCount;
      EXPECT_NEAR(a, b, 5 * std::sqrt(variance) + 1e-12) << "pixel " << p;
      lit += b > 1e-3;
    }
    EXPECT_GE(lit, 4);
  }
}

// Rounding of the cosine on the film when a ray is evaluated again: that of the direction. Through a lens it
// also includes that of the lens point, 1.2e-7 m per axis at coordinates of 2 to 4 m, divided by the image
// distance.
double film_cosine_rounding(const Camera& camera, const CameraRay& ray) {
  constexpr double kDirection = 1e-5;
  const CameraTraits of = traits(camera);
  if (!of.depth_of_field) return kDirection;
  const auto cosine = static_cast<double>(ray.cos_film);
  const double sine = std::sqrt(1 - cosine * cosine);
  return kDirection + std::sqrt(2.0) * 1.2e-7 / of.image_distance.value() * sine / cosine;
}

TEST(Camera, DensitiesGiveTheWeightsOfBothWays) {
  Random random(7);
  for (const Camera& camera : {narrow_pinhole(), wide_pinhole(), lens(), bladed_lens(), turned_lens(),
                               wide_lens(), meter(), disc_meter(), sphere_meter(), point_meter()})
    for (int i = 0; i < 10000; ++i) {
      const V2f film(static_cast<float>(camera.width) * random.uniform(),
                     static_cast<float>(camera.height) * random.uniform());
      const V2f u = random.pair();
      const CameraRay start = ray_of(camera, film, u);
      const auto of = density(camera, start.ray, kWavelengths);
      if (!of) {
        const V2f last(static_cast<float>(camera.width), static_cast<float>(camera.height));
        EXPECT_LT(std::min({film.x, film.y, last.x - film.x, last.y - film.y}), 1e-3F);
        continue;
      }
      EXPECT_NEAR(of->cos_film, start.cos_film, film_cosine_rounding(camera, start));
      const double flux = static_cast<double>(of->importance[3] / of->pdf_position * of->cos_theta);
      EXPECT_NEAR(flux / static_cast<double>(of->pdf_direction[3] * start.weight[3]), 1, 1e-5);
      if (camera.kind.index() != point_meter().kind.index()) {
        const auto d = static_cast<float>(random.between(0.1, 5));
        const auto back = connection(camera, start.ray.origin + start.ray.direction * d, u);
        EXPECT_LT((of->film - film).length(), 2e-3F);
        ASSERT_TRUE(back);
        EXPECT_NEAR(flux / (d * d) / static_cast<double>(back->weight[3]), 1, 1e-4);
      } else if (of->pdf_position != 1) {
        EXPECT_LT((of->film - film).length(), 2e-3F);
      }
    }
}

TEST(Camera, DensitiesCountPointsByAreaUnlessThereIsOne) {
  const auto pdf_position = [](const Camera& camera) {
    return static_cast<double>(
        density(camera, ray_of(camera, {1, 1}, {0.5F, 0.5F}).ray, kWavelengths)->pdf_position);
  };
  EXPECT_EQ(pdf_position(narrow_pinhole()), 1);
  EXPECT_EQ(pdf_position(point_meter()), 1);
  EXPECT_NEAR(pdf_position(lens()) * kPi * 0.0125 * 0.0125, 1, 1e-6);
  EXPECT_NEAR(pdf_position(meter()), 1, 1e-6) << "8 m^2 of 8 pixels";
  EXPECT_EQ(ray_of(lens(), {1, 1}, {0.5F, 0.5F}).ray.time, 0.25F);
  EXPECT_EQ(ray_of(wide_pinhole(), {1, 1}, {0.5F, 0.5F}).ray.time, 0.25F);
  EXPECT_EQ(ray_of(meter(), {1, 1}, {0.5F, 0.5F}).ray.time, 0.25F);
}

// Through one lens point, in focus and out of focus, near the axis and in the corner: a part of the pixel
// sees a solid angle with the same fraction of the directions.
TEST(Camera, DirectionsThroughAPixelIntegrateToOne) {
  constexpr int kParts = 64;
  const V2f u(0.9F, 0.3F);
  for (const Camera& camera : {narrow_pinhole(), wide_pinhole(), lens(), wide_lens()})
    for (const V2f& pixel : {V2f(3, 2), V2f(0, 0)}) {
      const auto ray = [&](double x, double y) {
        return ray_of(camera, pixel + V2f(static_cast<float>(x / kParts), static_cast<float>(y / kParts)), u)
            .ray;
      };
      const auto towards = [&](double x, double y) { return V3d(ray(x, y).direction).normalized(); };
      double all = 0;
      for (int i = 0; i < kParts; ++i)
        for (int j = 0; j < kParts; ++j) {
          const double seen = solid_angle(towards(i, j), towards(i + 1, j), towards(i + 1, j + 1)) +
                              solid_angle(towards(i, j), towards(i, j + 1), towards(i + 1, j + 1));
          const auto of = density(camera, ray(i + 0.5, j + 0.5), kWavelengths);
          ASSERT_TRUE(of);
          const double share = seen * static_cast<double>(of->pdf_direction[0]);
          EXPECT_NEAR(share * kParts * kParts, 1, 2e-2);
          all += share;
        }
      EXPECT_NEAR(all, 1, 1e-4) << "camera " << camera.kind.index() << ", pixel " << pixel;
    }
}

TEST(Camera, NothingIsSeenBackwardsOrBesideTheFilm) {
  for (const Camera& camera : {wide_pinhole(), wide_lens(), meter()}) {
    Ray ray = ray_of(camera, {1, 1}, {0.5F, 0.5F}).ray;
    EXPECT_TRUE(density(camera, ray, kWavelengths));
    ray.direction = -ray.direction;
    EXPECT_FALSE(density(camera, ray, kWavelengths));
  }
  for (const Camera& camera : {narrow_pinhole(), lens()})
    EXPECT_FALSE(density(camera, {{1, 2, 3}, V3f(1, -1, 0).normalized()}, kWavelengths));
}

TEST(Probe, MeasuresTheHemisphere) {
  const Camera probe{IrradianceProbe{Quad{{1, 1, 1}, {2, 0, 0}, {0, -4, 0}}}, 2, 4, 1};
  Random random(5);
  double mean_cosine = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const CameraRay start = ray_of(probe, {1.5F, 3.5F}, random.pair());
    EXPECT_FLOAT_EQ(start.weight[0], static_cast<float>(kPi));
    EXPECT_NEAR(start.ray.origin.x, 2.5, 1e-6);
    EXPECT_NEAR(start.ray.origin.y, -2.5, 1e-6);
    EXPECT_LT(start.ray.origin.z, 1) << "on the side it looks to";
    EXPECT_NEAR(start.ray.direction.z, -start.cos_film, 1e-6);
    mean_cosine += static_cast<double>(start.cos_film) / kCount;
  }
  EXPECT_NEAR(mean_cosine, 2.0 / 3, 0.01);
}

}  // namespace
}  // namespace abbe
