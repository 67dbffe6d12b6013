#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "calibration/metrics/slanted_edge.h"
#include "lens/spot.h"
#include "scene/camera/lens_optics.h"
#include "tests/angles.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/tier.h"

// What a picture of a slanted edge keeps of detail is what the lens's traced spots, the pixels and the
// measurement's window leave of it.

namespace abbe {
namespace {

using Imath::V2d;

constexpr double kSlant = 5;     // degrees
constexpr double kFinest = 0.2;  // cycles a pixel, of which the lens leaves a seventh
constexpr int kAlong = 40;       // pixels that are measured along an edge
constexpr int kAcross = 24;      // and across it

// Of a white card.
struct Edge {
  const char* name;
  double height_mm;  // above the axis
  bool tangential;   // measured towards the axis: the edge lies along the rows
};
constexpr Edge kEdges[] = {{"axis", 0, false}, {"tangential", 42, true}, {"sagittal", -42, false}};

// The meniscus parts these colours by 0.3 mm along its axis, and across it.
constexpr const char* kBench = R"({
  "abbe": 1, "units": "mm",
  "camera": {"lens_system": {"prescription": "landscape", "focus_distance": 300, "focus": "paraxial"}, "from": [0, 0, 0], "to": [0, 300, 0], "up": [0, 0, 1]},
  "sensor": {"resolution": [48, 664], "pixel_pitch_um": 5, "channels": {"blue": {"band": [420, 500]}, "white": {"band": [420, 680]}}},
  "materials": {"white": {"diffuse": {"reflectance": 1}}},
  "render": {"integrator": "light", "max_depth": 2}
})";

// A card from the edge on, 8 mm along it and 3 mm deep, and a distant lamp that lights it evenly.
struct Card {
  std::string shape;
  std::string lamp;
};
Card card_of(const Edge& edge) {
  const double s = std::sin(kSlant * kPi / 180);
  const double c = std::cos(kSlant * kPi / 180);
  const V2d along = (edge.tangential ? V2d(c, s) : V2d(s, c)) * 8.0;
  const V2d deep = (edge.tangential ? V2d(0, 1) : V2d(1, 0)) * 3.0;
  const V2d corner = V2d(0, edge.height_mm) - along / 2;
  const V2d middle = corner + (along + deep) / 2;
  const V2d& u = edge.tangential ? along : deep;  // the card looks back at the camera
  const V2d& v = edge.tangential ? deep : along;
  return {
      fmt::format(
          R"({{"quad": {{"corner": [{}, 300, {}], "edge_u": [{}, 0, {}], "edge_v": [{}, 0, {}]}}, "material": "white"}})",
          corner.x, corner.y, u.x, u.y, v.x, v.y),
      fmt::format(
          R"({{"spot": {{"at": [{}, -700, {}], "direction": [0, 1, 0], "half_angle_deg": 0.25}}, "emission": {{"spectrum": 1, "luminous_intensity": 1000}}}})",
          middle.x, middle.y)};
}

Scene bench(int samples) {
  std::string shapes;
  std::string lamps;
  for (const Edge& edge : kEdges) {
    const Card card = card_of(edge);
    shapes += (shapes.empty() ? "" : ", ") + card.shape;
    lamps += (lamps.empty() ? "" : ", ") + card.lamp;
  }
  return test::load_text(kBench, {{"/shapes", "[" + shapes + "]"},
                                  {"/lights", "[" + lamps + "]"},
                                  {"/render/samples", std::to_string(samples)}});
}

// Of a point of the object in an even spectrum, as a channel sees it.
std::vector<lens::Spot> spots_of(const LensOptics& optics, const Channel& channel, double height_mm) {
  constexpr double kStep = 5;  // nm
  std::vector<lens::Spot> spots;
  for (double nm = 420 + kStep / 2; nm < 680; nm += kStep) {
    const double response = channel.weight(nm);
    if (response == 0) continue;
    const lens::SystemAt at(optics.system.system(), nm);
    spots.push_back(
        lens::spot(*lens::Beam::of(at, height_mm, optics.system.stop_radius_mm()), height_mm, 64));
    for (lens::SpotRay& ray : spots.back().rays) ray.weight *= response;
  }
  return spots;
}

