#include "transport/render/learn_aims.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "scene/extent.h"
#include "transport/render/pilot.h"
#include "transport/render/pilot_photons.h"
#include "transport/render/relative_splats.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

// Photons, each with what it adds to the film.
struct Pilots {
  std::vector<PhotonStart> starts;
  std::vector<Splat> splats;
  [[nodiscard]] std::size_t size() const { return splats.size(); }
};

Pilots trace_batch(LightTracer& tracer, std::span<const Sampler> photons, const RelativePlaces& places) {
  Pilots pilots;
  std::vector<std::optional<std::uint32_t>> branches(photons.size());
  tracer.tell_apart(
      [&](std::uint32_t photon, const FilmPoint& at, const LightHistory& of, std::span<const double> values) {
        if (!(magnitude(values) > 0)) return;
        places.add(photon, at, values, pilots.splats);
        if (!branches[photon]) branches[photon] = of.branch;
      });
  tracer.trace(photons, [](std::uint32_t, const FilmPoint&, std::span<const double>) {});
  tracer.tell_apart({});
  pilots.starts.assign(tracer.starts().begin(), tracer.starts().end());
  for (std::size_t i = 0; i < branches.size(); ++i) pilots.starts[i].branch = branches[i].value_or(0);
  return pilots;
}

// Adds photons to those there are.
void trace_pilots(const Plan& plan, const RelativePlaces& places, const PilotPhotons& photons, int threads,
                  std::optional<double> ball_radius, Pilots& all) {
  for (const auto& [starts, splats] : trace_pilot_photons(
           plan.scene, photons, threads,
           [&](RayCaster&caster) { return LightTracer(plan, caster, 1, ball_radius); },
           [&](LightTracer&tracer, std::span<const Sampler> some) {
             return trace_batch(tracer, some, places);
           })) {
    for (const Splat& splat : splats)
      all.splats.push_back({all.starts.size() + splat.of, splat.place, splat.value});
    all.starts.insert(all.starts.end(), starts.begin(), starts.end());
  }
}

constexpr std::uint32_t kPilotsOfAims = 1U << 17;

// Of one light, aims are learned from no fewer photons: of fewer it is too likely that they miss a way on
// which much of its light comes, which only those that go anywhere would be left for, each of great power.
constexpr double kEnough = Aim::kEnough;

// By how many photons light is shown: such of one worth w as have the same mean and spread,
// (sum w)^2 / sum w^2.
struct Count {
  double worth = 0;
  double squares = 0;
  [[nodiscard]] double photons() const { return worth > 0 ? worth * worth / squares : 0; }
  void add(const Count& other) {
    worth += other.worth;
    squares += other.squares;
  }
};

// What pilots have shown, and by how many of them each light is shown.
struct Shown {
  std::vector<ShownStart> starts;
  std::vector<Count> lights;
};

// Of photons that come to the film with relative mean square s, drawn by p0, as many are best drawn as p0
// sqrt(s) says; those drawn show p0.
Shown show(const Plan& plan, const RelativePlaces& places, const Pilots& pilots) {
  const std::vector<double> squares = relative_squares(pilots.splats, places, pilots.starts.size());
  Shown shown{{}, std::vector<Count>(plan.guides.aims.size())};
  for (std::size_t i = 0; i < squares.size(); ++i)
    if (squares[i] > 0 && std::isfinite(squares[i])) {
      shown.starts.push_back({pilots.starts[i], std::sqrt(squares[i])});
      shown.lights[pilots.starts[i].light].add({std::sqrt(squares[i]), squares[i]});
    }
  return shown;
}

std::vector<std::vector<ShownRay>> rays_of_lights(std::span<const ShownStart> shown, const Plan& plan) {
  std::vector<std::vector<ShownRay>> rays(plan.guides.aims.size());
  for (const auto& [start, weight] : shown)
    rays[start.light].push_back({start.from, start.direction, weight, start.branch});
  return rays;
}

// Branches with grids of their own, so that the grids of all lights take some 32 MB at most.
std::size_t branches_per_light(const Plan& plan) {
  constexpr std::size_t kMostGrids = 256;
  constexpr std::size_t kMostBranches = 6;
  const auto lights = static_cast<std::size_t>(std::ranges::count_if(plan.guides.aims, &Aim::learns));
  return std::clamp<std::size_t>(kMostGrids / std::max<std::size_t>(1, lights), 1, kMostBranches);
}

bool is_shown_enough(const Count& light) {
  return light.photons() >= kEnough;
}

// Lights that are shown by too few keep the aims that they have at a meter, which is closed in on: nothing
// like that is known for other cameras, so that theirs are guessed.
void aim_by(const Shown& shown, Plan& plan) {
  const std::vector<std::vector<ShownRay>> rays = rays_of_lights(shown.starts, plan);
  for (std::size_t light = 0; light < rays.size(); ++light)
    if (is_shown_enough(shown.lights[light]))
      plan.guides.aims[light].learn(rays[light], branches_per_light(plan));
    else if (!is_meter(plan.scene.camera))
      plan.guides.aims[light].guess(rays[light]);
}

// By how many photons the lights are shown, taken together, that can be aimed and are shown by too few each;
// nothing where they bring no more than such a share of all that is shown. Lights that a single photon shows
// bring about as much as those that none shows [Good1953]: where that is more than the share, one shows them.
std::optional<double> photons_of_few(const Shown& shown, const Plan& plan, double share) {
  constexpr double kSingle = 1.5;
  Count all;
  Count few;
  Count single;
  for (std::size_t light = 0; light < shown.lights.size(); ++light) {
    const Count& here = shown.lights[light];
    all.add(here);
    if (!plan.guides.aims[light].learns() || is_shown_enough(here)) continue;
    few.add(here);
    if (here.photons() < kSingle) single.add(here);
  }
  if (!(few.worth > share * all.worth)) return std::nullopt;
  return single.worth > share * all.worth ? 1 : few.photons();
}

