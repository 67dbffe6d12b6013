#include "transport/render/train_photon_guides.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "scene/working_range.h"
#include "transport/render/pilot.h"
#include "transport/render/pilot_photons.h"
#include "transport/render/relative_splats.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

// Pilot photons and what they add to the film.
struct PilotSplats {
  std::vector<PhotonStart> starts;
  std::vector<Splat> splats;
  [[nodiscard]] std::size_t size() const { return splats.size(); }
};

// Traces photons and records what they add to the cells. The branch of a photon is that of its first
// contribution.
PilotSplats trace_batch(LightTracer& tracer, std::span<const Sampler> photons,
                        const RelativeErrorCells& cells) {
  PilotSplats pilots;
  std::vector<std::optional<std::uint32_t>> branches(photons.size());
  tracer.set_layer_sink([&](std::uint32_t photon, const FilmPoint& at, const ContributionInfo& history,
                            std::span<const double> values) {
    if (!(magnitude(values) > 0)) return;
    cells.add(photon, at, values, pilots.splats);
    if (!branches[photon]) branches[photon] = history.branch;
  });
  tracer.trace(photons, [](std::uint32_t, const FilmPoint&, std::span<const double>) {});
  tracer.set_layer_sink({});
  pilots.starts.assign(tracer.starts().begin(), tracer.starts().end());
  for (std::size_t i = 0; i < branches.size(); ++i) pilots.starts[i].branch = branches[i].value_or(0);
  return pilots;
}

// Traces photons and adds them to `all`.
void trace_pilots(const Plan& plan, const RelativeErrorCells& cells, const PilotPhotons& photons, int threads,
                  std::optional<double> ball_radius, PilotSplats& all) {
  for (const auto& [starts, splats] : trace_pilot_photons(
           plan.scene, photons, threads,
           [&](RayCaster&caster) { return LightTracer(plan, caster, 1, ball_radius); },
           [&](LightTracer&tracer, std::span<const Sampler> some) {
             return trace_batch(tracer, some, cells);
           })) {
    for (const Splat& splat : splats)
      all.splats.push_back({all.starts.size() + splat.source, splat.cell, splat.value});
    all.starts.insert(all.starts.end(), starts.begin(), starts.end());
  }
}

constexpr std::uint32_t kGuidePilots = 1U << 17;

// Minimum number of photons to train the guide of a light. Fewer photons are too likely to miss a route of
// much of its light. That route would be left to uniformly emitted photons, each of great power.
constexpr double kMinPhotons = PhotonGuide::kEnoughPhotons;

// Effective number of photons, (sum w)^2 / sum w^2: as many photons of equal weight have the same mean and
// variance.
struct EffectiveCount {
  double weight = 0;
  double squares = 0;
  [[nodiscard]] double photons() const { return weight > 0 ? weight * weight / squares : 0; }
  void add(const EffectiveCount& other) {
    weight += other.weight;
    squares += other.squares;
  }
};

// Pilot photons to train with, and their effective number for each light.
struct TrainingSet {
  std::vector<PilotStart> starts;
  std::vector<EffectiveCount> lights;
};

// Photons drawn with density p0 that arrive at the film with relative mean square s are best drawn with
// density p0 sqrt(s). The pilots are distributed as p0, so each has the weight sqrt(s).
TrainingSet training_set(const Plan& plan, const RelativeErrorCells& cells, const PilotSplats& pilots) {
  const std::vector<double> squares = relative_squares(pilots.splats, cells, pilots.starts.size());
  TrainingSet training{{}, std::vector<EffectiveCount>(plan.guides.photon_guides.size())};
  for (std::size_t i = 0; i < squares.size(); ++i)
    if (squares[i] > 0 && std::isfinite(squares[i])) {
      training.starts.push_back({pilots.starts[i], std::sqrt(squares[i])});
      training.lights[pilots.starts[i].light].add({std::sqrt(squares[i]), squares[i]});
    }
  return training;
}