// The spots as Hamming's window leaves them, which `slanted_edge` lays over both sides of the edge.
std::vector<lens::Spot> windowed(std::vector<lens::Spot> spots, const V2d& across, double half_width_mm) {
  const V2d centroid = lens::size_of(spots)->centroid;
  for (lens::Spot& spot : spots)
    for (lens::SpotRay& ray : spot.rays) {
      const double x = (ray.point - centroid).dot(across) / half_width_mm;
      EXPECT_LT(std::abs(x), 1) << "the spot is wider than what is measured";
      ray.weight *= 0.54 + 0.46 * std::cos(kPi * x);
    }
  return spots;
}

double sinc(double x) {
  return x == 0 ? 1 : std::sin(kPi * x) / (kPi * x);
}

EdgeResponse measured(const Film& film, int channel, const Edge& edge, double image_height_px) {
  const int width = edge.tangential ? kAlong : kAcross;
  const int height = edge.tangential ? kAcross : kAlong;
  const int left = (film.width() - width) / 2;
  const int top = film.height() / 2 - static_cast<int>(std::lround(image_height_px)) - height / 2;
  std::vector<double> values;
  for (int y = top; y < top + height; ++y)
    for (int x = left; x < left + width; ++x)
      values.push_back(film.mean(static_cast<std::size_t>(y * film.width() + x), channel));
  return slanted_edge(values, width, height);
}

TEST(NightlyLensModulation, OfASlantedEdgeIsThatOfTheTracedSpots) {
  const Scene scene = bench(test::nightly() ? 2048 : 256);
  const double tolerance = test::nightly() ? 0.01 : 0.02;
  const LensOptics& optics = *std::get<LensSystem>(scene.camera.kind).optics;
  const double pitch_mm = scene.camera.pixel_pitch * 1e3;
  const Film film = render(scene, {}).film;
  for (const Edge& edge : kEdges)
    for (std::size_t k = 0; k < scene.channels.size(); ++k) {
      SCOPED_TRACE(std::string(edge.name) + ", " + scene.channels[k].name);
      const std::vector<lens::Spot> spots = spots_of(optics, scene.channels[k], edge.height_mm);
      const EdgeResponse found =
          measured(film, static_cast<int>(k), edge, -lens::size_of(spots)->centroid.y / pitch_mm);
      EXPECT_EQ(found.is_horizontal, edge.tangential);
      EXPECT_NEAR(std::abs(found.angle_deg), kSlant, 0.2);
      const double angle = found.angle_deg * kPi / 180;
      const V2d across =
          edge.tangential ? V2d(std::sin(angle), std::cos(angle)) : V2d(std::cos(angle), std::sin(angle));
      const double half_width_mm = (static_cast<double>(found.edge.size()) + 1) / 8 * pitch_mm;
      const std::vector<lens::Spot> seen = windowed(spots, across, half_width_mm);
      double worst = 0;
      for (std::size_t i = 1; found.frequency(i) <= kFinest; ++i) {
        const double f = found.frequency(i);
        const double expected = lens::geometric_mtf(seen, f / pitch_mm, across) * sinc(f * std::cos(angle)) *
                                sinc(f * std::sin(angle));
        EXPECT_NEAR(found.mtf[i], expected, tolerance) << f << " cycles a pixel";
        worst = std::max(worst, std::abs(found.mtf[i] - expected));
      }
      std::printf("%s, %s: rms %.1f um, MTF50 %.4f cycles a pixel, off by up to %.4f\n", edge.name,
                  scene.channels[k].name.c_str(), 1e3 * lens::size_of(spots)->rms_mm, found.mtf50.value(),
                  worst);
    }
}

}  // namespace
}  // namespace abbe