// Pilots by their lights and branches.
std::map<std::pair<std::uint32_t, std::uint32_t>, Count> count_branches(const Shown& shown) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Count> branches;
  for (const auto& [start, weight] : shown.starts)
    branches[{start.light, start.branch}].add({weight, weight * weight});
  return branches;
}

// Fraction of the weight on branches that too few pilot photons took, of lights whose guides are trained.
// Lights with too few pilot photons in all are the subject of `photons_of_few`.
double undertrained_fraction(const Shown& shown) {
  double all = 0;
  double few = 0;
  for (const auto& [branch, count] : count_branches(shown)) {
    all += count.worth;
    if (is_shown_enough(shown.lights[branch.first]) && !is_shown_enough(count)) few += count.worth;
  }
  return all > 0 ? few / all : 0;
}

// Effective number of photons of the branch that has the fewest, among those of more than this fraction of
// the weight; nothing if there is none.
std::optional<double> photons_of_rarest_branch(const Shown& shown, double fraction) {
  const auto branches = count_branches(shown);
  Count all;
  for (const auto& [branch, count] : branches) all.add(count);
  std::optional<double> fewest;
  for (const auto& [branch, count] : branches)
    if (count.worth > fraction * all.worth)
      fewest = std::min(fewest.value_or(count.photons()), count.photons());
  return fewest;
}

Shown show(const Plan& plan, PilotStage stage, int threads) {
  const RelativePlaces places(plan.scene);
  Pilots pilots;
  trace_pilots(plan, places, {stage, kPilotsOfAims}, threads, {}, pilots);
  return show(plan, places, pilots);
}

// Traces more photons where a light or a branch has too few, unless the first were too long on their ways.
Shown show_enough(const Plan& plan, PilotStage stage, int threads, std::optional<double> ball_radius = {}) {
  constexpr double kShare = 0.01;
  constexpr double kMostTimes = 8;
  const RelativePlaces places(plan.scene);
  Pilots pilots;
  trace_pilots(plan, places, {stage, kPilotsOfAims}, threads, ball_radius, pilots);
  Shown shown = show(plan, places, pilots);
  std::optional<double> few = photons_of_few(shown, plan, kShare);
  if (const auto rarest = photons_of_rarest_branch(shown, kShare))
    few = std::min(few.value_or(*rarest), *rarest);
  if (!few || *few >= kEnough || pilots.starts.size() < kPilotsOfAims) return shown;
  const auto times = static_cast<std::uint32_t>(std::min(std::ceil(2 * kEnough / *few), kMostTimes));
  PilotPhotons more{stage, (times - 1) * kPilotsOfAims};
  more.first = kPilotsOfAims;
  trace_pilots(plan, places, more, threads, ball_radius, pilots);
  return show(plan, places, pilots);
}

// What comes to a small meter comes into each ball around it. So photons are aimed at a large one first,
// which many come into by chance, then at ever smaller ones, each of which a good part of those comes into
// that are aimed at the one before.
void close_in_on_meter(Plan& plan, double ball_radius, int threads) {
  constexpr double kStep = 4;
  if (kStep * ball_radius < scene_radius(plan.scene.bounds))
    close_in_on_meter(plan, kStep * ball_radius, threads);
  aim_by(show_enough(plan, PilotStage::meter_aims, threads, ball_radius), plan);
}

bool all_are_shown_enough(const Shown& shown, const Plan& plan) {
  for (std::size_t light = 0; light < shown.lights.size(); ++light)
    if (plan.guides.aims[light].learns() && !is_shown_enough(shown.lights[light])) return false;
  return true;
}

// Whether a good part of what is shown is of lights that few photons show.
bool few_show_much(const Shown& shown, const Plan& plan) {
  constexpr double kMuch = 0.1;
  return photons_of_few(shown, plan, kMuch).value_or(kEnough) < kEnough;
}

// Where light passes at all, from aims that are even.
void aim_roughly(Plan& plan, int threads) {
  const Camera& camera = plan.scene.camera;
  if (const std::optional<Opening> opening = traits(camera).opening; is_meter(camera) && opening) {
    const Shown shown = show(plan, PilotStage::first_aims, threads);
    if (!all_are_shown_enough(shown, plan)) return close_in_on_meter(plan, extent(*opening), threads);
    return aim_by(shown, plan);
  }
  const Shown shown = show_enough(plan, PilotStage::first_aims, threads);
  plan.guides.photons_are_rare = few_show_much(shown, plan);
  aim_by(shown, plan);
}

}  // namespace

// First where light passes at all, then, from photons aimed there, how much of it.
void learn_aims(Plan& plan, int threads) {
  if (plan.traced_lights.empty()) return;
  aim_roughly(plan, threads);
  const Shown shown = show_enough(plan, PilotStage::aims, threads);
  plan.guides.photons_are_rare = plan.guides.photons_are_rare || few_show_much(shown, plan);
  plan.guides.undertrained_fraction = undertrained_fraction(shown);
  aim_by(shown, plan);
}

void aim_where(std::span<const ShownStart> shown, Plan& plan) {
  const std::vector<std::vector<ShownRay>> rays = rays_of_lights(shown, plan);
  for (std::size_t light = 0; light < rays.size(); ++light)
    plan.guides.aims[light].learn(rays[light], branches_per_light(plan));
}

}  // namespace abbe
