#include "transport/render/render.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "io/error.h"
#include "sensor/response/polarised_channels.h"
#include "transport/render/cost.h"
#include "transport/render/part_films.h"
#include "transport/render/pass.h"
#include "transport/render/pilot.h"
#include "transport/render/technique_balance.h"
#include "transport/render/threads.h"
#include "transport/render/trained_plan.h"

namespace abbe {
namespace {

// Target number of paths of a pass: few enough to end within a fraction of a second, so that a stop takes
// effect soon, and enough to make threads pay off.
constexpr std::uint64_t kPassPaths = 1U << 18;

// Exponent of the power of two that resolves a nanosecond [s].
constexpr int kNanosecond = -30;

// Maximum fraction of the time for checkpoints.
constexpr double kMaxCheckpointFraction = 0.01;

// An error that is not yet known ends a render if it is smaller than the target by this factor.
constexpr double kUnknownErrorFactor = 4;

constexpr std::uint64_t kMaxSamples = std::numeric_limits<std::uint32_t>::max();

bool open_ended(const RenderOptions& options) {
  return options.time_limit_s || options.target_error;
}

Plan balanced_plan(const Scene& scene, const RenderOptions& options, int threads) {
  Plan plan = make_trained_plan(scene, threads, options.guides);
  choose_path_splitting(plan, threads);
  balance_techniques(plan, threads);
  return plan;
}

// Camera paths of a sample in which no pixel skips its path.
std::uint64_t camera_paths(const Camera& camera) {
  return static_cast<std::uint64_t>(camera.width) * static_cast<std::uint64_t>(camera.height);
}

class Rendering {
 public:
  Rendering(const Scene& scene, const RenderOptions& options, std::optional<RenderResult> start)
      : scene_(scene),
        options_(options),
        threads_(thread_count(options.threads)),
        plan_(balanced_plan(scene, options, threads_)),
        requested_(options.samples.value_or(SampleRange{
            0, open_ended(options) ? kMaxSamples : static_cast<std::uint64_t>(scene.render.samples)})),
        step_(std::max<std::uint64_t>(1, kPassPaths / std::max(camera_paths(scene.camera), plan_.photons))),
        result_{Film(scene.camera.width, scene.camera.height, static_cast<int>(scene.film_planes().size()),
                     replicate_count(scene, options), plan_.nominal_value, paths_to_any_pixel(plan_),
                     plan_.path_interval, options.crop),
                {},
                {}} {
    if (options.layers) result_.layers.emplace(layered(result_.film.shape(), options.layers->names.size()));
    if (!options.features.empty())
      result_.features.emplace(options.features, result_.film.shape(), scene.film_planes());
    if (start) {
      if (start->film.shape() != result_.film.shape() ||
          start->layers.has_value() != result_.layers.has_value() ||
          start->features.has_value() != result_.features.has_value())
        throw Error(ErrorCode::input, "render", "the film to resume has another shape");
      result_ = *std::move(start);
    }
    RenderStats& stats = result_.stats;
    stats.threads = threads_;
    stats.processes = options_.mpi_group.size;
    stats.path_splitting = 1 << plan_.log2_splits;
    if (!is_root()) clear_sums();
    if (is_root() && !result_.unfinished && error_is_due() && needs_error()) estimate_error();
    stats.samples_before = samples();
    planning_s_ = elapsed();
  }

