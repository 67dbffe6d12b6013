#include <memory>
#include <type_traits>
#include <utility>

#include <benchmark/benchmark.h>

#include "materials/bsdf.h"
#include "materials/bsdf/rough.h"
#include "materials/bsdf/warp.h"
#include "materials/index/library.h"
#include "materials/interface/fresnel.h"
#include "materials/material.h"
#include "validation/bench/micro/inputs.h"

namespace abbe {
namespace {

RefractiveIndex index_of(const char* name) {
  Diagnostics diagnostics;
  const auto loaded = load_index(name, {}, diagnostics);
  if (!loaded) throw Error(ErrorCode::input, name, diagnostics.text());
  return loaded->index;
}

void fresnel_of_glass(benchmark::State& state) {
  micro::NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(fresnel_dielectric(u.next(), 1.78F));
}
BENCHMARK(fresnel_of_glass);

void fresnel_of_metal(benchmark::State& state) {
  micro::NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(fresnel_conductor(u.next(), 0.96F, 6.69F));
}
BENCHMARK(fresnel_of_metal);

// Sellmeier's formula of N-SF11 for a packet.
void index_of_glass(benchmark::State& state) {
  const RefractiveIndex glass = index_of("N-SF11");
  micro::NumberCycle u;
  for (auto _ : state) benchmark::DoNotOptimize(glass.n(u.packet()));
}
BENCHMARK(index_of_glass);

void sample_bsdf(benchmark::State& state, const Bsdf& bsdf) {
  micro::NumberCycle u;
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
  micro::NumberCycle u;
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
  micro::NumberCycle u;
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
  micro::NumberCycle u;
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
  micro::NumberCycle u;
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
  const SampledSpectrum wavelengths = micro::NumberCycle().packet();
  sample_bsdf(state, make_bsdf(material, {wavelengths}));
}
void evaluate_material(benchmark::State& state, MaterialModel (*model)()) {
  const Material material{"material", model()};
  const SampledSpectrum wavelengths = micro::NumberCycle().packet();
  evaluate_bsdf(state, make_bsdf(material, {wavelengths}));
}
MaterialModel coated_diffuse() {
  return CoatedDiffuseMaterial{"N-BK7", index_of("N-BK7"), Curve(0.5)};
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

}  // namespace
}  // namespace abbe
