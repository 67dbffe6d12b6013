// Paths of two kinds that are recorded and joined: however a path is split between both ends, the light is
// the same.
#include <gtest/gtest.h>

#include <span>

#include "scene/lights/emission.h"
#include "spectral/sources.h"
#include "transport/path/path_recorder.h"
#include "transport/plan/plan.h"

namespace abbe {
namespace {

using Imath::V3f;

constexpr std::uint32_t kCount = 1 << 15;
constexpr std::uint32_t kBatch = 1 << 10;

struct Look {
  Camera camera;
  bool fog;
};

// A coloured wall, a rough golden panel and a lamp, all apart from one another; with fog, a ball of it that
// scatters and absorbs unevenly hangs before the wall.
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
  if (look.fog) {
    MediumMaterial thin;
    thin.filling.scattering_per_m = Curve({{300, 0.2}, {1100, 0.6}});
    thin.filling.absorption_per_m = Curve(0.1);
    thin.filling.phase = HenyeyGreensteinPhase{0.4F};
    scene.materials.push_back({"fog", thin});
    scene.shapes.push_back({"fog", Sphere{{0, 0, 2.4}, 1}, 2});
  }
  scene.render.roulette_depth = -1;
  scene.render.max_depth = 3;
  scene.commit();
  return scene;
}

const CameraFrame kFrame{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const Camera kPinhole{Pinhole{kFrame, 0.05, 0.005}, 1, 1, 0.04};
const Camera kLens{ThinLens{kFrame, 0.05, 2, 0.05}, 1, 1, 0.04};

RecordedPath camera_path(const Scene& scene, const Plan& plan, const Sampler& sampler, std::uint32_t i) {
  const auto film = sampler.group(kFilmGroup);
  const auto lens = sampler.group(kLensGroup);
  RecordedPath path(sampler, i);
  path.packet = draw_packet(plan.wavelengths, film[2]);
  const CameraRay start =
      sample_ray(scene.camera, {film[0], film[1]}, {lens[0], lens[1]}, path.lambda_nm(), film[kTimeNumber]);
  path.ray = start.ray;
  const auto of = density(scene.camera, start.ray, path.lambda_nm());
  path.vertices = {{.at = CameraVertex{start.ray.origin}, .packet = path.packet, .time = start.ray.time}};
  path.vertices[0].pdf_forward = SampledSpectrum(of ? of->pdf_position : 0);
  path.direction_pdf = of ? of->pdf_direction : SampledSpectrum();
  path.packet.throughput *= start.weight;
  return path;
}

// Of the same wavelengths and hero as the camera path it is to be joined to.
RecordedPath light_path(const Scene& scene, const PathPacket& packet, const Sampler& sampler,
                        std::uint32_t i) {
  const auto a = sampler.group(kAimGroup);
  const auto b = sampler.group(kEmissionGroup);
  const Light& light = scene.lights[0];
  const EmissionPoint from = sample_emission_point(light, scene.shapes, {b[0], b[1]});
  const V3f wo = emission_direction(light, from.normal, {a[0], a[1]});
  const EmissionDensity of = emission_density(light, from.normal, wo, 1);
  RecordedPath path(sampler, i);
  path.packet = packet;
  path.packet.throughput = light.emission(packet.wavelengths.lambda_nm) *
                           (from.normal.dot(wo) / (of.pdf_position * of.pdf_direction));
  path.packet.lane_pdf = SampledSpectrum(1.0F);
  path.ray = spawn(from.point, from.normal, wo, a[kTimeNumber]);
  path.vertices = {{.at = LightVertex{0, from.point, from.normal}, .packet = path.packet}};
  path.vertices[0].packet.throughput = SampledSpectrum(1 / of.pdf_position);
  path.vertices[0].pdf_forward = SampledSpectrum(of.pdf_position);
  path.direction_pdf = SampledSpectrum(of.pdf_direction);
  return path;
}

// sum_j f_j/p(lambda_j) / sum_k P_k of two paths that are joined. [Wilkie2014]
double value(const PathVertex& a, const PathVertex& b, const SampledSpectrum& joined) {
  const SampledSpectrum f = a.packet.throughput * b.packet.throughput * joined / a.packet.wavelengths.pdf;
  return static_cast<double>(f.sum() / (a.packet.lane_pdf * b.packet.lane_pdf).sum());
}

struct Estimate {
  double sum = 0;
  double squares = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
  }
  [[nodiscard]] double mean() const { return sum / kCount; }
  [[nodiscard]] double variance() const { return (squares / kCount - mean() * mean()) / kCount; }
};

// Two recorded paths that are joined by their `t`th and `s`th vertices, the first being the ends' own. Where
// t is 0 the camera's point was drawn for the light's path alone.
struct Joint {
  std::span<const PathVertex> x;  ///< From the camera, to the one joined.
  std::span<const PathVertex> y;  ///< From the light, likewise.
  SampledSpectrum contribution;   ///< See `connect`.
};

// Calls `visit` with every way to join paths that scatter `events` times in all.
template <typename Visit>
void join_all(const Scene& scene, RayCaster& caster, int events, Visit visit) {
  const Plan plan = make_plan(scene);
  PathRecorder<TransportMode::radiance> from_camera(scene, caster);
  PathRecorder<TransportMode::power> from_light(scene, caster);
  for (std::uint32_t first = 0; first < kCount; first += kBatch) {
    from_camera.paths().clear();
    from_light.paths().clear();
    for (std::uint32_t i = 0; i < kBatch; ++i) {
      from_camera.paths().push_back(camera_path(scene, plan, {5, Purpose::camera, 0, 0, first + i}, i));
      from_light.paths().push_back(
          light_path(scene, from_camera.paths().back().packet, {5, Purpose::light, 0, 0, first + i}, i));
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
        PathVertex lens = x[0];
        if (t == 0) {
          const auto seen = sample_towards(scene.camera, point_of(y[s]), {u[0], u[1]}, y[s].lambda_nm(), 0);
          if (!seen) continue;
          lens.at = CameraVertex{seen->lens_point};
          lens.packet.throughput = SampledSpectrum(1 / lens.pdf_forward[0]);
        }
        const std::span<const PathVertex> camera =
            t == 0 ? std::span<const PathVertex>(&lens, 1) : std::span(x).first(t + 1);
        const auto joined = connect(scene, caster, camera.back(), y[s]);
        if (joined) visit(Joint{camera, std::span(y).first(s + 1), joined->contribution});
      }
    }
  }
}

