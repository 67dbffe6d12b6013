#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "lens_cameras.h"
#include "scene/camera/camera.h"
#include "scenes.h"

// Rays and connections of a real lens, by the image and by its ghosts, are reverses of each other.

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
using Ghosts = LensOptics::Ghosts;

// Includes wavelengths whose path through a ghost ends at an edge or by total reflection.
TEST(LensCamera, TellsFiniteNumbersOfEveryLane) {
  const lens::System lens = lens_named("double_gauss");
  const Camera camera = looking_through(lens, lens::stop_radius(lens), 16, Ghosts::enumerated);
  Random random(3);
  int parted = 0;  // ghosts by which only some wavelengths arrive
  for (int i = 0; i < 60000; ++i) {
    const V2f film(16 * random.uniform(), 16 * random.uniform());
    const CameraRay ray = sample_ray(camera, film, random.pair(), spread_wavelengths(), i % kLanes, 0);
    if (ray.weight.is_zero()) continue;
    const auto& [axis, xx, xy, yx, yy] = ray.images->jones;
    bool dark = false;
    for (int j = 0; j < kLanes; ++j) {
      for (const SampledSpectrum* of : {&ray.weight, &ray.lane_pdf, &ray.images->x, &ray.images->y,
                                        &ray.images->cos_film, &xx, &xy, &yx, &yy})
        ASSERT_TRUE(std::isfinite((*of)[j])) << "route " << ray.route << ", lane " << j;
      ASSERT_GE(ray.weight[j], 0);
      dark = dark || ray.weight[j] == 0;
    }
    parted += dark ? 1 : 0;
  }
  EXPECT_GT(parted, 300);
}

// The entrance pupil of the last lens is 58 mm behind its first vertex, in whose plane rays end.
TEST(LensCamera, ConnectionsOfNearPointsWeighAsDensitiesTell) {
  const SampledSpectrum wavelengths = spread_wavelengths();
  Random random(8);
  for (const auto& [name, ghosts] : {std::pair("achromat", Ghosts::left_out),
                                     {"tessar", Ghosts::left_out},
                                     {"double_gauss", Ghosts::enumerated},
                                     {"double_gauss", Ghosts::left_out}}) {
    const lens::System lens = lens_named(name);
    const Camera camera = looking_through(lens, lens::stop_radius(lens), 400, ghosts);
    int found = 0;
    for (int i = 0; i < 4000; ++i) {
      const V3f point(1 + 0.04F * random.uniform(), 1.8F, 3 + 0.04F * random.uniform());  // at 0.2 m
      const auto seen = sample_towards(camera, point, random.pair(), wavelengths, 0);
      if (!seen || seen->weight.is_zero()) continue;
      const V3f way = point - seen->lens_point;
      const auto of =
          density(camera, ray_at(seen->lens_point, way.normalized(), 0), wavelengths, seen->route);
      if (!of) continue;  // at the rim of the film
      ++found;
      const double at_film = static_cast<double>(of->cos_theta / seen->pdf_position / way.length2());
      for (int j = 0; j < kLanes; ++j)
        EXPECT_NEAR(at_film * static_cast<double>(of->importance[j]), static_cast<double>(seen->weight[j]),
                    1e-4 * static_cast<double>(seen->weight[j]))
            << name << ", route " << seen->route;
    }
    EXPECT_GT(found, 200) << name;
  }
}

TEST(LensCamera, TellsTheSameOfARayFromBothEnds) {
  const lens::System lens = lens_named("double_gauss");
  const Camera camera = looking_through(lens, lens::stop_radius(lens));
  const SampledSpectrum wavelengths = spread_wavelengths();
  Random random(2);
  int passed = 0;
  for (int i = 0; i < 2000; ++i) {
    const V2f film(400 * random.uniform(), 400 * random.uniform());
    const int hero = i % kLanes;
    const CameraRay start = sample_ray(camera, film, random.pair(), wavelengths, hero, 0.25F);
    if (start.weight.is_zero()) continue;
    ++passed;
    ASSERT_TRUE(start.images);
    EXPECT_NEAR(start.images->x[hero], film.x, 0.01) << "floats tell a ray's direction to 6e-8";
    EXPECT_NEAR(start.images->y[hero], film.y, 0.01);
    EXPECT_EQ(start.lane_pdf[hero], 1);
    EXPECT_EQ(start.ray.time, 0.25F);
    const auto of = density(camera, start.ray, wavelengths);
    ASSERT_TRUE(of);
    const double flux = static_cast<double>(of->cos_theta / of->pdf_position / of->pdf_direction[hero]);
    for (int j = 0; j < kLanes; ++j) {
      EXPECT_NEAR(flux * static_cast<double>(of->importance[j]), static_cast<double>(start.weight[j]),
                  1e-5 * static_cast<double>(start.weight[hero]));
      EXPECT_NEAR(of->pdf_direction[j] / of->pdf_direction[hero], start.lane_pdf[j], 1e-5);
      EXPECT_EQ(of->images->x[j], start.images->x[j]);
      EXPECT_EQ(of->images->y[j], start.images->y[j]);
    }
  }
  EXPECT_GT(passed, 1500);
}