  RenderResult run() {
    if (result_.unfinished) run_round({result_.unfinished->samples});
    for (auto round = next_round(); !round.empty() && !broadcast(finished()); round = next_round()) {
      run_round(round);
      if (broadcast(options_.viewer_is_ready && options_.viewer_is_ready())) show();
      if (broadcast(save_is_due())) save();
    }
    reduce_on_root();
    RenderStats& stats = result_.stats;
    if (is_root() && (needs_error() || options_.measure_error) && error_samples_ != samples()) {
      estimate_error();
      report_progress();
    }
    stats.wall_s = elapsed();
    stats.cpu_s = total_cpu_s();
    if (options_.measure_replay) stats.embree_replay_fraction = measure_replay_fraction(plan_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::uint64_t samples() const { return result_.stats.samples_per_pixel; }
  [[nodiscard]] std::uint64_t traced_samples() const { return samples() - result_.stats.samples_before; }
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  [[nodiscard]] bool is_root() const { return options_.mpi_group.rank == 0; }
  [[nodiscard]] bool is_single_process() const { return options_.mpi_group.size == 1; }
  [[nodiscard]] std::uint64_t broadcast(std::uint64_t value) const {
    return is_single_process() ? value : options_.mpi_group.broadcast(value);
  }
  [[nodiscard]] bool broadcast(bool value) const { return broadcast(std::uint64_t{value ? 1U : 0U}) != 0; }

  // Passes that the processes trace concurrently, one each. A round ends where the error is due, because a
  // single process would estimate it there.
  [[nodiscard]] std::vector<SampleRange> next_round() const {
    std::vector<SampleRange> round;
    SampleRanges done = result_.samples;
    while (std::ssize(round) < options_.mpi_group.size && (round.empty() || !error_is_due(count(done)))) {
      const auto next = first_missing(done, requested_);
      if (!next) break;
      round.push_back({next->first, std::min(next->last, end_of_pass(next->first))});
      (void)add(done, round.back());
    }
    return round;
  }

  // End of the pass that begins with sample `first`. The cost of a path is unknown in advance. With a time
  // limit, the first passes therefore have 1, 1, 2, 4, ... samples, and none is longer than the time allows.
  [[nodiscard]] std::uint64_t end_of_pass(std::uint64_t first) const {
    const std::uint64_t end = (first / step_ + 1) * step_;
    if (!options_.time_limit_s) return end;
    const std::uint64_t traced = traced_samples();
    const std::uint64_t most = broadcast(std::min(traced, affordable(traced)));
    return std::min(end, first + std::max<std::uint64_t>(1, most));
  }

  // Number of samples per process for which the remaining time should suffice, judged by the time of the
  // `traced` samples on this process's clock.
  [[nodiscard]] std::uint64_t affordable(std::uint64_t traced) const {
    const double left = *options_.time_limit_s - elapsed();
    const double each = (elapsed() - planning_s_) / static_cast<double>(traced);
    if (!(left > 0 && each > 0)) return 0;
    const double of_one = left / each / options_.mpi_group.size;
    return static_cast<std::uint64_t>(std::min(of_one, static_cast<double>(kMaxSamples)));
  }

  void run_round(const std::vector<SampleRange>& round) {
    const auto own = static_cast<std::size_t>(options_.mpi_group.rank);
    if (own < round.size()) trace(round[own]);
    result_.unfinished.reset();
    result_.before_pass.reset();
    for (const SampleRange& range : round)
      if (!add(result_.samples, range)) throw Error(ErrorCode::internal, "render", "a pass was done twice");
    result_.stats.samples_per_pixel = count(result_.samples);
    set_samples(result_, result_.samples);
    if (broadcast(error_is_due() && needs_error())) {
      reduce_on_root();
      if (is_root()) estimate_error();
    }
    report_progress();
  }

  // Adds up on rank 0 what all processes have traced since the last call.
  void reduce_on_root() {
    if (is_single_process()) return;
    RenderStats& stats = result_.stats;
    options_.mpi_group.reduce(result_.film.sums());
    if (result_.layers) options_.mpi_group.reduce(result_.layers->sums());
    if (result_.features) options_.mpi_group.reduce(result_.features->sums().sums());
    std::array<Int128, 5> counts{stats.paths, stats.rays, stats.nonfinite_samples, stats.cut.paths,
                                 stats.cut.sum};
    options_.mpi_group.reduce(counts);
    const auto whole = [&](std::size_t i) { return static_cast<std::uint64_t>(counts.at(i)); };
    stats.paths = whole(0);
    stats.rays = whole(1);
    stats.nonfinite_samples = whole(2);
    stats.cut = {whole(3), counts[4]};
  }

  // CPU time of all processes, to the nanosecond.
  [[nodiscard]] double total_cpu_s() const {
    const double own = process_cpu_seconds() - cpu_start_;
    if (is_single_process()) return own;
    std::array<Int128, 1> sum{to_fixed(own, kNanosecond)};
    options_.mpi_group.reduce(sum);
    return from_fixed(sum[0], kNanosecond);
  }

  // Clears the sums of an earlier run on all ranks but 0, where they count.
  void clear_sums() {
    std::ranges::fill(result_.film.sums(), Int128{0});
    if (result_.layers) std::ranges::fill(result_.layers->sums(), Int128{0});
    if (result_.features) std::ranges::fill(result_.features->sums().sums(), Int128{0});
    static_cast<WorkCounts&>(result_.stats) = {};
  }

  // Traces one pass. Checkpoints interrupt it, because it may take long, but not in an MPI group.
  void trace(const SampleRange& range) {
    if (options_.checkpoint && is_single_process() && result_.film.shape().photons > 0 &&
        !result_.before_pass)
      result_.before_pass = std::make_shared<const std::vector<Film>>(copy_replicates(result_, range));
    Pass pass(plan_, result_.film, options_.crop, range, result_.unfinished ? result_.unfinished->items : 0,
              scene_.render.seed, auxiliary_films());
    while (!pass.finished()) {
      result_.stats += pass.run(threads_, [this] { return is_single_process() && save_is_due(); });
      result_.unfinished = {range, pass.done()};
      if (!pass.finished()) save();
    }
  }

  [[nodiscard]] AuxiliaryFilms auxiliary_films() {
    return {result_.features ? &*result_.features : nullptr, options_.layers ? &*options_.layers : nullptr,
            result_.layers ? &*result_.layers : nullptr};
  }

  // The estimate visits the whole film, so it is due only when the samples have grown by about a quarter.
  // Without a target error, they must have doubled. It needs a sample in every replicate. The decision
  // depends on the number of samples alone, so a resumed render or one with a time limit behaves as an
  // uninterrupted one.
  [[nodiscard]] bool error_is_due(std::uint64_t samples) const {
    if (options_.target_error && samples % step_ != 0) return false;
    if (samples < static_cast<std::uint64_t>(result_.film.replicates())) return false;
    const double growth = std::log(options_.target_error ? 1.25 : 2.0);
    const auto stage = [growth](std::uint64_t n) {
      return std::floor(std::log(static_cast<double>(n)) / growth);
    };
    const std::uint64_t before = (samples - 1) / step_ * step_;
    return before == 0 || stage(before) != stage(samples);
  }
  [[nodiscard]] bool error_is_due() const { return error_is_due(samples()); }
  void estimate_error() {
    result_.stats.error = error_now();
    error_samples_ = samples();
  }

  [[nodiscard]] bool needs_error() const { return options_.progress || options_.target_error; }

  // If a stop interrupts the pilot, only the error of the whole film is known.
  RelativeError error_now() {
    const std::size_t intensity_count = count_intensities(plan_.scene.channels);
    if (!illuminated_values_)
      if (const auto pilot = pilot_film(plan_, threads_, options_.crop, [this] { return stop_requested(); }))
        illuminated_values_ = nonzero_values(*pilot, intensity_count);
    RelativeError error = relative_error(
        result_.film, illuminated_values_ ? std::span(*illuminated_values_) : std::span<const std::size_t>(),
        intensity_count);
    if (options_.target_planes > 0) error.worst_mean = worst_mean_error(result_.film, options_.target_planes);
    if (!pilot_) pilot_ = noise_pilot(plan_, threads_, options_.crop, [this] { return stop_requested(); });
    if (pilot_) error.hidden_noise = hidden_noise(result_.film, *pilot_, intensity_count);
    return error;
  }

  [[nodiscard]] bool stop_requested() const { return options_.stop != nullptr && options_.stop->load(); }

  [[nodiscard]] bool save_is_due() const {
    const double pause = std::max(options_.checkpoint_interval_s, saving_s_ / kMaxCheckpointFraction);
    return options_.checkpoint &&
           (elapsed() - last_save_s_ >= pause || (stop_requested() && !saved_at_stop_));
  }

  void save() {
    reduce_on_root();
    if (!is_root()) return;
    const double begin = elapsed();
    saved_at_stop_ = stop_requested();
    options_.checkpoint(result_);
    last_save_s_ = elapsed();
    saving_s_ = last_save_s_ - begin;
  }

  void show() {
    reduce_on_root();
    if (is_root()) options_.show(result_);
  }

  void report_progress() const {
    if (!options_.progress) return;
    const auto traced = static_cast<double>(traced_samples());
    const double rate = traced > 0 ? traced / (elapsed() - planning_s_) : 0;
    options_.progress(
        {fraction_done(), samples(), rate, elapsed(), left_s(rate), result_.stats.error, error_samples_});
  }

  // Fraction of the requested samples that are finished.
  [[nodiscard]] double sample_fraction() const {
    const auto all = static_cast<double>(requested_.last - requested_.first);
    return 1 - static_cast<double>(count(missing(result_.samples, requested_))) / all;
  }
  [[nodiscard]] double error_fraction() const {
    return options_.target_error ? std::pow(*required_error() / target_quantity(), 2) : NAN;
  }
  [[nodiscard]] double fraction_done() const {
    double fraction_done = sample_fraction();
    if (options_.time_limit_s) fraction_done = std::fmax(fraction_done, elapsed() / *options_.time_limit_s);
    return std::min(std::fmax(fraction_done, error_fraction()), 1.0);
  }
  // Estimated time until the first limit ends the render.
  [[nodiscard]] double left_s(double rate) const {
    double left = NAN;
    if (rate > 0) {
      left = static_cast<double>(count(missing(result_.samples, requested_))) / rate;
      left = std::fmin(left, static_cast<double>(samples()) * (1 / error_fraction() - 1) / rate);
    }
    if (options_.time_limit_s) left = std::fmin(left, *options_.time_limit_s - elapsed());
    return left < 0 ? 0 : left;
  }

  // The target error, or a quarter of it while the error is not yet known: a sixteenth of the samples may
  // have given the same estimate.
  [[nodiscard]] std::optional<double> required_error() const {
    if (!options_.target_error || is_known(result_.stats.error)) return options_.target_error;
    return *options_.target_error / kUnknownErrorFactor;
  }

  [[nodiscard]] double target_quantity() const {
    return options_.target_planes > 0 ? result_.stats.error.worst_mean : result_.stats.error.median;
  }

  [[nodiscard]] bool finished() {
    result_.stats.interrupted = samples() > 0 && stop_requested();
    if (result_.stats.interrupted) return true;
    if (options_.time_limit_s && samples() > 0 && elapsed() >= *options_.time_limit_s) return true;
    const bool is_dark = !options_.time_limit_s && illuminated_values_ &&
                         illuminated_values_->empty();  // then the error stays undefined
    return options_.target_error && (is_dark || target_quantity() <= *required_error());
  }

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double cpu_start_ = process_cpu_seconds();
  const Scene& scene_;
  const RenderOptions& options_;
  int threads_;
  Plan plan_;
  SampleRange requested_;
  // Passes end at multiples of `step_`, also if the film starts with some samples.
  std::uint64_t step_;
  RenderResult result_;
  std::optional<std::vector<std::size_t>> illuminated_values_;  // from the pilot film, once needed
  std::optional<Film> pilot_;                                   // noise pilot of a small film, once needed
  std::uint64_t error_samples_ = 0;  // samples per pixel at the last error estimate
  double planning_s_ = 0;            // when the first pass of this run began
  double last_save_s_ = 0;
  double saving_s_ = 0;
  bool saved_at_stop_ = false;
};

}  // namespace

int replicate_count(const Scene& scene, const RenderOptions& options) {
  constexpr int kMaxReplicates = 8;
  if (open_ended(options)) return kMaxReplicates;
  const auto replicates = static_cast<unsigned>(std::clamp(scene.render.samples / 16, 2, kMaxReplicates));
  return std::min(static_cast<int>(std::bit_floor(replicates)), scene.render.samples);
}

RenderResult render(const Scene& scene, const RenderOptions& options, std::optional<RenderResult> start) {
  return Rendering(scene, options, std::move(start)).run();
}

}  // namespace abbe
