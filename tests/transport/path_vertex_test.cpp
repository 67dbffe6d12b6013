#include "transport/path/path_vertex.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "scene/lights/light.h"
#include "tests/materials/bsdf_examples.h"
#include "tests/scene/light_kinds.h"
#include "transport/path/path_recorder.h"
#include "transport/plan/plan.h"

namespace abbe {
namespace {

using Imath::V2f;
using Imath::V3f;
using test::all_light_kinds;
using test::Random;

PathPacket packet() {
  PathPacket drawn;
  drawn.wavelengths.lambda_nm = SampledSpectrum({420, 450, 480, 510, 540, 570, 600, 630});
  drawn.wavelengths.pdf = SampledSpectrum(1.0F);
  return drawn;
}

// Vertex at a surface point of a path that arrives from `from`.
PathVertex surface_vertex(const V3f& point, const V3f& normal, const V3f& from, Bsdf bsdf,
                          std::uint32_t shape = 0) {
  const Basis<float> frame(normal);
  PathVertex vertex{.at = SurfaceVertex({point, normal, 0, shape}, frame,
                                        frame.to_local((from - point).normalized()), std::move(bsdf)),
                    .packet = packet()};
  return vertex;
}

PathVertex medium_vertex(const V3f& point, const V3f& along, const PhaseFunction& phase) {
  return {.at = MediumVertex{point, along, phase}, .packet = packet()};
}

SampledSpectrum uneven(float low) {
  return SampledSpectrum(
      {low, low + 0.05F, low + 0.1F, low + 0.2F, low + 0.25F, low + 0.3F, low + 0.35F, low + 0.4F});
}

// Light vertex sampled for `from`, and its pdf in the measure of vertices.
struct DrawnLight {
  PathVertex vertex;
  double pdf;
};
std::optional<DrawnLight> draw_light(const Scene& scene, const V3f& from, V2f u) {
  const Light& light = scene.lights[0];
  const auto sample = sample_light(light, scene.shapes, {from}, u, 0);
  if (!sample) return std::nullopt;
  PathVertex vertex{.at = LightVertex{0, sample->wi, V3f(0), true}, .packet = packet()};
  if (light.at_infinity()) return DrawnLight{vertex, static_cast<double>(sample->pdf)};
  if (const V3f* at = light_position(light)) {
    vertex.at = LightVertex{0, *at};
    return DrawnLight{vertex, 1};
  }
  const auto hit = scene.intersect({from, sample->wi});
  if (!hit || scene.shapes[hit->shape].light != 0) return std::nullopt;
  vertex.at = LightVertex{0, hit->point, hit->normal};
  const double cosine = std::abs(static_cast<double>(hit->normal.dot(sample->wi)));
  if (cosine < 0.02) return std::nullopt;
  return DrawnLight{vertex,
                    static_cast<double>(sample->pdf) * cosine / std::pow(static_cast<double>(hit->t), 2)};
}

template <typename Model>
void expect_lit_from(bool both_sides, bool glossy) {
  const V3f up(0, 0, 1);
  for (const Model& model : examples<Model>())
    for (const V3f& wo : {V3f(0.6F, 0, 0.8F), V3f(-0.36F, 0.48F, -0.8F)}) {
      const auto vertex = std::get<SurfaceVertex>(surface_vertex({0, 0, 0}, up, wo, model).at);
      const LightSampleContext place = vertex.light_context();
      EXPECT_EQ(place.glossy, glossy);
      EXPECT_EQ(place.side, both_sides ? std::nullopt : std::optional(wo.z > 0 ? up : -up));
      bool through = false;
      for (const V3f& way : {V3f(0.6F, 0, 0.8F), V3f(0, -0.6F, 0.8F), V3f(0.1F, 0.2F, 0.97F)}) {
        const V3f beyond = wo.z > 0 ? -way : way;
        through |= !vertex.f(beyond, beyond, TransportMode::radiance).is_zero();
      }
      EXPECT_EQ(through, both_sides);
    }
}

TEST(SurfaceVertex, TellsWhereLightArrives) {
  expect_lit_from<DiffuseBsdf>(false, false);
  expect_lit_from<OrenNayarBsdf>(false, false);
  expect_lit_from<CoatedDiffuseBsdf>(false, false);
  expect_lit_from<PrincipledBsdf>(false, false);
  expect_lit_from<MixtureBsdf>(false, false);
  expect_lit_from<RoughConductorBsdf>(false, true);
  expect_lit_from<CosinePowerBsdf<false>>(false, true);
  expect_lit_from<CosinePowerBsdf<true>>(false, true);
  expect_lit_from<PhongBsdf>(false, true);
  expect_lit_from<RetroreflectorBsdf>(false, true);
  expect_lit_from<RoughDielectricBsdf>(true, true);
}

// A model with a shading normal receives light by the cosine with that normal. With the cosine of the shape's
// normal, connections near the horizon would be unbounded.
TEST(SurfaceVertex, IsLitByTheNormalThatItsModelSees) {
  const V3f turned = V3f(0.6F, 0, 0.8F);
  const Light sky{"sky", EnvironmentLight{}, Curve(1.0)};
  SurfaceVertex vertex({V3f(0), V3f(0, 0, 1), 0, 0}, Basis<float>(turned), V3f(0, 0, 1),
                       DiffuseBsdf{SampledSpectrum(1.0F)});
  vertex.relief = true;
  EXPECT_EQ(vertex.light_context().side, turned);
  Random random(31);
  double sum = 0;
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const auto drawn = sample_light(sky, {}, vertex.light_context(), random.pair(), 0);
    if (!drawn) continue;
    const auto [wi, f, crosses] = vertex.eval_towards(drawn->wi, TransportMode::radiance);
    const double brought = static_cast<double>(f[0] * std::abs(wi.z) / drawn->pdf);
    ASSERT_LT(brought, 1.001);
    sum += brought / kDraws;
  }
  EXPECT_NEAR(sum, 0.9, 0.01) << "(1 + cos)/2 of what a surface sees that is turned against its horizon";
}

// Two points of one flat face see each other along it, whichever side each is on; neither scatters light to
// the other.
TEST(SurfaceVertex, SendsNothingToWhatMayLieOnEitherSide) {
  const PathVertex x = surface_vertex({0, 0, 0}, {0, 0, 1}, {0, 0, 1}, DiffuseBsdf{uneven(0.2F)});
  const auto sent = [&](float cosine) {
    return std::get<SurfaceVertex>(x.at).eval_towards({1, 0, cosine}, TransportMode::radiance).f;
  };
  for (const float cosine : {0.0F, 2e-7F, -2e-7F}) EXPECT_TRUE(sent(cosine).is_zero()) << cosine;
  EXPECT_FALSE(sent(1e-6F).is_zero());
}

// The connection equals that of the path tracer, f |cos| L factor/p for the sampled direction, for each kind
// of light.
TEST(Connect, ToALightIsWhatPathTracingAdds) {
  for (const auto& [name, scene] : all_light_kinds()) {
    RayCaster caster(scene);
    Random random(1);
    int connected = 0;
    for (int i = 0; i < 300; ++i) {
      const V3f point(random.uniform() - 0.5F, random.uniform() - 0.5F, 0.05F);
      const V2f u = random.pair();
      const PathVertex x = surface_vertex(point, {0, 0, 1}, {0.3F, 0.4F, 2}, DiffuseBsdf{uneven(0.2F)});
      const auto sample = sample_light(scene.lights[0], scene.shapes, {point}, u, 0);
      const auto light = draw_light(scene, point, u);
      if (!sample || !light || sample->wi.z < 0.01F) continue;
      const auto joined = connect(scene, caster, x, light->vertex);
      ASSERT_TRUE(joined) << name;
      ++connected;
      for (int j = 0; j < kLanes; ++j) {
        const double added = static_cast<double>(uneven(0.2F)[j]) / std::numbers::pi *
                             static_cast<double>(sample->wi.z * sample->factor / sample->pdf);
        EXPECT_NEAR(static_cast<double>(joined->contribution[j]) / light->pdf / added, 1, 2e-3) << name;
      }
    }
    EXPECT_GT(connected, 50) << name;
  }
}

// A path from infinity passes a ball of fog to a card. The pdf of its first surface vertex is that of the
// light's direction per area of the card, times the passing probability of each wavelength.
TEST(PathRecorder, TellsWhatFogLeavesOfLightFromInfinity) {
  Scene scene = test::lit_by(DirectionalLight{{0, 0, -1}});
  MediumMaterial fog;
  fog.interior_medium.scattering_per_m = Curve({{300, 0.2}, {1100, 0.6}});
  fog.interior_medium.absorption_per_m = Curve(0.1);
  scene.materials = {{"card", DiffuseMaterial{Curve(0.5)}}, {"fog", fog}};
  scene.shapes = {{"card", Quad{{-5, -5, 3}, {10, 0, 0}, {0, 10, 1}}, 0}, {"ball", Sphere{{0, 0, 0}, 1}, 1}};
  scene.render.max_depth = 1;
  scene.commit();
  RayCaster caster(scene);
  PathRecorder<TransportMode::power> recorder(scene, caster);
  for (std::uint32_t i = 0; i < 64; ++i) {
    RecordedPath& path = recorder.paths().emplace_back(Sampler(1, Purpose::light, 0, 0, i), i);
    path.packet = packet();
    path.ray = ray_at({0, 0, -4}, {0, 0, 1}, 0);
    path.vertices = {{.at = LightVertex{0, {0, 0, -1}, V3f(0), true}, .packet = path.packet}};
  }
  recorder.run();
  int through = 0;
  for (const RecordedPath& path : recorder.paths()) {
    const PathVertex& first = path.vertices.at(1);
    if (!std::holds_alternative<SurfaceVertex>(first.at)) continue;
    ++through;
    const double cosine = 10 / std::hypot(10, 1);
    for (int j = 0; j < kLanes; ++j) {
      const double per_m = 0.1 + 0.2 + 0.4 * (static_cast<double>(first.lambda_nm()[j]) - 300) / 800;
      EXPECT_NEAR(static_cast<double>(first.pdf_forward[j]) / (cosine * std::exp(-2 * per_m)), 1, 1e-4);
    }
  }
  EXPECT_GT(through, 10);
  EXPECT_LT(through, 54);
}

// Paths within a white sphere, recorded for connection: a fraction (64/n)^2 exceeds n > 64 events, so that
// their mean length is 128.
TEST(PathRecorder, EndsLongPathsSoon) {
  Scene scene = test::lit_by(PointLight{{0, 0, 0.5F}});
  scene.materials = {{"white", DiffuseMaterial{Curve(0.999)}}};
  scene.shapes = {{"wall", Sphere{{0, 0, 0}, 1}, 0}};
  scene.commit();
  RayCaster caster(scene);
  PathRecorder<TransportMode::power> recorder(scene, caster);
  constexpr std::uint32_t kPaths = 1000;
  for (std::uint32_t i = 0; i < kPaths; ++i) {
    RecordedPath& path = recorder.paths().emplace_back(Sampler(1, Purpose::light, 0, 0, i), i);
    path.packet = packet();
    path.ray = ray_at({0, 0, 0.5F}, {0, 0, 1}, 0);
    path.vertices = {{.at = LightVertex{0, {0, 0, 0.5F}}, .packet = path.packet}};
  }
  recorder.run();
  double events = 0;
  for (const RecordedPath& path : recorder.paths()) events += path.depth;
  EXPECT_NEAR(events / kPaths, 128, 20);
}

// Paths in an almost infinite cloud: a fraction n^(-1/2) is still within it after n events without roulette,
// and (64/n)^(1/2) of these survive roulette.
TEST(PathRecorder, EndsLongPathsInMatterNoSoonerThanOthers) {
  Scene scene = test::lit_by(DirectionalLight{{0, 0, -1}});
  MediumMaterial cloud;
  cloud.interior_medium.scattering_per_m = Curve(1e5);
  scene.materials = {{"cloud", cloud}};
  scene.shapes = {{"ball", Sphere{{0, 0, 0}, 1}, 0}};
  scene.render.max_depth = 260;
  scene.commit();
  RayCaster caster(scene);
  PathRecorder<TransportMode::power> recorder(scene, caster);
  for (std::uint32_t i = 0; i < 8000; ++i) {
    RecordedPath& path = recorder.paths().emplace_back(Sampler(1, Purpose::light, 0, 0, i), i);
    path.packet = packet();
    path.ray = ray_at({0, 0, -4}, {0, 0, 1}, 0);
    path.vertices = {{.at = LightVertex{0, {0, 0, -1}, V3f(0), true}, .packet = path.packet}};
  }
  recorder.run();
  const auto longer = [&recorder](int events) {
    return static_cast<double>(std::count_if(recorder.paths().begin(), recorder.paths().end(),
                                             [&](const RecordedPath& path) { return path.depth >= events; }));
  };
  EXPECT_NEAR(longer(256) / longer(64), 0.25, 0.06);
}

// BSDFs of both ends, G and the transmittance of fog are equal in both directions between reciprocal
// vertices.
TEST(Connect, IsSymmetric) {
  const Scene scene = test::lit_by(PointLight{{0, 0, 9}});
  RayCaster caster(scene);
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const V3f p(random.uniform(), random.uniform(), 0.2F + random.uniform());
    const V3f q(random.uniform() - 2, random.uniform(), 0.2F + random.uniform());
    const std::vector<PathVertex> ends{
        surface_vertex(p, V3f(-0.6F, 0, 0.8F), p + V3f(-1, 0.2F, 1), DiffuseBsdf{uneven(0.1F)}),
        surface_vertex(q, V3f(0.6F, 0, 0.8F), q + V3f(1, 0.2F, 1), DiffuseBsdf{uneven(0.4F)}),
        medium_vertex(q, V3f(0, 0.6F, 0.8F), HenyeyGreensteinPhase{0.5F}),
        medium_vertex(p, V3f(1, 0, 0), RayleighPhase{})};
    for (const auto& [a, b] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 3), std::pair(2, 3)}) {
      const PathVertex& x = ends[static_cast<std::size_t>(a)];
      const PathVertex& y = ends[static_cast<std::size_t>(b)];
      const auto there = connect(scene, caster, x, y);
      const auto back = connect(scene, caster, y, x);
      ASSERT_EQ(there.has_value(), back.has_value()) << a << " to " << b;
      if (!there) continue;
      for (int j = 0; j < kLanes; ++j)
        EXPECT_NEAR(there->contribution[j] / back->contribution[j], 1, 1e-5) << a << " to " << b;
    }
  }
}