// A lens with strong ghosts, limited by its own surfaces.
lens::System dense_tessar() {
  lens::System lens = lens_named("tessar");
  for (lens::Surface& surface : lens.surfaces)
    if (surface.behind) surface.behind->index = RefractiveIndex(surface.behind->index.n(550) + 0.7);
  lens.surfaces[2].decenter_mm = {0.5, -0.3};
  lens.surfaces[5].tilt_deg = {1, 2};
  lens.surfaces.back().thickness_mm = 60;
  return lens;
}

TEST(LensCamera, GhostsTellTheSameOfARayFromBothEnds) {
  const lens::System lens = dense_tessar();
  const Camera camera = looking_through(lens, lens::stop_radius(lens), 100, Ghosts::enumerated);
  const LensOptics& optics = *std::get<LensSystem>(camera.kind).optics;
  EXPECT_EQ(optics.routes.size(), 22U) << "the image, and seven surfaces of glass in pairs";
  EXPECT_NEAR(std::accumulate(optics.route_probability.begin(), optics.route_probability.end(), 0.0), 1,
              1e-12);
  const SampledSpectrum wavelengths = spread_wavelengths();
  Random random(2);
  std::vector<int> passed(optics.routes.size(), 0);
  for (int i = 0; i < 20000; ++i) {
    const V2f film(100 * random.uniform(), 100 * random.uniform());
    const int hero = i % kLanes;
    const CameraRay start = sample_ray(camera, film, random.pair(), wavelengths, hero, 0);
    if (start.weight.is_zero()) continue;
    ++passed[start.route];
    EXPECT_GE(start.cos_film, min_film_cosine(camera));
    EXPECT_NEAR(start.images->x[hero], film.x, 0.1) << "floats tell a ray's direction to 6e-8";
    EXPECT_NEAR(start.images->y[hero], film.y, 0.1);
    const auto of = density(camera, start.ray, wavelengths, start.route);
    ASSERT_TRUE(of);
    const double flux = static_cast<double>(of->cos_theta / of->pdf_position / of->pdf_direction[hero]);
    for (int j = 0; j < kLanes; ++j)
      EXPECT_NEAR(flux * static_cast<double>(of->importance[j]), static_cast<double>(start.weight[j]),
                  1e-3 * static_cast<double>(start.weight[hero]));
  }
  std::vector<int> came(optics.routes.size(), 0);
  for (int i = 0; i < 200000; ++i) {
    const auto from = sample_ghost(camera, random.pair(), 0);
    ASSERT_TRUE(from);
    const V3f wi = V3f(random.uniform() - 0.5F, -1, random.uniform() - 0.5F).normalized();
    came[from->route] += density(camera, ray_at(from->point, wi, 0), wavelengths, from->route).has_value();
  }
  for (std::size_t route = 1; route < passed.size(); ++route)
    EXPECT_TRUE(passed[route] > 0 || came[route] < 50)
        << "route " << route << " of " << came[route] << " rays";
  EXPECT_GT(std::count_if(came.begin(), came.end(), [](int count) { return count > 0; }), 18);
}

