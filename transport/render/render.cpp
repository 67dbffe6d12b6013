#include "transport/render/render.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <utility>
#include <vector>

#include "transport/render/pass.h"
#include "transport/render/plan.h"
#include "transport/render/replay.h"

namespace abbe {
namespace {

// Paths a pass should have: few enough to end within a fraction of a second, so that a stop is soon, many
// enough to make threads worth starting.
constexpr std::uint64_t kPassPaths = 1U << 18;

class Rendering {
 public:
  Rendering(const Scene& scene, const RenderOptions& options)
      : scene_(scene),
        options_(options),
        plan_(make_plan(scene)),
        open_ended_(options.time_limit_s || options.target_error),
        result_{Film(scene.camera.width, scene.camera.height, static_cast<int>(scene.channels.size()),
                     replicate_count(open_ended_ ? std::numeric_limits<int>::max() : scene.render.samples),
                     plan_.nominal_value),
                {}} {
    RenderStats& stats = result_.stats;
    stats.threads = options.threads > 0 ? options.threads
                                        : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
    stats.relative_error = std::numeric_limits<double>::infinity();
  }

  RenderResult run() {
    const std::uint64_t pixels =
        static_cast<std::uint64_t>(scene_.camera.width) * static_cast<std::uint64_t>(scene_.camera.height);
    const std::uint64_t step = std::max<std::uint64_t>(1, kPassPaths / pixels);
    const std::uint64_t end = open_ended_ ? std::numeric_limits<std::uint32_t>::max()
                                          : static_cast<std::uint64_t>(scene_.render.samples);
    while (samples() < end && !finished()) run_pass(std::min(samples() + step, end));
    RenderStats& stats = result_.stats;
    stats.wall_s = elapsed();
    stats.cpu_s = process_cpu_seconds() - cpu_start_;
    stats.relative_error = result_.film.relative_error();
    if (options_.measure_replay) stats.embree_replay_share = measure_replay_share(plan_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::uint64_t samples() const { return result_.stats.samples_per_pixel; }
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  void run_pass(std::uint64_t last) {
    const PassCounts counts =
        Pass(plan_, result_.film, options_.crop, samples(), last).run(result_.stats.threads);
    RenderStats& stats = result_.stats;
    stats.paths += counts.paths;
    stats.rays += counts.rays;
    stats.nonfinite_samples += counts.nonfinite;
    stats.samples_per_pixel = last;
    const auto replicates = static_cast<std::uint64_t>(result_.film.replicates());
    std::vector<std::uint64_t> per_replicate;
    for (std::uint64_t r = 0; r < replicates; ++r)
      per_replicate.push_back((last + replicates - 1 - r) / replicates);
    result_.film.set_samples(std::move(per_replicate));
    look_at_error(replicates);
    if (options_.progress) options_.progress({share(), last, elapsed(), stats.relative_error});
  }

  // The error costs a walk over the film, so it is looked at when the work has grown by a quarter, and known
  // once every replicate has samples.
  void look_at_error(std::uint64_t replicates) {
    if (samples() < replicates || samples() < next_look_ || !(options_.progress || options_.target_error))
      return;
    next_look_ = samples() + samples() / 4;
    result_.stats.relative_error = result_.film.relative_error();
  }

  [[nodiscard]] double share() const {
    const double share = options_.time_limit_s ? elapsed() / *options_.time_limit_s
                         : options_.target_error
                             ? std::pow(*options_.target_error / result_.stats.relative_error, 2)
                             : static_cast<double>(samples()) / scene_.render.samples;
    return std::min(share, 1.0);
  }

  [[nodiscard]] bool finished() {
    result_.stats.interrupted = samples() > 0 && options_.stop != nullptr && options_.stop->load();
    if (result_.stats.interrupted) return true;
    if (options_.time_limit_s && samples() > 0 && elapsed() >= *options_.time_limit_s) return true;
    return options_.target_error && result_.stats.relative_error <= *options_.target_error;
  }

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double cpu_start_ = process_cpu_seconds();
  const Scene& scene_;
  const RenderOptions& options_;
  Plan plan_;
  bool open_ended_;
  RenderResult result_;
  std::uint64_t next_look_ = 0;
};

}  // namespace

int replicate_count(int samples) {
  const auto wanted = static_cast<unsigned>(std::clamp(samples / 16, 2, 8));
  return std::min(static_cast<int>(std::bit_floor(wanted)), samples);
}

RenderResult render(const Scene& scene, const RenderOptions& options) {
  return Rendering(scene, options).run();
}

}  // namespace abbe
