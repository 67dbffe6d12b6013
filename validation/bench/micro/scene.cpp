#include <benchmark/benchmark.h>

#include "materials/bsdf/warp.h"
#include "scene/scene.h"
#include "validation/bench/meshes.h"
#include "validation/bench/micro/inputs.h"

namespace abbe {
namespace {

Camera pinhole() {
  Pinhole lens;
  lens.image_distance = 0.035;
  lens.aperture_radius = 0.004;
  return {lens, 256, 256, 1e-4};
}

void sample_camera_ray(benchmark::State& state) {
  const Camera camera = pinhole();
  micro::NumberCycle u;
  for (auto _ : state)
    benchmark::DoNotOptimize(sample_ray(camera, u.pair() * 256.0F, {0, 0}, SampledSpectrum(550), 0, 0));
}
BENCHMARK(sample_camera_ray);

void sample_area_light(benchmark::State& state, const Shape& shape) {
  const std::vector<ShapeInstance> shapes{{"lamp", shape, 0, 0}};
  const Light light{"lamp", AreaLight{0, false, area(shape), {}}, Curve(1.0)};
  micro::NumberCycle u;
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
  micro::NumberCycle u;
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

}  // namespace
}  // namespace abbe