// Rays traced together equal those traced alone, whatever their number.
TEST(LensCamera, RaysTogetherAreThoseAlone) {
  const lens::System lens = dense_tessar();
  Camera camera = looking_through(lens, lens::stop_radius(lens), 100, Ghosts::enumerated);
  camera.motion = std::make_shared<const Motion>(
      std::vector<Motion::Keyframe>{{0, {0, 1, 0}, 0, {0, 0, 0}}, {1, {0, 1, 0}, 1.2, {0, 0, 0}}});
  Random random(12);
  std::vector<CameraSample> samples;
  for (int i = 0; i < 333; ++i)
    samples.push_back({{100 * random.uniform(), 100 * random.uniform()},
                       random.pair(),
                       spread_wavelengths(),
                       i % kLanes,
                       random.uniform()});
  std::vector<CameraRay> rays(samples.size());
  sample_rays(camera, samples, rays);
  int ghosts = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& [film, on_lens, wavelengths_nm, hero, time] = samples[i];
    const CameraRay alone = sample_ray(camera, film, on_lens, wavelengths_nm, hero, time);
    ASSERT_EQ(rays[i].weight.is_zero(), alone.weight.is_zero());
    if (alone.weight.is_zero()) continue;
    EXPECT_LT((rays[i].ray.direction - alone.ray.direction).length(), 1e-6F);
    EXPECT_LT((rays[i].ray.origin - alone.ray.origin).length(), 1e-6F);
    EXPECT_EQ(rays[i].ray.time, time);
    EXPECT_EQ(rays[i].route, alone.route);
    ghosts += alone.route > 0;
    EXPECT_NEAR(rays[i].images->x[2], alone.images->x[2], 0.1);
    EXPECT_NEAR(rays[i].weight[2] / alone.weight[2], 1, 1e-3);
    EXPECT_LT((rays[i].images->jones.axis - alone.images->jones.axis).length(), 1e-4F);
    EXPECT_NEAR(rays[i].images->jones.xx[2], alone.images->jones.xx[2], 1e-4);
  }
  EXPECT_GT(ghosts, 3);
}

// The flux of a distant point through ghosts of a curved front to the film, by a grid of parallel rays.
TEST(LensCamera, GhostsTakeInTheFluxOfAFarPoint) {
  lens::System lens = lens_named("achromat");
  for (lens::Surface& surface : lens.surfaces)
    if (surface.behind) surface.behind->index = RefractiveIndex(surface.behind->index.n(550) + 0.7);
  lens.surfaces[0].profile.curvature *= 4;
  lens.surfaces.back().thickness_mm = 10;  // so near that most of the light falls on the film
  const Camera camera = looking_through(lens, lens::stop_radius(lens), 400, Ghosts::enumerated);
  const LensOptics& optics = *std::get<LensSystem>(camera.kind).optics;
  const double angle = 0.1;
  constexpr double kFar = 1e5;
  const V3f point(V3d(1, 2, 3) + kFar * V3d(0, -std::cos(angle), std::sin(angle)));
  constexpr int kSide = 600;
  Random random(6);
  double drawn = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const V2f u = (V2f(static_cast<float>(i), static_cast<float>(j)) + random.pair()) / kSide;
      const auto seen = sample_towards(camera, point, u, SampledSpectrum(550), 0);
      if (seen && seen->route > 0) drawn += static_cast<double>(seen->weight[0]) / (kSide * kSide);
    }
  drawn *= kFar * kFar * camera.pixel_pitch * camera.pixel_pitch * 1e6;  // mm^2 of the beam
  const double half = 1.5 * optics.semi_aperture_mm(0);
  const double cell = 2 * half / kSide;
  const double half_film = camera.width * camera.pixel_pitch * 1e3 / 2;
  const V3d direction(0, -std::sin(angle), std::cos(angle));
  double flux = 0;
  for (std::size_t route = 1; route < optics.routes.size(); ++route)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) {
        const V3d through(-half + (i + 0.5) * cell, -half + (j + 0.5) * cell, 0);
        const auto there =
            optics.system.to_image({through - 50.0 * direction, direction}, 550, optics.routes[route]);
        if (!there || std::abs(there->point.x) > half_film || std::abs(there->point.y) > half_film) continue;
        flux += there->transmittance * std::cos(angle) * cell * cell;
      }
  EXPECT_GT(flux, 0);
  EXPECT_NEAR(drawn / flux, 1, 0.01);
}