// By how many of the events are the light's path's.
std::vector<Estimate> strategies(const Scene& scene, int events) {
  RayCaster caster(scene);
  std::vector<Estimate> found(static_cast<std::size_t>(events) + 1);
  join_all(scene, caster, events, [&](const Joint& joint) {
    found[joint.y.size() - 1].add(value(joint.x.back(), joint.y.back(), joint.contribution));
  });
  return found;
}

// Density of the vertex `to`, drawn from `from`, which came from or goes to `before`.
SampledSpectrum density_between(const Scene& scene, RayCaster& caster, const PathVertex* before,
                                const PathVertex& from, const PathVertex& to) {
  const V3f back = before != nullptr ? way_from(from, *before).direction : V3f(0);
  const Way way = way_from(from, to);
  return direction_pdf(scene, from, back, way.direction) * solid_angle_per_area(scene, from, to) *
         transmission_along(scene, caster, from, way).density * to.event_pdf;
}

// sum_j f_j/p(lambda_j) / sum_st sum_k P_st,k: the balance heuristic over all strategies and lanes, with the
// densities that the vertices hold and those across the joint.
double balanced(const Scene& scene, RayCaster& caster, const Joint& joint) {
  const std::size_t n = joint.x.size();
  const std::size_t m = joint.y.size();
  std::vector<const PathVertex*> all;
  for (const PathVertex& vertex : joint.x) all.push_back(&vertex);
  for (std::size_t j = m; j-- > 0;) all.push_back(&joint.y[j]);
  const auto at = [&](std::size_t i) { return i < all.size() ? all[i] : nullptr; };
  std::vector<SampledSpectrum> by_camera(n + m);
  std::vector<SampledSpectrum> by_light(n + m);
  for (std::size_t i = 0; i < n + m; ++i) {
    const bool own = i < n;
    const bool near_joint = own ? i + 2 >= n : i < n + 2;
    by_camera[i] = own          ? all[i]->pdf_forward
                   : near_joint ? density_between(scene, caster, at(i - 2), *all[i - 1], *all[i])
                                : all[i]->pdf_reverse;
    by_light[i] = !own         ? all[i]->pdf_forward
                  : near_joint ? density_between(scene, caster, at(i + 2), *all[i + 1], *all[i])
                               : all[i]->pdf_reverse;
  }
  SampledSpectrum sum;
  SampledSpectrum ours;
  for (std::size_t split = 1; split < n + m; ++split) {
    SampledSpectrum product(1.0F);
    for (std::size_t i = 0; i < n + m; ++i) product *= i < split ? by_camera[i] : by_light[i];
    sum += product;
    if (split == n) ours = product;
  }
  // Throughputs and lane densities of a packet have a unit in common.
  const PathPacket& a = joint.x.back().packet;
  const PathPacket& b = joint.y.back().packet;
  const SampledSpectrum f = a.throughput * b.throughput * joint.contribution / a.wavelengths.pdf *
                            (ours[a.hero] / (a.lane_pdf[a.hero] * b.lane_pdf[b.hero]));
  return static_cast<double>(f.sum() / sum.sum());
}

