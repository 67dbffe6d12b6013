#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "description/load_lens.h"
#include "lens/beam.h"
#include "lens/field.h"
#include "lens/paraxial.h"
#include "lens/spot.h"
#include "scene/camera/camera_rays.h"
#include "scene/camera/lens_optics.h"
#include "scenes.h"

// A real lens before the film sees what the bench says that it does.

namespace abbe {
namespace {

using Imath::V2d;
using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using testing::Random;

constexpr double kPi = std::numbers::pi;

lens::System shipped(const std::string& name) {
  Diagnostics diagnostics;
  return load_lens(name, diagnostics).value();
}

// Looking along -y from (1, 2, 3), up is z; the film reaches 15 degrees from its middle to its sides.
using Ghosts = LensOptics::Ghosts;
Camera looking_through(const lens::System& lens, double stop_radius, int side = 400,
                       Ghosts ghosts = Ghosts::left_out) {
  const lens::FirstOrder first = lens::first_order(lens::SystemAt(lens, lens.primary_nm()));
  const FilmGrid grid{side, side, first.focal_length_mm * 1e-3 * std::tan(15 * kPi / 180) * 2 / side};
  return {LensSystem{{{1, 2, 3}, {-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                     std::make_shared<LensOptics>(lens, stop_radius, grid, 400, 700, ghosts),
                     ghosts == Ghosts::enumerated},
          grid.width, grid.height, grid.pixel_pitch};
}

// In mm above the middle of the picture, where an object that is below the axis has its image.
double height_mm(const Camera& camera, float film_y) {
  return (camera.height / 2.0 - static_cast<double>(film_y)) * camera.pixel_pitch * 1e3;
}
double across_mm(const Camera& camera, float film_x) {
  return (static_cast<double>(film_x) - camera.width / 2.0) * camera.pixel_pitch * 1e3;
}

// Eight wavelengths that glass tells well apart.
SampledSpectrum spread_wavelengths() {
  SampledSpectrum::Values nm;
  for (std::size_t j = 0; j < kLanes; ++j) nm[j] = 420.0F + 35 * static_cast<float>(j);
  return SampledSpectrum(nm);
}

TEST(LensCamera, TellsTheSameOfARayFromBothEnds) {
  const lens::System lens = shipped("double_gauss");
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

// A lens with strong ghosts, of light that its own surfaces bound.
lens::System dense_tessar() {
  lens::System lens = shipped("tessar");
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
  EXPECT_NEAR(std::accumulate(optics.route_share.begin(), optics.route_share.end(), 0.0), 1, 1e-12);
  const SampledSpectrum wavelengths = spread_wavelengths();
  Random random(2);
  std::vector<int> passed(optics.routes.size(), 0);
  for (int i = 0; i < 20000; ++i) {
    const V2f film(100 * random.uniform(), 100 * random.uniform());
    const int hero = i % kLanes;
    const CameraRay start = sample_ray(camera, film, random.pair(), wavelengths, hero, 0);
    if (start.weight.is_zero()) continue;
    ++passed[start.route];
    EXPECT_GE(start.cos_film, least_film_cosine(camera));
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

// Those that are traced together are what each is alone, however many there are.
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
    EXPECT_LT((rays[i].ray.direction - alone.ray.direction).length(), 1e-6F);
    EXPECT_LT((rays[i].ray.origin - alone.ray.origin).length(), 1e-6F);
    EXPECT_EQ(rays[i].ray.time, time);
    EXPECT_EQ(rays[i].route, alone.route);
    ASSERT_EQ(rays[i].weight.is_zero(), alone.weight.is_zero());
    if (alone.weight.is_zero()) continue;
    ghosts += alone.route > 0;
    EXPECT_NEAR(rays[i].images->x[2], alone.images->x[2], 0.1);
    EXPECT_NEAR(rays[i].weight[2] / alone.weight[2], 1, 1e-3);
  }
  EXPECT_GT(ghosts, 3);
}

// The flux of a far point that ghosts bring through a curved front to the film, by a grid of parallel rays.
TEST(LensCamera, GhostsTakeInTheFluxOfAFarPoint) {
  lens::System lens = shipped("achromat");
  for (lens::Surface& surface : lens.surfaces)
    if (surface.behind) surface.behind->index = RefractiveIndex(surface.behind->index.n(550) + 0.7);
  lens.surfaces[0].profile.curvature *= 4;
  lens.surfaces.back().thickness_mm = 10;  // so near that most of it falls on the film
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
        const auto there = optics.system.to_image({through - 50.0 * direction, direction},
                                                  SampledSpectrum(550), optics.routes[route]);
        if (!there.arrived[0] || std::abs(there.point.x[0]) > half_film ||
            std::abs(there.point.y[0]) > half_film)
          continue;
        flux += there.transmittance[0] * std::cos(angle) * cell * cell;
      }
  EXPECT_GT(flux, 0);
  EXPECT_NEAR(drawn / flux, 1, 0.01);
}

// What stands for a pixel where nothing is drawn is the image, of which the middle numbers draw the middle.
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

TEST(LensCamera, ImageIsUpright) {
  const lens::System lens = shipped("tessar");
  const Camera camera = looking_through(lens, lens::stop_radius(lens));
  const V3f right = sample_ray(camera, {390, 200}, {0.5F, 0.5F}, SampledSpectrum(550), 0, 0).ray.direction;
  EXPECT_LT(right.x, -0.02F) << "to the right, which is -x";
  const V3f top = sample_ray(camera, {200, 10}, {0.5F, 0.5F}, SampledSpectrum(550), 0, 0).ray.direction;
  EXPECT_GT(top.z, 0.02F) << "upwards";
}

// Irradiance of cells of the film by a patch of radiance 1, lane by lane, from the film and from the patch.
struct CellEstimate {
  static constexpr int kCells = 4;
  std::array<std::array<double, kCells * kCells>, kLanes> mean{};
  std::array<std::array<double, kCells * kCells>, kLanes> square{};
  void add(const Camera& camera, const LaneImages& images, const SampledSpectrum& values) {
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

// By way of the image, or of ghosts alone.
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
  const lens::System lens = shipped("landscape");  // which parts the lanes most
  expect_both_ways_collect_the_same(looking_through(lens, lens::stop_radius(lens), 300),
                                    {{1.04, 1.4, 2.98}, V3d(0.1, 1, 0.2).normalized(), 0.1}, false);
}

// A meniscus, which has but one ghost, of strongly curved surfaces.
lens::System dense_meniscus() {
  lens::System lens = shipped("landscape");
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

// In an evenly bright world: the integral of T cos over the directions from which a ghost's light comes to a
// film point, by a grid in the tangent plane of the last vertex.
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
      const auto back = system.to_image({out->origin, -out->direction}, SampledSpectrum(550), route);
      integral += back.transmittance[0] * std::pow(direction.z, 4) * cell * cell / (depth * depth);
    }
  EXPECT_GT(integral, 0);
  EXPECT_NEAR(drawn / integral, 1, 0.01);
}

// The mean weight of rays to a film position, from jittered places of the pupil: its irradiance by an evenly
// bright world.
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

// The sine of the angle under which the middle of the image sees the rim of the stop through what is behind
// it.
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

// E = pi tau sin^2 U' of radiance 1: pi/4 over the square of the T-stop, measured where the film is.
TEST(LensCamera, ExposesByItsStop) {
  for (const char* name : {"double_gauss", "cooke_triplet", "tessar", "achromat"}) {
    const lens::System lens = shipped(name);
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

TEST(LensCamera, DarkensTowardsTheCornersAsOnTheBench) {
  for (const char* name : {"double_gauss", "cooke_triplet", "tessar"}) {
    const lens::System lens = shipped(name);
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

// The image of a far point, through points all over the front of the lens.
struct PointImage {
  V2d centroid{0, 0};
  double rms = 0;
};
PointImage image_of_far_point(const Camera& camera, double angle_deg, int lane) {
  const double angle = angle_deg * kPi / 180;
  const V3d towards(0, -std::cos(angle), std::sin(angle));
  const V3f point(V3d(1, 2, 3) + 1e5 * towards);  // above the axis: light goes down, the picture is up
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
    const lens::System lens = shipped(name);
    const double stop = lens::stop_radius(lens);
    const Camera camera = looking_through(lens, stop, 1200);
    for (const double field : {0.0, 8.0})
      for (const int lane : {0, 4, 7}) {
        const lens::SystemAt at(lens, static_cast<double>(spread_wavelengths()[lane]));
        // Light from above the axis goes downwards.
        const lens::Spot spot = lens::spot(*lens::Beam::of(at, -field, stop), -field, 128);
        const auto size = lens::size_of({&spot, 1});
        ASSERT_TRUE(size);
        const PointImage image = image_of_far_point(camera, field, lane);
        // The picture is turned; 1/sqrt(20000) of the spot is the noise of the centroid, 4 of it the margin.
        EXPECT_NEAR(image.centroid.y, -size->centroid.y, 0.03 * size->rms_mm + 2e-4)
            << name << ", " << field << " degrees, lane " << lane;
        EXPECT_NEAR(image.centroid.x, 0, 0.03 * size->rms_mm + 2e-4);
        EXPECT_NEAR(image.rms / size->rms_mm, 1, 0.02) << name << ", " << field << " degrees, lane " << lane;
      }
  }
}

TEST(LensCamera, DistortsAndPartsColoursAsItsChiefRays) {
  const lens::System lens = shipped("landscape");
  const double stop = lens::stop_radius(lens) / 20;  // so that the centroid is the chief ray's
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
  const lens::System lens = shipped("achromat");
  Scene scene{};
  scene.camera = looking_through(lens, lens::stop_radius(lens), 20);
  scene.materials = {testing::glass()};
  scene.channels.push_back(energy_channel("Y", Curve(1.0)));
  scene.commit();
  EXPECT_FALSE(scene.needs.polarisation_matters);
  scene.shapes = {{"pane", Quad{{-1, -1, 2}, {0, 2, 0}, {2, 0, 0}}, 0}};
  scene.commit();
  EXPECT_TRUE(scene.needs.polarisation_matters);
}

TEST(LensCamera, TellsOfItself) {
  const lens::System lens = shipped("double_gauss");
  const Camera camera = looking_through(lens, lens::stop_radius(lens));
  EXPECT_NEAR(*traits(camera).f_number, 2, 0.01);
  EXPECT_NEAR(*traits(camera).image_distance, 0.1, 0.001);
  EXPECT_TRUE(traits(camera).displaces_lanes);
  EXPECT_FALSE(traits(Camera{}).displaces_lanes);
  EXPECT_FALSE(sample_towards(camera, {1, 3, 3}, {0.5F, 0.5F}, SampledSpectrum(550), 0)) << "behind";
  Ray back = sample_ray(camera, {200, 200}, {0.5F, 0.5F}, SampledSpectrum(550), 0, 0).ray;
  EXPECT_TRUE(density(camera, back, SampledSpectrum(550)));
  back.direction = -back.direction;
  EXPECT_FALSE(density(camera, back, SampledSpectrum(550)));
}

}  // namespace
}  // namespace abbe