// The central ray of a pixel is that of the image, which the center of the random numbers selects.
TEST(LensCamera, GhostsLeaveTheCentralRay) {
  const lens::System lens = dense_tessar();
  const double stop = lens::stop_radius(lens);
  const Camera without = looking_through(lens, stop, 100);
  const Camera with = looking_through(lens, stop, 100, Ghosts::enumerated);
  EXPECT_NEAR(central_weight(with, {40, 60}) / central_weight(without, {40, 60}), 1, 1e-6);
  const auto middle = [](const Camera& camera) {
    return sample_ray(camera, {40, 60}, {0.5F, 0.5F}, SampledSpectrum(550), 0, 0).ray.direction;
  };
  EXPECT_LT((middle(with) - middle(without)).length(), 1e-6F);
}

TEST(LensCamera, PolarisesAboutAxesThatMoveWithIt) {
  const lens::System lens = dense_tessar();
  Camera camera = looking_through(lens, lens::stop_radius(lens), 100, Ghosts::enumerated);
  const CameraRay still = sample_ray(camera, {30, 20}, {0.4F, 0.6F}, spread_wavelengths(), 0, 1);
  camera.motion = std::make_shared<const Motion>(
      std::vector<Motion::Keyframe>{{0, {0, 1, 0}, 0, {0, 0, 0}}, {1, {0, 1, 0}, 1.2, {0, 0, 0}}});
  const CameraRay moved = sample_ray(camera, {30, 20}, {0.4F, 0.6F}, spread_wavelengths(), 0, 1);
  const auto turned = [&](const V3f& v) { return V3f(direction_at(camera, V3d(v), 1)); };
  EXPECT_LT((turned(still.ray.direction) - moved.ray.direction).length(), 1e-6F);
  EXPECT_LT((turned(still.images->jones.axis) - moved.images->jones.axis).length(), 1e-6F);
  EXPECT_EQ(still.images->jones.xx[2], moved.images->jones.xx[2]);
  const auto of = density(camera, moved.ray, spread_wavelengths(), moved.route);
  ASSERT_TRUE(of);
  EXPECT_LT((of->images->jones.axis - moved.images->jones.axis).length(), 1e-4F);
  const auto back =
      sample_towards(camera, moved.ray.origin + moved.ray.direction, {0.5F, 0.5F}, spread_wavelengths(), 1);
  ASSERT_TRUE(back);
  const V3f way = (moved.ray.origin + moved.ray.direction - back->lens_point).normalized();
  EXPECT_NEAR(back->images->jones.axis.dot(way), 0, 1e-5F);
}

// Irradiance of cells of the film by a patch of radiance 1, per wavelength, from the film and from the patch.
struct CellEstimate {
  static constexpr int kCells = 4;
  std::array<std::array<double, kCells * kCells>, kLanes> mean{};
  std::array<std::array<double, kCells * kCells>, kLanes> square{};
  void add(const Camera& camera, const WavelengthImages& images, const SampledSpectrum& values) {
    for (int j = 0; j < kLanes; ++j) {
      if (values[j] == 0) continue;
      const auto cell = [&](float at, int size) {
        return static_cast<std::size_t>(at) * kCells / static_cast<std::size_t>(size);
      };
      const std::size_t c = cell(images.y[j], camera.height) * kCells + cell(images.x[j], camera.width);
      mean[static_cast<std::size_t>(j)][c] += static_cast<double>(values[j]);
      square[static_cast<std::size_t>(j)][c] +=
          static_cast<double>(values[j]) * static_cast<double>(values[j]);
    }
  }
};

