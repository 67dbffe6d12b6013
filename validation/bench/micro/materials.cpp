#include <type_traits>

#include <benchmark/benchmark.h>

#include "materials/bsdf/bsdf.h"
#include "materials/bsdf/warp.h"
#include "materials/index/library.h"
#include "materials/interface/fresnel.h"
#include "materials/model/rough.h"
#include "validation/bench/micro/inputs.h"

namespace abbe {
namespace {

RefractiveIndex index_of(const char* name) {
  Diagnostics diagnostics;
  const auto found = load_index(name, {}, diagnostics);
  if (!found) throw Error(ErrorCode::input, name, diagnostics.text());
  return found->index;
}

void fresnel_of_glass(benchmark::State& state) {
  micro::Stream u;
  for (auto _ : state) benchmark::DoNotOptimize(fresnel_dielectric(u.next(), 1.78F));
}
BENCHMARK(fresnel_of_glass);

void fresnel_of_metal(benchmark::State& state) {
  micro::Stream u;
  for (auto _ : state) benchmark::DoNotOptimize(fresnel_conductor(u.next(), 0.96F, 6.69F));
}
BENCHMARK(fresnel_of_metal);

// Sellmeier's formula of N-SF11 for a packet.
void index_of_glass(benchmark::State& state) {
  const RefractiveIndex glass = index_of("N-SF11");
  micro::Stream u;
  for (auto _ : state) benchmark::DoNotOptimize(glass.n(u.packet()));
}
BENCHMARK(index_of_glass);

void sample_bsdf(benchmark::State& state, const Bsdf& bsdf) {
  micro::Stream u;
  for (auto _ : state) {
    const Imath::V3f wo = cosine_hemisphere(u.pair());
    benchmark::DoNotOptimize(sample(bsdf, wo, {u.next(), u.pair()}, 0, TransportMode::radiance));
  }
}
BENCHMARK_CAPTURE(sample_bsdf, diffuse, DiffuseBsdf{SampledSpectrum(0.5F)});
BENCHMARK_CAPTURE(sample_bsdf, dielectric, DielectricBsdf{SampledSpectrum(1.5F), false});
BENCHMARK_CAPTURE(sample_bsdf, conductor, ConductorBsdf{SampledSpectrum(0.96F), SampledSpectrum(6.69F)});

// Rough gold and flint; f and pdf as light sampling asks for them.
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
  micro::Stream u;
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
  micro::Stream u;
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

// One film, and the 21 layers of a mirror, on glass and on metal; from a packet of its own each time.
struct CoatedMatter {
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
void sample_coated(benchmark::State& state, std::type_identity<Model> /*model*/, const char* matter,
                   int pairs) {
  const CoatedMatter coated{index_of(matter), films(pairs)};
  micro::Stream u;
  for (auto _ : state) {
    const Bsdf bsdf = Model{u.packet(), &coated.index, &coated.coating};
    const Imath::V3f wo = cosine_hemisphere(u.pair());
    benchmark::DoNotOptimize(sample(bsdf, wo, {u.next(), u.pair()}, 0, TransportMode::radiance));
  }
}
BENCHMARK_CAPTURE(sample_coated, coated_glass, std::type_identity<CoatedDielectricBsdf>(), "N-BK7", 0);
BENCHMARK_CAPTURE(sample_coated, mirror_on_glass, std::type_identity<CoatedDielectricBsdf>(), "N-BK7", 10);
BENCHMARK_CAPTURE(sample_coated, coated_metal, std::type_identity<CoatedConductorBsdf>(), "Al_Rakic", 0);

// f and pdf together, as light sampling asks for them.
void evaluate_diffuse(benchmark::State& state) {
  const Bsdf bsdf = DiffuseBsdf{SampledSpectrum(0.5F)};
  micro::Stream u;
  for (auto _ : state) {
    const Imath::V3f wo = cosine_hemisphere(u.pair());
    const Imath::V3f wi = cosine_hemisphere(u.pair());
    benchmark::DoNotOptimize(eval(bsdf, wo, wi, TransportMode::radiance));
    benchmark::DoNotOptimize(pdf(bsdf, wo, wi));
  }
}
BENCHMARK(evaluate_diffuse);

}  // namespace
}  // namespace abbe