TEST(Strategies, FindTheSameLight) {
  for (const Camera& camera : {kPinhole, kLens})
    for (int events = 1; events <= 3; ++events) {
      const Scene scene = room({camera, false});
      const std::vector<Estimate> found = strategies(scene, events);
      for (std::size_t s = 0; s < found.size(); ++s) {
        EXPECT_GT(found[s].mean(), 0) << s;
        EXPECT_NEAR(found[s].mean() / found[0].mean(), 1,
                    4.5 * std::sqrt(found[s].variance() + found[0].variance()) / found[0].mean())
            << events << " events, " << s << " of them from the light";
      }
    }
}

// Within fog a connection between two of its points has no finite variance: only the outermost strategies.
TEST(Strategies, FindTheSameLightThroughFog) {
  const Scene scene = room({kPinhole, true});
  for (int events = 1; events <= 2; ++events) {
    const std::vector<Estimate> found = strategies(scene, events);
    const Estimate& camera = found.front();
    const Estimate& light = found.back();
    EXPECT_NEAR(light.mean() / camera.mean(), 1,
                4.5 * std::sqrt(light.variance() + camera.variance()) / camera.mean())
        << events << " events";
  }
}

// Weighed over all of them by the densities that are stored, they add up to the same again, and to less noise
// than the best of them alone.
TEST(Strategies, AddUpBalanced) {
  for (const bool fog : {false, true})
    for (int events = 1; events <= 3; ++events) {
      const Scene scene = room({kLens, fog});
      RayCaster caster(scene);
      Estimate sum;
      std::vector<Estimate> alone(static_cast<std::size_t>(events) + 1);
      join_all(scene, caster, events, [&](const Joint& joint) {
        sum.add(balanced(scene, caster, joint));
        alone[joint.y.size() - 1].add(value(joint.x.back(), joint.y.back(), joint.contribution));
      });
      const Estimate& path_tracing = alone.front();
      EXPECT_NEAR(sum.mean() / path_tracing.mean(), 1,
                  4.5 * std::sqrt(sum.variance() + path_tracing.variance()) / path_tracing.mean())
          << events << " events" << (fog ? " through fog" : "");
      for (const Estimate& one : alone) EXPECT_LT(sum.variance(), 1.1 * one.variance());
    }
}

// The solid angle of a scattering vertex per its area, or per its volume, as another one sees it.
float seen_size(const PathVertex& from, const PathVertex& to) {
  const V3f d = point_of(to) - point_of(from);
  const auto* surface = std::get_if<SurfaceVertex>(&to.at);
  const float cosine = surface != nullptr ? std::abs(surface->hit.normal.dot(d.normalized())) : 1.0F;
  return cosine / d.length2();
}

// From one vertex to the next a recorded path has gone with the product of the densities of its pieces.
TEST(RecordedPaths, DensitiesAreProductsOfTheirPieces) {
  for (const bool fog : {false, true}) {
    const Scene scene = room({kLens, fog});
    RayCaster caster(scene);
    const Plan plan = make_plan(scene);
    PathRecorder<TransportMode::radiance> recorder(scene, caster);
    for (std::uint32_t i = 0; i < kBatch; ++i)
      recorder.paths().push_back(camera_path(scene, plan, {6, Purpose::camera, 0, 0, i}, i));
    recorder.run();
    int within = 0;
    for (const RecordedPath& path : recorder.paths()) {
      // f_0 G f_1 G ... of all lanes, and the densities of all vertices.
      SampledSpectrum flux(1.0F);
      SampledSpectrum density = path.vertices[0].pdf_forward;
      const auto hero = static_cast<int>(path.packet.hero);
      for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i) {
        const PathVertex& from = path.vertices[i];
        const PathVertex& to = path.vertices[i + 1];
        const Way way = way_from(from, to);
        flux *= sent_towards(scene, from, way.direction, TransportMode::radiance) * seen_size(from, to) *
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
        const Way back = way_from(from, to);
        const SampledSpectrum expected =
            direction_pdf(scene, from, way_from(from, path.vertices[i + 2]).direction, back.direction) *
            seen_size(from, to) * transmission_along(scene, caster, from, back).density * to.event_pdf;
        for (int j = 0; j < kLanes; ++j) EXPECT_NEAR(to.pdf_reverse[j] / expected[j], 1, 2e-3);
      }
    }
    EXPECT_EQ(within > 50, fog);
  }
}

}  // namespace
}  // namespace abbe
