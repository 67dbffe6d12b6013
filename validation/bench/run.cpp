#include "validation/bench/run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "io/data_directory.h"
#include "io/exr.h"
#include "io/text.h"
#include "report/image_difference.h"
#include "spectral/rgb.h"
#include "transport/plan/techniques.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/cost.h"
#include "transport/render/render.h"
#include "transport/render/threads.h"

namespace abbe {
namespace {

// Differs from the seed of every measured render, so that the errors are independent.
constexpr std::uint64_t kReferenceSeed = std::uint64_t{1} << 32;
constexpr int kReferenceFactor = 64;

int reference_samples(const BenchSettings& settings) {
  if (settings.reference_samples > 0) return settings.reference_samples;
  return kReferenceFactor * *std::ranges::max_element(settings.samples);
}

BenchConditions conditions_of(const Scene& scene, const BenchSettings& settings) {
  return {scene.camera.width, scene.camera.height, scene.sha256, reference_samples(settings),
          thread_count(settings.threads)};
}

// `automatic` is resolved first, as every command that renders does.
BenchRow measure(Scene& scene, Integrator integrator, const Image& reference, int samples, std::uint64_t seed,
                 int threads, bool with_replay) {
  scene.render.samples = samples;
  scene.render.seed = seed;
  scene.render.integrator = integrator;
  Cost cost;
  RenderOptions options;
  metered(cost, [&] {
    const IntegratorChoice choice = choose_integrator(scene, thread_count(threads));
    scene.render.integrator = choice.integrator;
    options.guides = choice.guides;
  })();
  options.threads = threads;
  options.measure_replay = with_replay;
  const RenderResult result = render(scene, options);
  const RenderStats& stats = result.stats;
  const Image image = linear_srgb(result.film.image(scene.film_planes()));
  const auto error = [&](ErrorMeasure measure) {
    measure.subtract_variance = true;
    return rel_mse(image, reference, measure);
  };
  BenchRow row{integrator,
               samples,
               seed,
               cost.cpu_s + stats.cpu_s,
               cost.wall_s + stats.wall_s,
               stats.paths,
               stats.rays,
               stats.embree_replay_fraction};
  row.rel_mse = error({.floor = kUsualFloor});
  row.rel_mse_trimmed = error({.floor = kUsualFloor, .trim = kTrimmedFraction});
  row.rel_mse_low = error({.floor = kLowFloor});
  row.n_mse = error({.relative = 0, .floor = 1});
  const ColorDifference color = color_difference(image, reference).value_or(ColorDifference{});
  row.dE00_mean = color.mean;
  row.dE00_p95 = color.p95;
  return row;
}

std::vector<BenchIntegrator> integrators_on(Scene& scene, const std::vector<Integrator>& integrators) {
  std::vector<BenchIntegrator> all;
  for (const Integrator integrator : integrators) {
    scene.render.integrator = integrator;
    all.push_back(
        {integrator, unsampled_paths(scene), std::string(bias_of(chosen_techniques(scene).front()))});
  }
  return all;
}

// Adds `weight` times the figures of `row`.
void accumulate(BenchRow& sum, const BenchRow& row, double weight) {
  for (double BenchRow::*figure : {&BenchRow::cpu_s, &BenchRow::wall_s, &BenchRow::embree_replay_fraction,
                                   &BenchRow::rel_mse, &BenchRow::rel_mse_trimmed, &BenchRow::rel_mse_low,
                                   &BenchRow::n_mse, &BenchRow::dE00_mean, &BenchRow::dE00_p95})
    sum.*figure += weight * row.*figure;
}

namespace fs = std::filesystem;

constexpr std::array kRgb{"R", "G", "B"};

Image render_reference(Scene scene, std::uint64_t seed, int samples, int threads) {
  expose_in_srgb(scene);
  scene.render.seed = seed;
  scene.render.samples = samples;
  RenderOptions options;
  options.threads = threads;
  return render(scene, options).film.image(scene.film_planes());
}

}  // namespace

BenchConditions conditions_of(const BenchSuite& suite, const BenchSettings& settings) {
  return conditions_of(load_suite(suite, settings.cache, settings.quick), settings);
}

SuiteRun run_suite(const BenchSuite& suite, const BenchSettings& settings) {
  const auto say = [&](const std::string& message) {
    if (settings.say) settings.say(suite.name + ": " + message);
  };
  const CostMeter loading;
  Scene scene = load_suite(suite, settings.cache, settings.quick);
  const double load_cpu_s = loading.spent().cpu_s;
  const BenchConditions conditions = conditions_of(scene, settings);
  const int samples = conditions.reference_samples;
  say(fmt::format("reference of {} samples per pixel", samples));
  const Reference reference =
      reference_of(scene, settings.cache, settings.version, kReferenceSeed, samples, settings.threads);
  say(reference.cached ? "the reference was in the cache" : "the reference is rendered");
  SuiteRun run{suite, conditions, load_cpu_s, reference.key, integrators_on(scene, settings.integrators), {}};
  for (const int spp : settings.samples)
    for (int seed = 1; seed <= settings.seeds; ++seed)
      for (const Integrator integrator : settings.integrators) {
        const bool first = run.rows.empty();
        BenchRow row = measure(scene, integrator, reference.image, spp, static_cast<std::uint64_t>(seed),
                               settings.threads, first);
        if (!first) row.embree_replay_fraction = run.rows.front().embree_replay_fraction;
        say(fmt::format("{}, {} samples per pixel, seed {}: {:.3g} s CPU, relRMSE {:.3g}",
                        integrator_name(integrator), spp, seed, row.cpu_s, root_of(row.rel_mse)));
        run.rows.push_back(row);
      }
  return run;
}

std::vector<BenchRow> rows_of(const std::vector<BenchRow>& rows, Integrator integrator) {
  std::vector<BenchRow> own;
  std::ranges::copy_if(rows, std::back_inserter(own),
                       [&](const BenchRow& row) { return row.integrator == integrator; });
  return own;
}

double root_of(double mean_square) {
  return std::sqrt(std::max(0.0, mean_square));
}

std::vector<BenchRow> means_over_seeds(const std::vector<BenchRow>& rows) {
  std::vector<BenchRow> means;
  for (const BenchRow& first : rows) {
    const auto same = [&first](const BenchRow& row) {
      return row.integrator == first.integrator && row.samples == first.samples;
    };
    if (std::ranges::any_of(means, same)) continue;
    const auto count = static_cast<double>(std::ranges::count_if(rows, same));
    BenchRow mean;
    mean.integrator = first.integrator;
    mean.samples = first.samples;
    mean.paths = first.paths;
    mean.rays = first.rays;
    for (const BenchRow& row : rows)
      if (same(row)) accumulate(mean, row, 1 / count);
    means.push_back(mean);
  }
  return means;
}

bool RankingEntry::is_eligible() const {
  return by.integrator != Integrator::automatic && by.unsampled.empty() && by.bias.empty();
}

std::vector<RankingEntry> ranking(const SuiteRun& run) {
  std::vector<RankingEntry> all;
  for (const BenchIntegrator& by : run.integrators) {
    const std::vector<BenchRow> means = means_over_seeds(rows_of(run.rows, by.integrator));
    if (means.empty()) continue;
    const BenchRow& last = means.back();
    all.push_back({by, last.cpu_s * last.rel_mse, last.cpu_s * last.rel_mse_trimmed});
  }
  return all;
}

const RankingEntry* best_single(std::span<const RankingEntry> all, double RankingEntry::*cost) {
  const RankingEntry* best = nullptr;
  for (const RankingEntry& one : all)
    if (one.is_eligible() && one.*cost > 0 && (best == nullptr || one.*cost < best->*cost)) best = &one;
  return best;
}

Image linear_srgb(const Image& film) {
  Image image{film.width, film.height, {}, {}};
  const bool rgb = film.find("R") != nullptr;
  const Matrix3 matrix = rgb ? Matrix3() : rgb_to_xyz(kRec709).inverse();
  std::array<const ImageChannel*, 3> from{};
  for (std::size_t i = 0; i < 3; ++i) {
    from[i] = film.find(rgb ? kRgb[i] : std::array{"X", "Y", "Z"}[i]);
    if (from[i] == nullptr) throw Error(ErrorCode::internal, "film", "neither X, Y, Z nor R, G, B");
    image.channels.push_back({kRgb[i], std::vector<float>(film.pixels())});
  }
  for (std::size_t p = 0; p < film.pixels(); ++p) {
    const auto value = multiply(matrix, {from[0]->values[p], from[1]->values[p], from[2]->values[p]});
    for (std::size_t i = 0; i < 3; ++i) image.channels[i].values[p] = static_cast<float>(value[i]);
  }
  return image;
}

void expose_in_srgb(Scene& scene) {
  if (scene.channels.size() != 3 || scene.channels.front().name != "X") return;
  const Matrix3 matrix = rgb_to_xyz(kRec709).inverse();
  const std::vector<Channel> xyz = scene.channels;
  for (int i = 0; i < 3; ++i) {
    Curve weight(0.0);
    for (int j = 0; j < 3; ++j)
      weight = sum(weight, scaled(xyz[static_cast<std::size_t>(j)].weight, matrix[i][j]));
    scene.channels[static_cast<std::size_t>(i)] =
        energy_channel(kRgb[static_cast<std::size_t>(i)], std::move(weight));
  }
}

std::string ReferenceKey::text() const {
  return sha256(
      fmt::format("{} {}x{} {} {} {} {}", scene_sha256, width, height, version, data_sha256, seed, samples));
}

Reference reference_of(const Scene& scene, const fs::path& cache, const std::string& version,
                       std::uint64_t seed, int samples, int threads) {
  const ReferenceKey key{scene.sha256, scene.camera.width, scene.camera.height, version, data_sha256(), seed,
                         samples};
  std::error_code ignored;
  fs::create_directories(cache, ignored);
  const fs::path file = cache / (key.text() + ".exr");
  if (fs::is_regular_file(file, ignored)) return {read_exr(file), key.text(), true};
  require_writable(file);
  const Image image = render_reference(scene, seed, samples, threads);
  write_exr(file, image);
  return {image, key.text(), false};
}

}  // namespace abbe
