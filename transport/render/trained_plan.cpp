#include "transport/render/trained_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "scene/working_range.h"
#include "sensor/film/relative_error.h"
#include "spectral/matrix3.h"
#include "spectral/rgb.h"
#include "transport/path/dimensions.h"
#include "transport/path/film_response.h"
#include "transport/plan/plan.h"
#include "transport/render/pilot.h"
#include "transport/technique/caustic_photons.h"
#include "transport/technique/path_starts.h"
#include "transport/technique/tracers.h"

namespace abbe {
namespace {

constexpr int kBlocks = 32;  // along an edge of the film

// A value that a pilot photon adds to the film.
struct Splat {
  std::size_t source;  // Index of the photon, or of the group to which it belongs.
  std::size_t cell;    // Index in `RelativeErrorCells`, below its `count()`.
  double value;        // Film value, or linear sRGB value for an observer.
};

// Cells of a film inside which errors are relative to the same mean: every plane of every block of pixels.
// There are at most 32 x 32 blocks. The planes of an observer are those of linear sRGB.
class RelativeErrorCells {
 public:
  // Cells for the film of a scene, which must outlive them.
  explicit RelativeErrorCells(const Scene& scene);

  // Number of cells: blocks times planes.
  [[nodiscard]] std::size_t count() const;
  // Appends to `splats` what the film values at a film point, one per plane, contribute to their cells.
  // `source` is `Splat::source` of all. Values of 0 are omitted.
  void add(std::size_t source, const FilmPoint& at, std::span<const double> values,
           std::vector<Splat>& splats) const;

