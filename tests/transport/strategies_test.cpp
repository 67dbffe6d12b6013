// Camera and light subpaths are recorded and connected: however a path is divided between both, its
// contribution is the same.
#include <gtest/gtest.h>

#include <cfenv>
#include <span>

#include "scene/lights/light.h"
#include "spectral/sources.h"
#include "tests/tier.h"
#include "transport/path/path_recorder.h"
#include "transport/plan/plan.h"
#include "transport/technique/bidirectional.h"
#include "transport/technique/path.h"
#include "transport/technique/path_starts.h"

namespace abbe {
namespace {

using Imath::V3f;

constexpr std::uint32_t kCount = 1 << 15;
constexpr std::uint32_t kBatch = 1 << 10;

enum class Filling { nothing, fog, glass, gold, sky, filter };

struct Look {
  Camera camera;
  Filling filling;
};

// A coloured wall, a rough golden panel and a light. Options: a ball of fog that scatters and absorbs
// unevenly in front of the wall, or one of gold; a ball of dispersive glass in the wall; a sky, a wide sun
// and a small light; or a plate in front of the camera that transmits few wavelengths.
Scene room(const Look& look) {
  Scene scene{};
  scene.camera = look.camera;
  scene.materials = {{"card", DiffuseMaterial{Curve({{300, 0.2}, {1100, 0.9}})}},
                     {"gold", RoughConductorMaterial{"gold", RefractiveIndex(0.3, 3),
                                                     Microfacets<float>{FacetShape::ggx, 0.4F, 0.4F}}}};
  scene.channels = {energy_channel("all", band(450, 650))};
  scene.shapes.push_back({"wall", Quad{{-2, -2, 4}, {0, 4, 0}, {4, 0, 0}}, 0});
  scene.shapes.push_back({"panel", Quad{{-2, -2.2, 1}, {0, 0, 2.5}, {4, 0, 0}}, 1});
  scene.shapes.push_back({"lamp", Quad{{-0.5, 3, 1.5}, {1, 0, 0}, {0, 0, 1}}, 0, 0});
  scene.lights.push_back({"lamp", AreaLight{2, false}, Curve(1.0)});
  if (look.filling == Filling::sky) {
    scene.lights.push_back({"sky", EnvironmentLight{}, Curve({{300, 0.1}, {1100, 0.4}})});
    scene.lights.push_back({"sun", SunLight{V3f(0.6F, 0.64F, -0.48F), 0.05F}, Curve(3.0)});
    scene.lights.push_back({"bulb", PointLight{{1, -1, 1.5}}, Curve({{300, 0.4}, {1100, 0.1}})});
  }
  if (look.filling == Filling::glass) {
    scene.materials.push_back(
        {"glass", DielectricMaterial{"glass", RefractiveIndex(Curve({{300, 1.7}, {1100, 1.4}}), Curve(),
                                                              IndexMedium::air, 300, 1100)}});
    scene.shapes.push_back({"ball", Sphere{{0, -1.4, 4}, 1.4}, 2});
  }
  if (look.filling == Filling::filter) {
    scene.materials.push_back({"plate", DepolariserMaterial{{band(540, 560, 0.9)}}});
    scene.shapes.push_back({"plate", Quad{{-1.8, -1.8, 2.4}, {0, 3.6, 0}, {3.6, 0, 0}}, 2});
  }
  if (look.filling == Filling::gold) scene.shapes.push_back({"ball", Sphere{{0, 0, 2.4}, 1}, 1});
  if (look.filling == Filling::fog) {
    MediumMaterial thin;
    thin.interior_medium.scattering_per_m = Curve({{300, 0.5}, {1100, 2}});
    thin.interior_medium.absorption_per_m = Curve(0.1);
    thin.interior_medium.phase = HenyeyGreensteinPhase{0.4F};
    scene.materials.push_back({"fog", thin});
    scene.shapes.push_back({"fog", Sphere{{0, 0, 2.4}, 1}, 2});
  }
  scene.render.integrator = Integrator::bdpt;
  scene.render.roulette_depth = -1;
  scene.render.max_depth = 3;
  scene.commit();
  return scene;
}

const CameraFrame kFrame{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const Camera kPinhole{Pinhole{kFrame, 0.05, 0.005}, 1, 1, 0.04};
const Camera kLens{ThinLens{kFrame, 0.05, 2, 0.05}, 1, 1, 0.04};
const Camera kMeter{IrradianceProbe{}, 1, 1, 0.04};

RecordedPath camera_path(const Plan& plan, const Sampler& sampler, std::uint32_t i) {
  RecordedPath path(sampler, i);
  path.packet = draw_packet(plan.wavelengths, sampler.group(kFilmGroup)[2]);
  WavelengthImages none;
  start_from_camera(plan, 0, 0, 0, path, none);
  return path;
}

// Light subpath with the wavelengths and hero of the camera subpath to which it is connected.
RecordedPath light_path(const Plan& plan, RayCaster& caster, const PathPacket& packet, const Sampler& sampler,
                        std::uint32_t i) {
  RecordedPath path(sampler, i);
  path.packet.wavelengths = packet.wavelengths;
  path.packet.hero = packet.hero;
  start_from_light(plan, caster, 0, path);
  return path;
}

// sum_j f_j/p(lambda_j) / sum_k P_k of two connected subpaths. [Wilkie2014]
double value(const PathVertex& a, const PathVertex& b, const SampledSpectrum& joined) {
  const SampledSpectrum f = joined / a.packet.wavelengths.pdf;
  return static_cast<double>(f.sum() / (a.packet.lane_pdf * b.packet.lane_pdf).sum());
}

struct Estimate {
  double sum = 0;
  double squares = 0;
  double count = kCount;  // number of paths, some of which contribute nothing
  void add(double x) {
    sum += x;
    squares += x * x;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double variance() const { return (squares / count - mean() * mean()) / count; }
};

// Connects recorded subpaths in all strategies with `events` scattering events. Calls `visit` with the number
// of these on the light subpath, and the contribution. If the camera subpath has no vertex, its point is
// sampled anew.
template <typename Visit>
void join_all(const Scene& scene, RayCaster& caster, int events, Visit visit) {
  const Plan plan = make_plan(scene);
  PathRecorder<TransportMode::radiance> from_camera(scene, caster);
  PathRecorder<TransportMode::power> from_light(scene, caster);
  for (std::uint32_t first = 0; first < kCount; first += kBatch) {
    from_camera.paths().clear();
    from_light.paths().clear();
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      from_camera.paths().push_back(camera_path(plan, {5, Purpose::camera, 0, 0, first + i}, i));
      from_light.paths().push_back(light_path(plan, caster, from_camera.paths().back().packet,
                                              {5, Purpose::light, 0, 0, first + i}, i));
    }
    from_camera.run();
    from_light.run();
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      const std::vector<PathVertex>& x = from_camera.paths()[i].vertices;
      const std::vector<PathVertex>& y = from_light.paths()[i].vertices;
      const auto u = Sampler(5, Purpose::pilot, 0, 0, first + i).group(0);
      for (std::size_t s = 0; s <= static_cast<std::size_t>(events); ++s) {
        const std::size_t t = static_cast<std::size_t>(events) - s;
        if (s >= y.size() || t >= x.size()) continue;
        PathVertex a = x[t];
        if (t == 0) {
          const auto seen = sample_towards(scene.camera, point_of(y[s]), {u[0], u[1]}, y[s].lambda_nm(), 0);
          if (!seen) continue;
          a.at = CameraVertex{seen->lens_point};
        }
        const auto joined = connect(scene, caster, a, y[s]);
        if (joined) visit(s, value(a, y[s], joined->contribution));
      }
    }
  }
}

// Estimates by the number of events on the light subpath.
std::vector<Estimate> strategies(const Scene& scene, int events) {
  RayCaster caster(scene);
  std::vector<Estimate> found(static_cast<std::size_t>(events) + 1);
  join_all(scene, caster, events, [&](std::size_t s, double value) { found[s].add(value); });
  return found;
}

TEST(Strategies, FindTheSameLight) {
  for (const Camera& camera : {kPinhole, kLens})
    for (int events = 1; events <= 3; ++events) {
      const Scene scene = room({camera, Filling::nothing});
      const std::vector<Estimate> found = strategies(scene, events);
      for (std::size_t s = 0; s < found.size(); ++s) {
        EXPECT_GT(found[s].mean(), 0) << s;
        EXPECT_NEAR(found[s].mean() / found[0].mean(), 1,
                    4.5 * std::sqrt(found[s].variance() + found[0].variance()) / found[0].mean())
            << events << " events, " << s << " of them from the light";
      }
    }
}

// Connections between two points in fog have no finite variance, so only the outermost strategies are
// compared.
TEST(Strategies, FindTheSameLightThroughFog) {
  const Scene scene = room({kPinhole, Filling::fog});
  for (int events = 1; events <= 2; ++events) {
    const std::vector<Estimate> found = strategies(scene, events);
    const Estimate& camera = found.front();
    const Estimate& light = found.back();
    EXPECT_NEAR(light.mean() / camera.mean(), 1,
                4.5 * std::sqrt(light.variance() + camera.variance()) / camera.mean())
        << events << " events";
  }
}

// Estimate of a technique from paths of one sample each, for a film of one pixel.
template <typename Trace>
Estimate found_by(Trace trace) {
  const std::uint32_t many = test::nightly() ? 1 << 17 : 1 << 14;
  Estimate sum{0, 0, static_cast<double>(many)};
  for (std::uint32_t first = 0; first < many; first += kBatch) {
    std::vector<double> values(kBatch);
    trace(first,
          [&](std::uint32_t i, const FilmPoint&, std::span<const double> more) { values[i] += more[0]; });
    for (const double value : values) sum.add(value);
  }
  return sum;
}
Estimate found_by_path_tracing(const Scene& scene) {
  const Plan plan = make_plan(scene);
  RayCaster caster(scene);
  PathTracer tracer(plan, caster);
  return found_by([&](std::uint32_t first, const Deposit& deposit) {
    std::vector<PixelSample> samples;
    for (std::uint32_t i = 0; i < kBatch; ++i)
      samples.push_back({0, 0, Sampler(8, Purpose::camera, 0, 0, first + i)});
    tracer.trace(samples, deposit);
  });
}
Estimate found_bidirectionally(const Scene& scene) {
  const Plan plan = make_plan(scene);
  RayCaster caster(scene);
  BidirectionalTracer tracer(plan, caster);
  return found_by([&](std::uint32_t first, const Deposit& deposit) {
    std::vector<PixelPair> pairs;
    for (std::uint32_t i = 0; i < kBatch; ++i)
      pairs.push_back({0, 0, Sampler(8, Purpose::camera, 0, 0, first + i),
                       Sampler(8, Purpose::light, 0, 0, first + i), true});
    tracer.trace(pairs, deposit);
  });
}

// Weighted over all strategies with the stored pdfs, contributions sum to the result of path tracing. This
// holds for paths of any length, through fog, glass and a filter, off gold, for lights of all kinds, and at a
// probe, to which no photon is connected. Where path tracing is best, the weights of the other strategies
// cost little.
class BalancedStrategies : public testing::TestWithParam<Filling> {};

TEST_P(BalancedStrategies, AddUp) {
  for (const Camera& camera : {kPinhole, kLens, kMeter})
    for (const int events : {GetParam() == Filling::filter ? 2 : 1, 4}) {
      SCOPED_TRACE(testing::Message() << events << " events");
      Scene scene = room({camera, GetParam()});
      scene.render.max_depth = events;
      const Estimate sum = found_bidirectionally(scene);
      scene.render.integrator = Integrator::path;
      const Estimate alone = found_by_path_tracing(scene);
      EXPECT_NEAR(sum.mean() / alone.mean(), 1,
                  4.5 * std::sqrt(sum.variance() + alone.variance()) / alone.mean());
      EXPECT_LT(sum.variance(), 1.25 * alone.variance());
    }
}

INSTANTIATE_TEST_SUITE_P(Fillings, BalancedStrategies,
                         testing::Values(Filling::nothing, Filling::fog, Filling::glass, Filling::gold,
                                         Filling::sky, Filling::filter));

// Vertices of one camera path.
std::vector<PathVertex> camera_vertices(const Scene& scene, RayCaster& caster, const Plan& plan) {
  PathRecorder<TransportMode::radiance> recorder(scene, caster);
  recorder.paths().push_back(camera_path(plan, {6, Purpose::camera, 0, 0, 0}, 0));
  recorder.run();
  return recorder.paths().front().vertices;
}

// The pdf of a light vertex is that with which it was sampled, for a vertex on one side of a surface.
TEST(EndDensities, AreThoseThatLightsAreDrawnWith) {
  const Scene scene = room({kPinhole, Filling::sky});
  RayCaster caster(scene);
  const Plan plan = make_plan(scene);
  const PathVertex lit = camera_vertices(scene, caster, plan).at(1);
  ASSERT_TRUE(std::get<SurfaceVertex>(lit.at).light_context().side);
  int skies = 0;
  for (std::uint32_t i = 0; i < 64; ++i) {
    const auto light = sample_light_vertex(plan, lit, Sampler(7, Purpose::pilot, 0, 0, i).group(0));
    if (!light) continue;
    skies += scene.lights[std::get<LightVertex>(light->at).light].is_environment();
    EXPECT_NEAR(end_densities(plan, lit, *light).light_connection / light->pdf_forward[0], 1, 1e-5);
  }
  EXPECT_GT(skies, 0);
}

// Example: the rim of a narrow sun, which a sampled direction may miss after rounding.
TEST(StrategyWeights, WhatIsDrawnWithNoDensityWeighsNothing) {
  const Scene scene = room({kPinhole, Filling::nothing});
  RayCaster caster(scene);
  const Plan plan = make_plan(scene);
  const std::vector<PathVertex> x = camera_vertices(scene, caster, plan);
  const auto light = sample_light_vertex(plan, x.at(1), {0.5F, 0.5F, 0.5F, 0.5F});
  ASSERT_TRUE(light);
  const JoinedPath path{.z = {&x[0], &x[1], &*light}, .t = 2};
  StrategyWeights weights(scene, caster);
  EndDensities ends = end_densities(plan, x[1], *light);
  EXPECT_GT(weights.weight_of(path, ends), 0);
  EXPECT_GT(weights.path_tracing_fraction(), 0);
  ends.light_connection = 0;
  std::feclearexcept(FE_ALL_EXCEPT);
  EXPECT_EQ(weights.weight_of(path, ends), 0);
  EXPECT_EQ(weights.path_tracing_fraction(), 0);
  EXPECT_EQ(std::fetestexcept(FE_DIVBYZERO | FE_INVALID), 0);
}

// A path that glass refracts or reflects has the same pdfs whichever end records it.
TEST(RecordedPaths, SingleDirectionsAreAsDenseFromEitherEnd) {
  const Bsdf glass = DielectricBsdf{SampledSpectrum(1.5F), false};
  const auto at = [&glass](const V3f& wo) {
    return SurfaceVertex({V3f(0), V3f(0, 0, 1), 0, 0}, Basis<float>(V3f(0, 0, 1)), wo, glass);
  };
  for (const V3f& wo : {V3f(0.6F, 0, 0.8F), V3f(0, 0.28F, -0.96F)})
    for (const float lobe : {0.001F, 0.9F}) {
      const SurfaceVertex there = at(wo);
      const auto radiance = there.scatter({lobe, {}}, 0, TransportMode::radiance);
      const SurfaceVertex back = at(radiance->wi);
      const auto power = back.scatter({lobe, {}}, 0, TransportMode::power);
      ASSERT_LT((power->wi - wo).length(), 1e-6);
      const auto camera = PathRecorder<TransportMode::radiance>::single_direction(there, *radiance, 0);
      const auto light = PathRecorder<TransportMode::power>::single_direction(back, *power, 0);
      EXPECT_NEAR(light.forward[0] / camera.reverse[0], 1, 1e-5);
      EXPECT_NEAR(light.reverse[0] / camera.forward[0], 1, 1e-5);
      // dw_light/dw_camera is 1 for a mirror, and here n_c^2 cos_c / (n_l^2 cos_l).
      const float n = radiance->transmitted ? (wo.z > 0 ? 1 / 1.5F : 1.5F) : 1;
      EXPECT_NEAR(camera.reverse[0] / camera.forward[0], n * n * std::abs(wo.z / radiance->wi.z), 1e-5);
    }
}

// Solid angle of a scattering vertex per area, or per volume, as viewed from another vertex.
float seen_size(const PathVertex& from, const PathVertex& to) {
  const V3f d = point_of(to) - point_of(from);
  const auto* surface = std::get_if<SurfaceVertex>(&to.at);
  const float cosine = surface != nullptr ? std::abs(surface->hit.normal.dot(d.normalized())) : 1.0F;
  return cosine / d.length2();
}

// The probability of passing from one vertex to the next is the product of those of the segments between.
TEST(RecordedPaths, DensitiesAreProductsOfTheirPieces) {
  for (const Filling filling : {Filling::nothing, Filling::fog}) {
    const Scene scene = room({kLens, filling});
    RayCaster caster(scene);
    const Plan plan = make_plan(scene);
    PathRecorder<TransportMode::radiance> recorder(scene, caster);
    for (std::uint32_t i = 0; i < kBatch; ++i)
      recorder.paths().push_back(camera_path(plan, {6, Purpose::camera, 0, 0, i}, i));
    recorder.run();
    int within = 0;
    for (const RecordedPath& path : recorder.paths()) {
      // f_0 G f_1 G ... for all wavelengths, and the pdfs of all vertices.
      SampledSpectrum flux(1.0F);
      SampledSpectrum density = path.vertices[0].pdf_forward;
      const auto hero = static_cast<int>(path.packet.hero);
      for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
        const PathVertex& from = path.vertices[i];
        const PathVertex& to = path.vertices[i + 1];
        const PathSegment way = segment_between(from, to);
        flux *= eval_towards(scene, from, way.direction, TransportMode::radiance) * seen_size(from, to) *
                transmission_along(scene, caster, from, way).transmittance;
        if (std::holds_alternative<MediumVertex>(to.at)) {
          ++within;
          flux *= medium(scene.materials[2])->scattering_per_m(path.lambda_nm());
        }
        density *= to.pdf_forward;
        for (int j = 0; j < kLanes; ++j) {
          EXPECT_NEAR(to.packet.lane_pdf[j] / to.packet.lane_pdf[hero] * density[hero] / density[j], 1, 2e-3);
          EXPECT_NEAR(to.packet.throughput[j] / to.packet.lane_pdf[hero] * density[hero] / flux[j], 1, 2e-3);
        }
      }
      for (std::size_t i = 1; i + 2 < path.vertices.size(); ++i) {
        const PathVertex& to = path.vertices[i];
        const PathVertex& from = path.vertices[i + 1];
        const PathSegment back = segment_between(from, to);
        const SampledSpectrum expected =
            direction_pdf(scene, from, segment_between(from, path.vertices[i + 2]).direction,
                          back.direction) *
            seen_size(from, to) * transmission_along(scene, caster, from, back).pdf * to.event_pdf;
        for (int j = 0; j < kLanes; ++j) EXPECT_NEAR(to.pdf_reverse[j] / expected[j], 1, 2e-3);
      }
    }
    EXPECT_EQ(within > 50, filling == Filling::fog);
  }
}

// A medium so dense that free paths are shorter than the float resolution of positions.
TEST(RecordedPaths, HaveAPlaceForEachOfTheirVertices) {
  Scene scene = room({kPinhole, Filling::fog});
  auto& fog = std::get<MediumMaterial>(scene.materials[2].model);
  fog.interior_medium.scattering_per_m = Curve(1e8);
  scene.render.max_depth = 20;
  scene.commit();
  RayCaster caster(scene);
  const Plan plan = make_plan(scene);
  PathRecorder<TransportMode::radiance> recorder(scene, caster);
  for (std::uint32_t i = 0; i < kBatch; ++i)
    recorder.paths().push_back(camera_path(plan, {6, Purpose::camera, 0, 0, i}, i));
  recorder.run();
  int within = 0;
  for (const RecordedPath& path : recorder.paths())
    for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
      const PathVertex& to = path.vertices[i + 1];
      within += std::holds_alternative<MediumVertex>(to.at) ? 1 : 0;
      EXPECT_GT(segment_between(path.vertices[i], to).distance, 0);
      EXPECT_TRUE(std::isfinite(to.pdf_forward.max()));
    }
  EXPECT_GT(within, 2000);
}

}  // namespace
}  // namespace abbe