// By the image, or by ghosts alone.
void expect_both_ways_collect_the_same(const Camera& camera, const Disc& patch, bool of_ghosts) {
  const SampledSpectrum wavelengths = spread_wavelengths();
  const double pixels = static_cast<double>(camera.width) * camera.height;
  const int count = of_ghosts ? 400000 : 200000;
  CellEstimate from_film;
  CellEstimate from_patch;
  Random random(4);
  for (int i = 0; i < count; ++i) {
    const V2f film(static_cast<float>(camera.width) * random.uniform(),
                   static_cast<float>(camera.height) * random.uniform());
    const CameraRay start = sample_ray(camera, film, random.pair(), wavelengths, i % kLanes, 0);
    if (!start.weight.is_zero() && (start.route > 0) == of_ghosts && intersect<float>(patch, start.ray, 0))
      from_film.add(camera, *start.images,
                    start.weight * (static_cast<float>(kLanes * pixels) / start.lane_pdf.sum()));
    const SurfacePoint at = sample_area(patch, {}, random.pair());
    const auto back = sample_towards(camera, at.point, random.pair(), wavelengths, 0);
    if (!back || (back->route > 0) != of_ghosts) continue;
    const float cosine = std::max(0.0F, at.normal.dot((back->lens_point - at.point).normalized()));
    from_patch.add(camera, *back->images, back->weight * (cosine * static_cast<float>(area(patch))));
  }
  int lit = 0;
  double sums[2] = {0, 0};
  for (std::size_t j = 0; j < kLanes; ++j)
    for (std::size_t c = 0; c < from_film.mean[j].size(); ++c) {
      const double a = from_film.mean[j][c] / count;
      const double b = from_patch.mean[j][c] / count;
      const double variance = (from_film.square[j][c] + from_patch.square[j][c]) / count / count;
      EXPECT_NEAR(a, b, 5 * std::sqrt(variance) + 1e-12) << "lane " << j << ", cell " << c;
      lit += b > 0;
      sums[0] += a;
      sums[1] += b;
    }
  EXPECT_GE(lit, 5 * kLanes);
  EXPECT_NEAR(sums[0] / sums[1], 1, of_ghosts ? 0.05 : 0.01);
}

TEST(LensCamera, BothWaysCollectTheSameEnergyInEveryLane) {
  const lens::System lens = lens_named("landscape");  // separates the wavelengths most
  expect_both_ways_collect_the_same(looking_through(lens, lens::stop_radius(lens), 300),
                                    {{1.04, 1.4, 2.98}, V3d(0.1, 1, 0.2).normalized(), 0.1}, false);
}

// A meniscus with strongly curved surfaces, which has a single ghost.
lens::System dense_meniscus() {
  lens::System lens = lens_named("landscape");
  for (lens::Surface& surface : lens.surfaces)
    if (surface.behind) surface.behind->index = RefractiveIndex(2.2);
  lens.surfaces[1].tilt_deg = {2, -1};
  lens.surfaces.back().thickness_mm /= 2;
  return lens;
}

TEST(LensCamera, BothWaysCollectTheSameEnergyOfGhosts) {
  const lens::System lens = dense_meniscus();
  expect_both_ways_collect_the_same(looking_through(lens, lens::stop_radius(lens), 300, Ghosts::enumerated),
                                    {{1.04, 1.4, 2.98}, V3d(0.1, 1, 0.2).normalized(), 0.4}, true);
}

// In a uniformly bright world: the integral of T cos over the directions from which a ghost's light arrives
// at a film point, by a grid in the tangent plane of the last vertex.
TEST(LensCamera, GhostsExposeByTheirSolidAngle) {
  const lens::System lens = dense_meniscus();
  const Camera camera = looking_through(lens, lens::stop_radius(lens), 100, Ghosts::enumerated);
  const lens::SpectralSystem& system = std::get<LensSystem>(camera.kind).optics->system;
  const lens::Route& route = std::get<LensSystem>(camera.kind).optics->routes[1];
  const V2f film(61, 42);
  constexpr int kSide = 500;
  Random random(3);
  double drawn = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const V2f u = (V2f(static_cast<float>(i), static_cast<float>(j)) + random.pair()) / kSide;
      const CameraRay ray = sample_ray(camera, film, u, SampledSpectrum(550), 0, 0);
      if (ray.route == 1) drawn += static_cast<double>(ray.weight[0]) / (kSide * kSide);
    }
  const double depth = system.image_z() - system.last_z();
  const double half = 2 * *system.system().surfaces.back().semi_aperture_mm;
  const V3d from(-across_mm(camera, film.x), -height_mm(camera, film.y), system.image_z());
  const double cell = 2 * half / kSide;
  double integral = 0;
  for (int j = 0; j < kSide; ++j)
    for (int i = 0; i < kSide; ++i) {
      const V3d to(-half + (i + 0.5) * cell, -half + (j + 0.5) * cell, system.last_z());
      const V3d direction = (to - from).normalized();
      const auto out = system.to_object({from, direction}, 550, route);
      if (!out) continue;
      const auto back = system.to_image({out->origin, -out->direction}, 550, route);
      ASSERT_TRUE(back);
      integral += back->transmittance * std::pow(direction.z, 4) * cell * cell / (depth * depth);
    }
  EXPECT_GT(integral, 0);
  EXPECT_NEAR(drawn / integral, 1, 0.01);
}

}  // namespace
}  // namespace abbe