// A lens of a millionth of a micrometre next to a card: products of small factors, or of large ones, are
// outside the range of floats.
TEST(Connect, HoldsWhatIsSmallAndLargeByTurns) {
  const Scene scene = test::lit_by(PointLight{{0, 0, 9}});
  RayCaster caster(scene);
  PathVertex a = surface_vertex({0, 0, 0.2F}, {0, 0, 1}, {0, 0, 1}, DiffuseBsdf{SampledSpectrum(1e25F)});
  PathVertex b =
      surface_vertex({1e-8F, 0, 0.4F}, {0, 0, -1}, {0, 0, 0.1F}, DiffuseBsdf{SampledSpectrum(1e25F)});
  const auto plain = connect(scene, caster, a, b);
  ASSERT_TRUE(plain);
  EXPECT_FALSE(std::isfinite(plain->contribution[0]));
  a.packet.throughput = b.packet.throughput = SampledSpectrum(1e-25F);
  const auto joined = connect(scene, caster, a, b);
  ASSERT_TRUE(joined);
  EXPECT_NEAR(joined->contribution[0], 1 / (0.04 * std::numbers::pi * std::numbers::pi), 1e-5);
}

// Connections from the wall of a ball of absorbing rough glass: inwards through the glass, outwards through
// air.
TEST(Connect, RunsThroughWhatLiesOnTheSideItLeavesTo) {
  Scene scene{};
  scene.camera = test::pinhole();
  Medium dark;
  dark.absorption_per_m = Curve(2.0);
  scene.materials = {
      {"glass", RoughDielectricMaterial("glass", RefractiveIndex(1.5),
                                        Microfacets<float>{FacetShape::ggx, 0.6F, 0.6F}, dark)}};
  scene.shapes.push_back({"ball", Sphere{{0, 0, 3}, 1}, 0});
  scene.commit();
  RayCaster caster(scene);
  const V3f wall(0, 0, 2);
  PathVertex x =
      surface_vertex(wall, {0, 0, -1}, {0.2F, 0, 0},
                     make_bsdf(scene.materials[0], {packet().wavelengths.lambda_nm, {0, 0}, nullptr}));
  PathVertex clear = x;
  x.media_behind.cross(scene, 0, true);
  for (const auto& [end, distance] :
       {std::pair(V3f(0, 0.1F, 2.8F), std::hypot(0.1, 0.8)), {V3f(0, 0.1F, 1), 0.0}}) {
    const PathVertex y = medium_vertex(end, {1, 0, 0}, IsotropicPhase{});
    const auto through = connect(scene, caster, x, y);
    const auto without = connect(scene, caster, clear, y);
    ASSERT_TRUE(through && without);
    EXPECT_NEAR(through->contribution[2] / without->contribution[2], std::exp(-2 * distance), 1e-5);
  }
}

}  // namespace
}  // namespace abbe