std::vector<std::vector<PilotRay>> rays_of_lights(std::span<const PilotStart> starts, const Plan& plan) {
  std::vector<std::vector<PilotRay>> rays(plan.guides.photon_guides.size());
  for (const auto& [start, weight] : starts)
    rays[start.light].push_back({start.from, start.direction, weight, start.branch});
  return rays;
}

// Number of branches with grids of their own, such that the grids of all lights take about 32 MB at most.
std::size_t branches_per_light(const Plan& plan) {
  constexpr std::size_t kMaxGrids = 256;
  constexpr std::size_t kMaxBranches = 6;
  const auto lights =
      static_cast<std::size_t>(std::ranges::count_if(plan.guides.photon_guides, &PhotonGuide::can_train));
  return std::clamp<std::size_t>(kMaxGrids / std::max<std::size_t>(1, lights), 1, kMaxBranches);
}

bool is_sufficient(const EffectiveCount& light) {
  return light.photons() >= kMinPhotons;
}

// Lights with too few photons keep their guides if the camera is a probe, which earlier rounds have
// approached step by step. For other cameras, the guide is estimated from the few photons.
void train_on(const TrainingSet& training, Plan& plan) {
  const std::vector<std::vector<PilotRay>> rays = rays_of_lights(training.starts, plan);
  for (std::size_t light = 0; light < rays.size(); ++light)
    if (is_sufficient(training.lights[light]))
      plan.guides.photon_guides[light].train(rays[light], branches_per_light(plan));
    else if (!is_probe(plan.scene.camera))
      plan.guides.photon_guides[light].train_from_few(rays[light]);
}

// Effective number of photons of all lights together that can be guided and have too few photons each. Empty
// if these lights have no more than `fraction` of all weight. The weight of lights with a single photon
// estimates that of lights with none [Good1953]; if it exceeds `fraction`, the result is 1.
std::optional<double> photons_of_sparse_lights(const TrainingSet& training, const Plan& plan,
                                               double fraction) {
  constexpr double kSingle = 1.5;
  EffectiveCount all;
  EffectiveCount few;
  EffectiveCount single;
  for (std::size_t light = 0; light < training.lights.size(); ++light) {
    const EffectiveCount& count = training.lights[light];
    all.add(count);
    if (!plan.guides.photon_guides[light].can_train() || is_sufficient(count)) continue;
    few.add(count);
    if (count.photons() < kSingle) single.add(count);
  }
  if (!(few.weight > fraction * all.weight)) return std::nullopt;
  return single.weight > fraction * all.weight ? 1 : few.photons();
}

// Effective number of photons of each pair of light and branch.
std::map<std::pair<std::uint32_t, std::uint32_t>, EffectiveCount> count_branches(
    const TrainingSet& training) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, EffectiveCount> branches;
  for (const auto& [start, weight] : training.starts)
    branches[{start.light, start.branch}].add({weight, weight * weight});
  return branches;
}

// Fraction of the weight on branches that too few pilot photons took, of lights whose guides are trained.
// Lights with too few pilot photons in all are the subject of `photons_of_few`.
double undertrained_fraction(const TrainingSet& training) {
  double all = 0;
  double few = 0;
  for (const auto& [branch, count] : count_branches(training)) {
    all += count.weight;
    if (is_sufficient(training.lights[branch.first]) && !is_sufficient(count)) few += count.weight;
  }
  return all > 0 ? few / all : 0;
}

// Effective number of photons of the branch that has the fewest, among those of more than this fraction of
// the weight; nothing if there is none.
std::optional<double> photons_of_rarest_branch(const TrainingSet& training, double fraction) {
  const auto branches = count_branches(training);
  EffectiveCount all;
  for (const auto& [branch, count] : branches) all.add(count);
  std::optional<double> fewest;
  for (const auto& [branch, count] : branches)
    if (count.weight > fraction * all.weight)
      fewest = std::min(fewest.value_or(count.photons()), count.photons());
  return fewest;
}

TrainingSet training_set(const Plan& plan, PilotStage stage, int threads) {
  const RelativeErrorCells cells(plan.scene);
  PilotSplats pilots;
  trace_pilots(plan, cells, {stage, kGuidePilots}, threads, {}, pilots);
  return training_set(plan, cells, pilots);
}