 private:
  const Camera& camera_;
  std::size_t planes_;
  int across_;
  int down_;
  std::optional<Matrix3> from_xyz_;  // to linear sRGB
};

RelativeErrorCells::RelativeErrorCells(const Scene& scene)
    : camera_(scene.camera),
      planes_(scene.film_planes().size()),
      across_(std::min(kBlocks, scene.camera.width)),
      down_(std::min(kBlocks, scene.camera.height)) {
  if (!scene.mosaic && standard_observer(scene.channels)) from_xyz_ = rgb_to_xyz(kRec709).inverse();
}

std::size_t RelativeErrorCells::count() const {
  return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_) * planes_;
}

void RelativeErrorCells::add(std::size_t source, const FilmPoint& at, std::span<const double> values,
                             std::vector<Splat>& splats) const {
  const int block = at.y * down_ / camera_.height * across_ + at.x * across_ / camera_.width;
  const std::size_t first = static_cast<std::size_t>(block) * planes_;
  const LinearRgb rgb = from_xyz_ ? multiply(*from_xyz_, {values[0], values[1], values[2]}) : LinearRgb();
  for (std::size_t k = 0; k < values.size(); ++k)  // with many bands, most are zero
    if (const double value = from_xyz_ ? rgb[k] : values[k]; value != 0)
      splats.push_back({source, first + k, value});
}

// Contribution of each of `count` sources to relMSE: the sum of its squared splats, each divided by the
// squared sum of its cell plus `kUsualFloor` times the squared mean of these sums. Sources are below
// `count`.
std::vector<double> relative_squares(std::span<const Splat> splats, const RelativeErrorCells& cells,
                                     std::size_t count) {
  std::vector<double> means(cells.count());
  for (const Splat& splat : splats) means[splat.cell] += splat.value;
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / static_cast<double>(means.size());
  std::vector<double> squares(count);
  for (const auto& [source, cell, value] : splats)
    squares[source] += value * value / (means[cell] * means[cell] + kUsualFloor * mean * mean);
  return squares;
}

// Start of a pilot photon that contributed, with its training weight.
struct PilotStart {
  PhotonStart start;
  double weight;  // `PilotRay::weight`
};

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
  tracer.trace(photons, discard_values);
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

// Trains the plan's photon guides with pilot photons, so that more photons contribute to the film. Also sets
// `GuidingData::undertrained` and `undertrained_fraction`. Does nothing if no light is traced. The result
// does not depend on `threads`, which is at least 1.
//
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

// Trains the photon guide of each light (`PhotonGuide::train`) with given photon starts. Guides of lights
// without starts are unchanged.
void train_photon_guides_from(std::span<const PilotStart> starts, Plan& plan) {
  const std::vector<std::vector<PilotRay>> rays = rays_of_lights(starts, plan);
  for (std::size_t light = 0; light < rays.size(); ++light)
    plan.guides.photon_guides[light].train(rays[light], branches_per_light(plan));
}

constexpr std::uint32_t kPhotons = 1U << 15;
constexpr std::size_t kWavelengthBins = 64;  // bins of equal probability of the distribution
constexpr double kUniformFraction = 0.1;

// Splats of the photons on the film, by the bin of the wavelength distribution that their hero was sampled
// from.
std::vector<Splat> trace_pilots(const Plan& plan, const RelativeErrorCells& cells, int threads) {
  std::vector<Splat> all;
  for (const std::vector<Splat>&batch : trace_pilot_photons(
           plan.scene, {PilotStage::wavelengths, kPhotons}, threads,
           [&](RayCaster&caster) { return LightTracer(plan, caster, 1); },
           [&](LightTracer&tracer, std::span<const Sampler> photons) {
             std::vector<Splat> splats;
             tracer.trace(photons, [&](std::uint32_t i, const FilmPoint& at, std::span<const double> values) {
               // The random number that samples the hero is its position in the cumulative distribution.
               const auto bin =
                   static_cast<std::size_t>(photons[i].group(kPhotonGuideGroup)[2] * kWavelengthBins);
               if (magnitude(values) > 0) cells.add(std::min(bin, kWavelengthBins - 1), at, values, splats);
             });
             return splats;
           }))
    all.insert(all.end(), batch.begin(), batch.end());
  return all;
}

// Trains the wavelength distribution of the plan's photons, if the scene has dispersion: wavelengths that
// leave more noise are sampled more densely. With dispersion each pixel receives few wavelengths, so the
// best distribution for the mean of the film is not the best for its pixels. The criterion is the squared
// error of film values relative to the local mean, as in relMSE. For an observer it is that of linear sRGB.
// Does nothing without dispersion, without traced lights, or if no pilot photon arrives at the film. The
// result does not depend on `threads`, which is at least 1.
//
// Let photons drawn with density p0 add values of relative mean square s at a wavelength. Drawn with density
// p, they have the variance of the integral of s p0^2 / p, which is least for p proportional to p0 sqrt(s).
void train_photon_wavelengths(Plan& plan, int threads) {
  if (!plan.scene.features.dispersion || plan.traced_lights.empty()) return;
  const RelativeErrorCells cells(plan.scene);
  std::vector<double> importance =
      relative_squares(trace_pilots(plan, cells, threads), cells, kWavelengthBins);
  for (double& bin : importance) bin = std::sqrt(bin);
  const double mean = std::accumulate(importance.begin(), importance.end(), 0.0) / kWavelengthBins;
  if (!(mean > 0 && std::isfinite(mean))) return;
  for (double& bin : importance) bin = (1 - kUniformFraction) * bin / mean + kUniformFraction;
  WavelengthDistribution& wavelengths = plan.guides.photon_wavelengths;
  wavelengths = wavelengths.weighted(importance);
}

using CausticHits = std::vector<CausticPhotonTracer::TracedPhoton>;

// Photons of each batch that reached a scattering surface after specular events only.
std::vector<CausticHits> trace_photons(const Plan& plan, const Emissions& emissions,
                                       const PilotPhotons& pilots, int threads) {
  return trace_pilot_photons(
      plan.scene, pilots, threads,
      [&](RayCaster& caster) { return CausticPhotonTracer(plan, caster, emissions.sensor_emissions); },
      [](CausticPhotonTracer& tracer, std::span<const Sampler> photons) {
        const auto hits = tracer.trace(photons);
        return CausticHits(hits.begin(), hits.end());
      });
}

void train_on_hits(Plan& plan, const std::vector<CausticHits>& hits) {
  std::vector<PilotStart> starts;
  for (const CausticHits& batch : hits)
    for (const CausticPhotonTracer::TracedPhoton& hit : batch) starts.push_back({hit.start, 1});
  train_photon_guides_from(starts, plan);
}

std::size_t hit_count(const std::vector<CausticHits>& hits) {
  std::size_t sum = 0;
  for (const CausticHits& batch : hits) sum += batch.size();
  return sum;
}

// True if the camera sees a specular surface, on a grid of rays through the film.
bool sees_specular(const Scene& scene) {
  constexpr int kGrid = 64;
  const SampledSpectrum any(550.0F);
  const Imath::V2f cell(static_cast<float>(scene.camera.width) / kGrid,
                        static_cast<float>(scene.camera.height) / kGrid);
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const int row = i / kGrid;
    const int column = i % kGrid;
    const Imath::V2f film(cell.x * (static_cast<float>(column) + 0.5F),
                          cell.y * (static_cast<float>(row) + 0.5F));
    const auto hit = scene.intersect(sample_ray(scene.camera, film, {0.5F, 0.5F}, any, 0, 0).ray);
    if (hit && lobes(scene.materials[scene.shapes[hit->shape].material]).delta) return true;
  }
  return false;
}

