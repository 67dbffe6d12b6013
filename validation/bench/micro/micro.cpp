#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numbers>
#include <type_traits>
#include <utility>

#include <benchmark/benchmark.h>

#include "description/lens_files.h"
#include "lens/beam.h"
#include "lens/spectral_system.h"
#include "materials/bsdf.h"
#include "materials/bsdf/rough.h"
#include "materials/bsdf/warp.h"
#include "materials/index/library.h"
#include "materials/interface/fresnel.h"
#include "materials/material.h"
#include "scene/scene.h"
#include "sensor/film/film.h"
#include "sensor/response/channel.h"
#include "spectral/wavelength_distribution.h"
#include "transport/technique/path.h"
#include "validation/bench/generated_scene.h"
#include "validation/bench/suite.h"

namespace abbe {
namespace {

// Cyclic sequence of 4096 precomputed numbers in [0, 1), so that a benchmark does not time their generation.
// Each object starts at the beginning of the same sequence.
class NumberCycle {
 public:
  NumberCycle() {
    for (std::size_t i = 0; i < kSize; ++i) {
      const double golden = static_cast<double>(i) * std::numbers::phi;
      numbers_[i] = static_cast<float>(golden - std::floor(golden)) * 0.999999F;
    }
  }
  [[nodiscard]] float next() { return numbers_[at_++ % kSize]; }
  /// The next two numbers, in their order.
  [[nodiscard]] Imath::V2f pair() {
    const float first = next();
    return {first, next()};
  }
  /// Eight wavelengths [nm] in steps of 40 nm, the first in [390, 430). Uses one number.
  [[nodiscard]] SampledSpectrum packet() {
    SampledSpectrum::Values nm;
    const float first = 390 + 40 * next();
    for (std::size_t lane = 0; lane < kLanes; ++lane) nm[lane] = first + 40.0F * static_cast<float>(lane);
    return SampledSpectrum(nm);
  }