// A training set that is enlarged if a light or a branch has too few photons, unless the ray limit stopped
// the first photons.
TrainingSet large_training_set(const Plan& plan, PilotStage stage, int threads,
                               std::optional<double> ball_radius = {}) {
  constexpr double kNegligibleFraction = 0.01;
  constexpr double kMaxFactor = 8;
  const RelativeErrorCells cells(plan.scene);
  PilotSplats pilots;
  trace_pilots(plan, cells, {stage, kGuidePilots}, threads, ball_radius, pilots);
  TrainingSet training = training_set(plan, cells, pilots);
  std::optional<double> few = photons_of_sparse_lights(training, plan, kNegligibleFraction);
  if (const auto rarest = photons_of_rarest_branch(training, kNegligibleFraction))
    few = std::min(few.value_or(*rarest), *rarest);
  if (!few || *few >= kMinPhotons || pilots.starts.size() < kGuidePilots) return training;
  const auto factor = static_cast<std::uint32_t>(std::min(std::ceil(2 * kMinPhotons / *few), kMaxFactor));
  PilotPhotons more{stage, (factor - 1) * kGuidePilots};
  more.first = kGuidePilots;
  trace_pilots(plan, cells, more, threads, ball_radius, pilots);
  return training_set(plan, cells, pilots);
}

// Light that enters a small probe also enters each ball around it. The first guides aim at a large ball,
// which many photons enter by chance. Each next ball is smaller, and many photons guided to the previous ball
// enter it.
void train_towards_probe(Plan& plan, double ball_radius, int threads) {
  constexpr double kStep = 4;
  if (kStep * ball_radius < scene_radius(plan.scene.bounds))
    train_towards_probe(plan, kStep * ball_radius, threads);
  train_on(large_training_set(plan, PilotStage::probe_guides, threads, ball_radius), plan);
}

bool all_are_sufficient(const TrainingSet& training, const Plan& plan) {
  for (std::size_t light = 0; light < training.lights.size(); ++light)
    if (plan.guides.photon_guides[light].can_train() && !is_sufficient(training.lights[light])) return false;
  return true;
}

// True if lights with few photons have a large fraction of the weight.
bool is_undertrained(const TrainingSet& training, const Plan& plan) {
  constexpr double kSignificantFraction = 0.1;
  return photons_of_sparse_lights(training, plan, kSignificantFraction).value_or(kMinPhotons) < kMinPhotons;
}

// Trains the guides with uniformly emitted photons: they show where light arrives at the film at all.
void train_coarsely(Plan& plan, int threads) {
  const Camera& camera = plan.scene.camera;
  if (const std::optional<Opening> opening = traits(camera).opening; is_probe(camera) && opening) {
    const TrainingSet training = training_set(plan, PilotStage::coarse_guides, threads);
    if (!all_are_sufficient(training, plan))
      return train_towards_probe(plan, opening_radius(*opening), threads);
    return train_on(training, plan);
  }
  const TrainingSet training = large_training_set(plan, PilotStage::coarse_guides, threads);
  plan.guides.undertrained = is_undertrained(training, plan);
  train_on(training, plan);
}

}  // namespace

// The first round shows where light arrives at the film at all. The second, guided round shows how much of
// it.
void train_photon_guides(Plan& plan, int threads) {
  if (plan.traced_lights.empty()) return;
  train_coarsely(plan, threads);
  const TrainingSet training = large_training_set(plan, PilotStage::photon_guides, threads);
  plan.guides.undertrained = plan.guides.undertrained || is_undertrained(training, plan);
  plan.guides.undertrained_fraction = undertrained_fraction(training);
  train_on(training, plan);
}

void train_photon_guides_from(std::span<const PilotStart> starts, Plan& plan) {
  const std::vector<std::vector<PilotRay>> rays = rays_of_lights(starts, plan);
  for (std::size_t light = 0; light < rays.size(); ++light)
    plan.guides.photon_guides[light].train(rays[light], branches_per_light(plan));
}

}  // namespace abbe