// Flags the lights that camera paths may hit through specular surfaces and that photons do not cover. If
// photons trace a light, this is so where the camera sees it through specular surfaces, or for a probe.
std::vector<bool> caustic_lights(const Plan& plan) {
  const Scene& scene = plan.scene;
  const bool sees_through_specular = is_probe(scene.camera) || sees_specular(scene);
  std::vector<bool> selected;
  for (std::size_t i = 0; i < scene.lights.size(); ++i)
    selected.push_back(!scene.lights[i].is_delta() && !scene.lights[i].is_environment() &&
                       scene.lights[i].emission.max() > 0 && (sees_through_specular || !plan.traced[i]));
  return selected;
}

// Trains the caustic guides of a plan that traces camera paths. The pilot photons come from lights that
// camera paths may hit through specular surfaces. Does nothing for a scene without caustics. The result does
// not depend on `threads`, which is at least 1.
void train_caustic_guides(Plan& plan, int threads) {
  // The first photons train the guides of the second ones. If fewer than `kMinHits` arrive, the second ones
  // would not pay off.
  constexpr PilotPhotons kFirst{PilotStage::caustic_photon_guides, 1U << 16};
  constexpr std::size_t kMinHits = 8;
  constexpr PilotPhotons kSecond{PilotStage::caustics, 1U << 20, 1U << 15};
  if (!plan.scene.features.caustics || !traces(plan.techniques, TracedPaths::camera)) return;
  const std::vector<bool> lights = caustic_lights(plan);
  if (std::ranges::find(lights, true) == lights.end()) return;
  const Emissions emissions = emissions_of(plan.scene);
  std::optional<Plan> photons = make_photon_plan(plan.scene, emissions, lights);
  if (!photons) return;
  const std::vector<CausticHits> first = trace_photons(*photons, emissions, kFirst, threads);
  if (hit_count(first) < kMinHits) return;
  train_on_hits(*photons, first);
  const std::vector<CausticHits> hits = trace_photons(*photons, emissions, kSecond, threads);
  std::vector<CausticPhoton> untraced_light_photons;
  std::vector<CausticPhoton> all;
  for (const CausticHits& batch : hits)
    for (const auto& [start, photon] : batch) {
      all.push_back(photon);
      all.back().power /= static_cast<float>(hits.size() * kPilotPhotonBatch);
      if (!plan.traced[start.light]) untraced_light_photons.push_back(all.back());
    }
  plan.guides.path_caustics = CausticGuide(std::move(untraced_light_photons), plan.scene.bounds);
  plan.guides.caustics_through_specular = CausticGuide(std::move(all), plan.scene.bounds);
}

}  // namespace

Plan make_trained_plan(const Scene& scene, int threads, const std::shared_ptr<const GuidingData>& guides) {
  Plan plan = make_plan(scene);
  if (guides != nullptr) {
    plan.guides = *guides;
    return plan;
  }
  if (plan.techniques.size() > 1) {
    train_photon_guides(plan, threads);
    train_photon_wavelengths(plan, threads);
  }
  train_caustic_guides(plan, threads);
  return plan;
}

}  // namespace abbe