 private:
  static constexpr std::size_t kSize = 4096;
  std::array<float, kSize> numbers_{};
  std::size_t at_ = 0;
};

RefractiveIndex index_of(const char* name) {
  Diagnostics diagnostics;
  const auto loaded = load_index(name, {}, diagnostics);
  if (!loaded) throw Error(ErrorCode::input, name, diagnostics.text());
  return loaded->index;
}

void fresnel_of_glass(benchmark::State& state) {
  NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(fresnel_dielectric(u.next(), 1.78F));
}
BENCHMARK(fresnel_of_glass);

void fresnel_of_metal(benchmark::State& state) {
  NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(fresnel_conductor(u.next(), 0.96F, 6.69F));
}
BENCHMARK(fresnel_of_metal);

// Sellmeier's formula of N-SF11 for a packet.
void index_of_glass(benchmark::State& state) {
  const RefractiveIndex glass = index_of("N-SF11");
  NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(glass.n(u.packet()));
}
BENCHMARK(index_of_glass);

void sample_bsdf(benchmark::State& state, const Bsdf& bsdf) {
  NumberCycle u;
  for (auto _ : state) {
    const Imath::V3f wo = cosine_hemisphere(u.pair());
    benchmark::DoNotOptimize(sample(bsdf, wo, {u.next(), u.pair()}, 0, TransportMode::radiance));
  }
}
BENCHMARK_CAPTURE(sample_bsdf, diffuse, DiffuseBsdf{SampledSpectrum(0.5F)});
BENCHMARK_CAPTURE(sample_bsdf, dielectric, DielectricBsdf{SampledSpectrum(1.5F), false});
BENCHMARK_CAPTURE(sample_bsdf, conductor, ConductorBsdf{SampledSpectrum(0.96F), SampledSpectrum(6.69F)});

// Rough gold and flint; f and pdf as next-event estimation evaluates them.
constexpr Microfacets<float> kGround{FacetShape::ggx, 0.2F, 0.2F};
const RoughConductorMaterial& rough_gold() {
  static const RoughConductorMaterial gold("gold", index_of("Au_Johnson"), kGround);
  return gold;
}
const RoughDielectricMaterial& rough_flint() {
  static const RoughDielectricMaterial flint("flint", index_of("N-SF11"), kGround);
  return flint;
}
template <typename Rough>
void sample_rough(benchmark::State& state, const Rough& (*material)()) {
  NumberCycle u;
  for (auto _ : state) {
    const Imath::V3f wo = cosine_hemisphere(u.pair());
    benchmark::DoNotOptimize(
        sample(material().bsdf({u.packet()}), wo, {u.next(), u.pair()}, 0, TransportMode::radiance));
  }
}
BENCHMARK_CAPTURE(sample_rough, rough_metal, rough_gold);
BENCHMARK_CAPTURE(sample_rough, rough_glass, rough_flint);
template <typename Rough>
void evaluate_rough(benchmark::State& state, const Rough& (*material)(), float side) {
  NumberCycle u;
  for (auto _ : state) {
    const Bsdf bsdf = material().bsdf({u.packet()});
    const Imath::V3f wo = cosine_hemisphere(u.pair());
    Imath::V3f wi = cosine_hemisphere(u.pair());
    wi.z *= side;
    benchmark::DoNotOptimize(eval(bsdf, wo, wi, TransportMode::radiance));
    benchmark::DoNotOptimize(pdf(bsdf, wo, wi));
  }
}
BENCHMARK_CAPTURE(evaluate_rough, rough_metal, rough_gold, 1);
BENCHMARK_CAPTURE(evaluate_rough, rough_glass_reflecting, rough_flint, 1);
BENCHMARK_CAPTURE(evaluate_rough, rough_glass_transmitting, rough_flint, -1);

// A thin film of one layer, and the 21 layers of a mirror, on glass and on metal. Each iteration uses a new
// packet.
struct CoatedSurface {
  RefractiveIndex index;
  Coating coating;
};
Coating films(int pairs) {
  Coating coating{{{"low", index_of("MgF2")}, {"high", RefractiveIndex(2.35)}}, {}};
  for (int i = 0; i < pairs; ++i) coating.layers.insert(coating.layers.end(), {{1, 58.5}, {0, 99.6}});
  coating.layers.push_back({pairs > 0 ? 1U : 0U, 99.6});
  return coating;
}
template <typename Model>
void sample_coated(benchmark::State& state, std::type_identity<Model> /*model*/, const char* index_name,
                   int pairs) {
  const CoatedSurface coated{index_of(index_name), films(pairs)};
  NumberCycle u;
  for (auto _ : state) {
    const Bsdf bsdf = Model{u.packet(), &coated.index, &coated.coating};
    const Imath::V3f wo = cosine_hemisphere(u.pair());
    benchmark::DoNotOptimize(sample(bsdf, wo, {u.next(), u.pair()}, 0, TransportMode::radiance));
  }
}
BENCHMARK_CAPTURE(sample_coated, coated_glass, std::type_identity<CoatedDielectricBsdf>(), "N-BK7", 0);
BENCHMARK_CAPTURE(sample_coated, mirror_on_glass, std::type_identity<CoatedDielectricBsdf>(), "N-BK7", 10);
BENCHMARK_CAPTURE(sample_coated, coated_metal, std::type_identity<CoatedConductorBsdf>(), "Al_Rakic", 0);

// f and pdf together, as next-event estimation evaluates them.
void evaluate_bsdf(benchmark::State& state, const Bsdf& bsdf) {
  NumberCycle u;
  for (auto _ : state) {
    const Imath::V3f wo = cosine_hemisphere(u.pair());
    const Imath::V3f wi = cosine_hemisphere(u.pair());
    benchmark::DoNotOptimize(eval(bsdf, wo, wi, TransportMode::radiance));
    benchmark::DoNotOptimize(pdf(bsdf, wo, wi));
  }
}
BENCHMARK_CAPTURE(evaluate_bsdf, diffuse, DiffuseBsdf{SampledSpectrum(0.5F)});

// BSDFs that refer to their material or are made by it.
void sample_material(benchmark::State& state, MaterialModel (*model)()) {
  const Material material{"material", model()};
  const SampledSpectrum wavelengths = NumberCycle().packet();
  sample_bsdf(state, make_bsdf(material, {wavelengths}));
}
void evaluate_material(benchmark::State& state, MaterialModel (*model)()) {
  const Material material{"material", model()};
  const SampledSpectrum wavelengths = NumberCycle().packet();
  evaluate_bsdf(state, make_bsdf(material, {wavelengths}));
}
MaterialModel coated_diffuse() {
  return CoatedDiffuseMaterial{Curve(0.5), "N-BK7", index_of("N-BK7")};
}
MaterialModel mirror() {
  return MirrorMaterial{Curve(0.9)};
}
MaterialModel mixture() {
  const auto part = [](MaterialModel model) {
    return MixtureMaterial::Component{Curve(0.5),
                                      std::make_shared<const Material>(Material{"part", std::move(model)})};
  };
  return MixtureMaterial{{part(coated_diffuse()), part(mirror())}};
}
MaterialModel thin_glass() {
  return ThinGlassMaterial{"N-BK7", index_of("N-BK7"), 0.01};
}
MaterialModel oren_nayar() {
  return OrenNayarMaterial{Curve(0.5), 30};
}
MaterialModel principled() {
  return PrincipledMaterial{Curve(0.5), Principled(PrincipledParameters{.clearcoat = 1})};
}
MaterialModel schlick_mirror() {
  return SchlickMaterial{Curve(0.9)};
}
MaterialModel cosine_power() {
  return CosinePowerMaterial{Curve(0.5), 3, true};
}
MaterialModel phong() {
  return PhongMaterial{Curve(0.5), 30};
}
MaterialModel retroreflector() {
  return RetroreflectorMaterial{Curve(0.5), 30};
}
BENCHMARK_CAPTURE(sample_material, coated_diffuse, coated_diffuse);
BENCHMARK_CAPTURE(sample_material, mirror, mirror);
BENCHMARK_CAPTURE(sample_material, mixture, mixture);
BENCHMARK_CAPTURE(sample_material, thin_glass, thin_glass);
BENCHMARK_CAPTURE(sample_material, oren_nayar, oren_nayar);
BENCHMARK_CAPTURE(sample_material, principled, principled);
BENCHMARK_CAPTURE(sample_material, schlick, schlick_mirror);
BENCHMARK_CAPTURE(sample_material, cosine_power, cosine_power);
BENCHMARK_CAPTURE(sample_material, phong, phong);
BENCHMARK_CAPTURE(sample_material, retroreflector, retroreflector);
BENCHMARK_CAPTURE(evaluate_material, coated_diffuse, coated_diffuse);
BENCHMARK_CAPTURE(evaluate_material, mixture, mixture);
BENCHMARK_CAPTURE(evaluate_material, oren_nayar, oren_nayar);
BENCHMARK_CAPTURE(evaluate_material, principled, principled);
BENCHMARK_CAPTURE(evaluate_material, cosine_power, cosine_power);
BENCHMARK_CAPTURE(evaluate_material, phong, phong);
BENCHMARK_CAPTURE(evaluate_material, retroreflector, retroreflector);

lens::SpectralSystem double_gauss() {
  Diagnostics diagnostics;
  lens::System lens = load_lens("double_gauss", diagnostics).value();
  const double stop_radius = lens::stop_radius(lens);
  return {std::move(lens), stop_radius};
}

// Rays parallel to the axis in front of the first surface.
lens::Ray next_ray(const lens::SpectralSystem& system, NumberCycle& u) {
  const double width = system.stop_radius_mm();
  const Imath::V2f at = u.pair();
  return {{(at.x - 0.5) * width, (at.y - 0.5) * width, -5}, {0, 0, 1}};
}

// The lens has eleven surfaces.
void trace_lens_ray(benchmark::State& state) {
  const lens::SpectralSystem system = double_gauss();
  NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(system.to_image(next_ray(system, u), 550));
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(trace_lens_ray);

void trace_lens_packets(benchmark::State& state) {
  const lens::SpectralSystem system = double_gauss();
  NumberCycle u;
  const SampledSpectrum wavelengths_nm = u.packet();
  for (auto _ : state)
    benchmark::DoNotOptimize(system.to_image(
        {{{next_ray(system, u), wavelengths_nm}, {next_ray(system, u), wavelengths_nm}}}, system.direct()));
  state.SetItemsProcessed(state.iterations() * 2 * kLanes);
}
BENCHMARK(trace_lens_packets);

void trace_lens_ray_out(benchmark::State& state) {
  const lens::SpectralSystem system = double_gauss();
  NumberCycle u;
  for (auto _ : state) {
    lens::Ray ray = next_ray(system, u);
    ray.origin.z = system.image_z();
    const Imath::V3d to(ray.origin.x, ray.origin.y, system.last_z());
    ray.origin.x = ray.origin.y = 0;
    benchmark::DoNotOptimize(system.to_object({ray.origin, (to - ray.origin).normalized()}, 550));
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(trace_lens_ray_out);

Camera pinhole() {
  Pinhole lens;
  lens.image_distance = 0.035;
  lens.aperture_radius = 0.004;
  return {lens, 256, 256, 1e-4};
}

void sample_camera_ray(benchmark::State& state) {
  const Camera camera = pinhole();
  NumberCycle u;
  for (auto _ : state)
    benchmark::DoNotOptimize(sample_ray(camera, u.pair() * 256.0F, {0, 0}, SampledSpectrum(550), 0, 0));
}
BENCHMARK(sample_camera_ray);

void sample_area_light(benchmark::State& state, const Shape& shape) {
  const std::vector<ShapeInstance> shapes{{"lamp", shape, 0, 0}};
  const Light light{"lamp", AreaLight{0, false, area(shape), {}}, Curve(1.0)};
  NumberCycle u;
  for (auto _ : state) {
    const Imath::V2f at = u.pair();
    benchmark::DoNotOptimize(sample_light(light, shapes, {{at.x, at.y, 0}}, u.pair(), 0));
  }
}
BENCHMARK_CAPTURE(sample_area_light, sphere, Sphere{{0, 0, 3}, 0.5});
BENCHMARK_CAPTURE(sample_area_light, quad, Quad{{-0.5, -0.5, 3}, {0, 1, 0}, {1, 0, 0}});

// Terrain with a given number of triangles. Rays start above it in cosine-distributed directions; about half
// of them hit it.
struct Rays {
  Scene scene;
  std::vector<Ray> rays;
};

Rays rays_over_terrain(std::int64_t triangles) {
  Rays all;
  all.scene.materials.push_back({"ground", DiffuseMaterial{Curve(0.5)}});
  const auto cells = static_cast<std::uint32_t>(std::lround(std::sqrt(static_cast<double>(triangles) / 2)));
  all.scene.shapes.push_back({"terrain", make_terrain(cells), 0, -1});
  all.scene.commit();
  NumberCycle u;
  for (int i = 0; i < (1 << 14); ++i) {
    const Imath::V2f at = (u.pair() - Imath::V2f(0.5F, 0.5F)) * 36.0F;
    const Imath::V3f w = cosine_hemisphere(u.pair());
    all.rays.push_back({{at.x, 0.6F, at.y}, {w.x, -w.z, w.y}});
  }
  return all;
}

void intersect_terrain(benchmark::State& state) {
  const Rays all = rays_over_terrain(state.range(0));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(all.scene.intersect(all.rays[i++ % all.rays.size()]));
}
BENCHMARK(intersect_terrain)->Arg(32)->Arg(131072)->Arg(1048352);

void occlusion_over_terrain(benchmark::State& state) {
  const Rays all = rays_over_terrain(state.range(0));
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(all.scene.occluded(all.rays[i++ % all.rays.size()]));
}
BENCHMARK(occlusion_over_terrain)->Arg(32)->Arg(131072)->Arg(1048352);

// The rays of `intersect_terrain` through Embree alone.
void embree_over_terrain(benchmark::State& state) {
  const Rays all = rays_over_terrain(state.range(0));
  std::vector<LoggedRay> log;
  for (const Ray& ray : all.rays) log.push_back({ray, false});
  for (auto _ : state) all.scene.replay(log);
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(log.size()));
}
BENCHMARK(embree_over_terrain)->Arg(32)->Arg(131072)->Arg(1048352);

// X, Y and Z of one packet.
void weigh_channels(benchmark::State& state) {
  const std::vector<Channel> channels = observer_channels(Observer::cie1931);
  NumberCycle u;
  for (auto _ : state) {
    const SampledSpectrum nm = u.packet();
    for (const Channel& channel : channels) benchmark::DoNotOptimize(channel.weight(nm));
  }
}
BENCHMARK(weigh_channels);

// One sample of three channels, in the pixel order of a tile.
void add_to_film(benchmark::State& state) {
  constexpr int kEdge = 256;
  Film film(kEdge, kEdge, 3, 4, 1);
  NumberCycle u;
  std::size_t pixel = 0;
  for (auto _ : state) {
    const std::array<double, 3> values{u.next(), u.next(), u.next()};
    film.add(pixel, 0, values);
    pixel = (pixel + 1) % (std::size_t{kEdge} * kEdge);
  }
}
BENCHMARK(add_to_film);

WavelengthDistribution observer_under(const Curve& light) {
  std::vector<Curve> responses;
  for (const Channel& channel : observer_channels(Observer::cie1931)) responses.push_back(channel.weight);
  return {std::vector{light}, responses};
}

void sample_wavelengths(benchmark::State& state) {
  const WavelengthDistribution wavelengths = observer_under(Curve(1.0));
  NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(wavelengths.sample(u.next()));
}
BENCHMARK(sample_wavelengths);

// Evaluates a curve with a knot every 4 nm for a packet.
void look_up_curve(benchmark::State& state) {
  std::vector<Knot> knots;
  for (int nm = 400; nm <= 700; nm += 4) knots.push_back({static_cast<double>(nm), nm / 700.0});
  const Curve curve(std::move(knots));
  NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(curve(u.packet()));
}
BENCHMARK(look_up_curve);

void sampler_group(benchmark::State& state) {
  std::uint32_t i = 0;
  for (auto _ : state) {
    ++i;
    benchmark::DoNotOptimize(Sampler(1, Purpose::camera, 0, i / 64, i % 64).group(i % 8));
  }
}
BENCHMARK(sampler_group);

// Complete camera paths in the Cornell box, in batches of 256.
void camera_paths(benchmark::State& state) {
  const Scene scene = load_suite(choose_suites({"cornell"}).front(), "", false);
  const Plan plan = make_plan(scene);
  RayCaster caster(scene);
  PathTracer tracer(plan, caster);
  const auto width = static_cast<std::uint32_t>(scene.camera.width);
  std::uint32_t i = 0;
  std::vector<PixelSample> samples;
  for (auto _ : state) {
    samples.clear();
    for (int together = 0; together < 256; ++together) {
      const std::uint32_t pixel = (i++ * 2654435761U) % (width * width);
      samples.push_back({static_cast<int>(pixel % width), static_cast<int>(pixel / width),
                         Sampler(1, Purpose::camera, 0, pixel, 0)});
    }
    tracer.trace(samples, [](std::uint32_t, const FilmPoint&, std::span<const double>) {});
  }
  state.counters["rays/s"] =
      benchmark::Counter(static_cast<double>(caster.rays()), benchmark::Counter::kIsRate);
}
BENCHMARK(camera_paths);

}  // namespace

}  // namespace abbe
