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
#include "sensor/response/stokes_channels.h"
#include "transport/render/learn_splitting.h"
#include "transport/render/learnt_plan.h"
#include "transport/render/part_films.h"
#include "transport/render/pass.h"
#include "transport/render/pilot.h"
#include "transport/render/replay.h"
#include "transport/render/technique_shares.h"
#include "transport/render/threads.h"

namespace abbe {
namespace {

// Paths a pass should have: few enough to end within a fraction of a second, so that a stop is soon, many
// enough to make threads worth starting.
constexpr std::uint64_t kPassPaths = 1U << 18;

// As a power of two [s].
constexpr int kNanosecond = -30;

// Of the time, at most.
constexpr double kCheckpointShare = 0.01;

// An error that is not yet known ends a render if it is smaller than the target by this factor.
constexpr double kUnknownErrorFactor = 4;

constexpr std::uint64_t kMaxSamples = std::numeric_limits<std::uint32_t>::max();

bool open_ended(const RenderOptions& options) {
  return options.time_limit_s || options.target_error;
}

Plan balanced_plan(const Scene& scene, const RenderOptions& options, int threads) {
  Plan plan = make_learnt_plan(scene, threads, options.guides);
  learn_splitting(plan, threads);
  set_technique_shares(plan, threads);
  return plan;
}

// Of a sample in which all pixels have theirs.
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
        wanted_(options.samples.value_or(SampleRange{
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
        throw Error(ErrorCode::input, "render", "the film to go on with has another shape");
      result_ = *std::move(start);
    }
    RenderStats& stats = result_.stats;
    stats.threads = threads_;
    stats.processes = options_.crew.size;
    stats.path_splitting = 1 << plan_.split_bits;
    if (!leads()) forget();
    if (leads() && !result_.unfinished && look_is_due() && asks_for_error()) look_at_error();
    stats.samples_before = samples();
    planned_s_ = elapsed();
  }

  RenderResult run() {
    if (result_.unfinished) run_round({result_.unfinished->samples});
    for (auto round = next_round(); !round.empty() && !all_follow(finished()); round = next_round()) {
      run_round(round);
      if (all_follow(options_.wants_to_see && options_.wants_to_see())) show();
      if (all_follow(save_is_due())) save();
    }
    collect();
    RenderStats& stats = result_.stats;
    if (leads() && (asks_for_error() || options_.measure_error) && looked_at_ != samples()) {
      look_at_error();
      tell_progress();
    }
    stats.wall_s = elapsed();
    stats.cpu_s = cpu_of_all();
    if (options_.measure_replay) stats.embree_replay_share = measure_replay_share(plan_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::uint64_t samples() const { return result_.stats.samples_per_pixel; }
  [[nodiscard]] std::uint64_t traced_samples() const { return samples() - result_.stats.samples_before; }
  [[nodiscard]] double elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  [[nodiscard]] bool leads() const { return options_.crew.rank == 0; }
  [[nodiscard]] bool alone() const { return options_.crew.size == 1; }
  [[nodiscard]] std::uint64_t all_follow(std::uint64_t said) const {
    return alone() ? said : options_.crew.follow(said);
  }
  [[nodiscard]] bool all_follow(bool said) const { return all_follow(std::uint64_t{said ? 1U : 0U}) != 0; }

  // Passes that processes trace at the same time, one each. Where the error is to be looked at, a round ends,
  // as a process alone would look there.
  [[nodiscard]] std::vector<SampleRange> next_round() const {
    std::vector<SampleRange> round;
    SampleRanges done = result_.samples;
    while (std::ssize(round) < options_.crew.size && (round.empty() || !look_is_due(count(done)))) {
      const auto next = first_missing(done, wanted_);
      if (!next) break;
      round.push_back({next->first, std::min(next->last, end_of_pass(next->first))});
      (void)add(done, round.back());
    }
    return round;
  }

  // Of a pass that begins with that sample. What a path costs is not known before, so where time is limited
  // the first passes are of one sample, one, two, four and so on, and none longer than the time allows.
  [[nodiscard]] std::uint64_t end_of_pass(std::uint64_t first) const {
    const std::uint64_t end = (first / step_ + 1) * step_;
    if (!options_.time_limit_s) return end;
    const std::uint64_t traced = traced_samples();
    const std::uint64_t most = all_follow(std::min(traced, affordable(traced)));
    return std::min(end, first + std::max<std::uint64_t>(1, most));
  }

  // So many samples of each process as the time that is left should be enough for, by what those traced have
  // taken, by this process's clock.
  [[nodiscard]] std::uint64_t affordable(std::uint64_t traced) const {
    const double left = *options_.time_limit_s - elapsed();
    const double each = (elapsed() - planned_s_) / static_cast<double>(traced);
    if (!(left > 0 && each > 0)) return 0;
    const double of_one = left / each / options_.crew.size;
    return static_cast<std::uint64_t>(std::min(of_one, static_cast<double>(kMaxSamples)));
  }

  void run_round(const std::vector<SampleRange>& round) {
    const auto own = static_cast<std::size_t>(options_.crew.rank);
    if (own < round.size()) trace(round[own]);
    result_.unfinished.reset();
    result_.before_pass.reset();
    for (const SampleRange& range : round)
      if (!add(result_.samples, range)) throw Error(ErrorCode::internal, "render", "a pass was done twice");
    result_.stats.samples_per_pixel = count(result_.samples);
    set_samples(result_, result_.samples);
    if (all_follow(look_is_due() && asks_for_error())) {
      collect();
      if (leads()) look_at_error();
    }
    tell_progress();
  }

  // Brings together what all have traced since the last time.
  void collect() {
    if (alone()) return;
    RenderStats& stats = result_.stats;
    options_.crew.collect(result_.film.sums());
    if (result_.layers) options_.crew.collect(result_.layers->sums());
    if (result_.features) options_.crew.collect(result_.features->sums().sums());
    std::array<Int128, 5> counts{stats.paths, stats.rays, stats.nonfinite_samples, stats.cut.paths,
                                 stats.cut.sum};
    options_.crew.collect(counts);
    const auto whole = [&](std::size_t i) { return static_cast<std::uint64_t>(counts.at(i)); };
    stats.paths = whole(0);
    stats.rays = whole(1);
    stats.nonfinite_samples = whole(2);
    stats.cut = {whole(3), counts[4]};
  }

  // Of all processes together, to the nanosecond.
  [[nodiscard]] double cpu_of_all() const {
    const double own = process_cpu_seconds() - cpu_start_;
    if (alone()) return own;
    std::array<Int128, 1> sum{to_fixed(own, kNanosecond)};
    options_.crew.collect(sum);
    return from_fixed(sum[0], kNanosecond);
  }

  // What was read of an earlier run counts in the first process only.
  void forget() {
    std::ranges::fill(result_.film.sums(), Int128{0});
    if (result_.layers) std::ranges::fill(result_.layers->sums(), Int128{0});
    if (result_.features) std::ranges::fill(result_.features->sums().sums(), Int128{0});
    RenderStats& stats = result_.stats;
    stats.paths = stats.rays = stats.nonfinite_samples = 0;
    stats.cut = {};
  }

  // A pass may be long, so checkpoints interrupt it, but for those of a crew.
  void trace(const SampleRange& range) {
    RenderStats& stats = result_.stats;
    if (options_.checkpoint && alone() && result_.film.shape().photons > 0 && !result_.before_pass)
      result_.before_pass = std::make_shared<const std::vector<Film>>(copy_of_replicates(result_, range));
    Pass pass(plan_, result_.film, options_.crop, range, result_.unfinished ? result_.unfinished->items : 0,
              scene_.render.seed, beside());
    while (!pass.finished()) {
      const PassCounts counts = pass.run(threads_, [this] { return alone() && save_is_due(); });
      stats.paths += counts.paths;
      stats.rays += counts.rays;
      stats.nonfinite_samples += counts.nonfinite;
      stats.cut += counts.cut;
      result_.unfinished = {range, pass.done()};
      if (!pass.finished()) save();
    }
  }

  [[nodiscard]] BesideFilms beside() {
    return {result_.features ? &*result_.features : nullptr, options_.layers ? &*options_.layers : nullptr,
            result_.layers ? &*result_.layers : nullptr};
  }

  // The error costs a walk over the film, so it is looked at when the samples have grown by a quarter or so,
  // or doubled where it is told and ends nothing, and known once every replicate has some. When depends on
  // nothing but the number of samples, so that a render goes on after an interruption as it would have
  // without, and with a limit of time as without one.
  [[nodiscard]] bool look_is_due(std::uint64_t samples) const {
    if (options_.target_error && samples % step_ != 0) return false;
    if (samples < static_cast<std::uint64_t>(result_.film.replicates())) return false;
    const double growth = std::log(options_.target_error ? 1.25 : 2.0);
    const auto stage = [growth](std::uint64_t n) {
      return std::floor(std::log(static_cast<double>(n)) / growth);
    };
    const std::uint64_t before = (samples - 1) / step_ * step_;
    return before == 0 || stage(before) != stage(samples);
  }
  [[nodiscard]] bool look_is_due() const { return look_is_due(samples()); }
  void look_at_error() {
    result_.stats.error = error_now();
    looked_at_ = samples();
  }

  [[nodiscard]] bool asks_for_error() const { return options_.progress || options_.target_error; }

  // Without a pilot, which a stop ends, only the error of the whole film is known.
  RelativeError error_now() {
    const std::size_t counting = count_intensities(plan_.scene.channels);
    if (!lit_)
      if (const auto pilot = pilot_film(plan_, threads_, options_.crop, [this] { return stop_asked(); }))
        lit_ = lit_values(*pilot, counting);
    RelativeError error =
        relative_error(result_.film, lit_ ? std::span(*lit_) : std::span<const std::size_t>(), counting);
    if (options_.target_planes > 0) error.worst_mean = worst_mean_error(result_.film, options_.target_planes);
    if (!pilot_) pilot_ = noise_pilot(plan_, threads_, options_.crop, [this] { return stop_asked(); });
    if (pilot_) error.hidden_noise = hidden_noise(result_.film, *pilot_, counting);
    return error;
  }

  [[nodiscard]] bool stop_asked() const { return options_.stop != nullptr && options_.stop->load(); }

  [[nodiscard]] bool save_is_due() const {
    const double pause = std::max(options_.checkpoint_interval_s, saving_s_ / kCheckpointShare);
    return options_.checkpoint && (elapsed() - last_save_s_ >= pause || (stop_asked() && !saved_at_stop_));
  }

  void save() {
    collect();
    if (!leads()) return;
    const double begin = elapsed();
    saved_at_stop_ = stop_asked();
    options_.checkpoint(result_);
    last_save_s_ = elapsed();
    saving_s_ = last_save_s_ - begin;
  }

  void show() {
    collect();
    if (leads()) options_.show(result_);
  }

  void tell_progress() const {
    if (!options_.progress) return;
    const auto traced = static_cast<double>(traced_samples());
    const double rate = traced > 0 ? traced / (elapsed() - planned_s_) : 0;
    options_.progress({share(), samples(), rate, elapsed(), left_s(rate), result_.stats.error, looked_at_});
  }

  // Of the samples that are wanted, and of those that the error asks for by what they have brought so far.
  [[nodiscard]] double share_of_samples() const {
    const auto all = static_cast<double>(wanted_.last - wanted_.first);
    return 1 - static_cast<double>(count(missing(result_.samples, wanted_))) / all;
  }
  [[nodiscard]] double share_of_error() const {
    return options_.target_error ? std::pow(*needed_error() / targeted(), 2) : NAN;
  }
  [[nodiscard]] double share() const {
    double share = share_of_samples();
    if (options_.time_limit_s) share = std::fmax(share, elapsed() / *options_.time_limit_s);
    return std::min(std::fmax(share, share_of_error()), 1.0);
  }
  // Until the first of what may end the render does.
  [[nodiscard]] double left_s(double rate) const {
    double left = NAN;
    if (rate > 0) {
      left = static_cast<double>(count(missing(result_.samples, wanted_))) / rate;
      left = std::fmin(left, static_cast<double>(samples()) * (1 / share_of_error() - 1) / rate);
    }
    if (options_.time_limit_s) left = std::fmin(left, *options_.time_limit_s - elapsed());
    return left < 0 ? 0 : left;
  }

  // The target, or less while the error is not yet known: a sixteenth of the samples may have looked as good.
  [[nodiscard]] std::optional<double> needed_error() const {
    if (!options_.target_error || is_known(result_.stats.error)) return options_.target_error;
    return *options_.target_error / kUnknownErrorFactor;
  }

  [[nodiscard]] double targeted() const {
    return options_.target_planes > 0 ? result_.stats.error.worst_mean : result_.stats.error.median;
  }

  [[nodiscard]] bool finished() {
    result_.stats.interrupted = samples() > 0 && stop_asked();
    if (result_.stats.interrupted) return true;
    if (options_.time_limit_s && samples() > 0 && elapsed() >= *options_.time_limit_s) return true;
    const bool unlit = !options_.time_limit_s && lit_ && lit_->empty();  // there is no error to wait for
    return options_.target_error && (unlit || targeted() <= *needed_error());
  }

  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  const double cpu_start_ = process_cpu_seconds();
  const Scene& scene_;
  const RenderOptions& options_;
  int threads_;
  Plan plan_;
  SampleRange wanted_;
  // Passes end at multiples of their size, whatever the film starts with.
  std::uint64_t step_;
  RenderResult result_;
  std::optional<std::vector<std::size_t>> lit_;  // once asked for
  std::optional<Film> pilot_;                    // likewise, of a small film
  std::uint64_t looked_at_ = 0;                  // samples of the film whose error was worked out last
  double planned_s_ = 0;                         // when the first of this run was begun
  double last_save_s_ = 0;
  double saving_s_ = 0;
  bool saved_at_stop_ = false;
};

}  // namespace

int replicate_count(const Scene& scene, const RenderOptions& options) {
  constexpr int kMost = 8;
  if (open_ended(options)) return kMost;
  const auto wanted = static_cast<unsigned>(std::clamp(scene.render.samples / 16, 2, kMost));
  return std::min(static_cast<int>(std::bit_floor(wanted)), scene.render.samples);
}

RenderResult render(const Scene& scene, const RenderOptions& options, std::optional<RenderResult> start) {
  return Rendering(scene, options, std::move(start)).run();
}

}  // namespace abbe
