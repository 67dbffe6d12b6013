#include <algorithm>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

constexpr int kMostPaths = 2'400'000;
constexpr int kMostSamples = 40'000;
constexpr double kMostVertices = 6e8;
constexpr double kMostPairs = 3e7;  // of vertices, or of a vertex and a photon: minutes of CPU time at most

// How many photons are traced, and how they are gathered. Returns how many each sample has at least.
int draw_photons(Drawing& drawing, Json& render) {
  Random& random = drawing.random;
  const int per_sample = static_cast<int>(decades(random, 1, 2e4));
  render["photons"]["per_sample"] = per_sample;
  if (chance(random, 0.5)) render["photons"]["radius"] = drawing.size * decades(random, 1e-4, 1);
  if (render["integrator"] == "photon-map") {
    render["photons"]["nearest"] = static_cast<int>(decades(random, 1, 1000));
    render["photons"]["final_gather"] = chance(random, 0.5);
  }
  return per_sample;
}

double depth_of(const Json& render) {
  constexpr int kUsualDepth = 100;
  return render.value("max_depth", kUsualDepth);
}

// Each of two paths of n events may be joined at each event, and what gathers photons may find each event of
// all of them.
double pairs_of_sample(const Json& render, int pixels, int photons) {
  const double depth = depth_of(render);
  return pixels * depth * (photons > 0 ? photons : depth);
}

void draw_strategies(Random& random, Json& render) {
  render["directions"] = one_of(random, {"bsdf", "cosine", "uniform"});
  render["lights"] = one_of(random, {"mis", "bsdf", "light"});
  if (render["lights"] == "mis") render["heuristic"] = one_of(random, {"balance", "power"});
}

}  // namespace

void draw_render(Drawing& drawing) {
  Random& random = drawing.random;
  const Json& resolution = drawing.scene["sensor"]["resolution"];
  const int pixels = resolution[0].get<int>() * resolution[1].get<int>();
  Json& render = drawing.scene["render"];
  const std::string integrator =
      one_of(random, {"auto", "auto", "auto", "path", "path", "light", "bdpt", "vcm", "sppm", "ppm",
                      "photon-map", "photon-brute", "adjoint-brute"});
  render["integrator"] = integrator;
  if (integrator == "auto" && chance(random, 0.1)) render["consistent"] = true;
  if (integrator == "path" && chance(random, 0.2)) draw_strategies(random, render);
  const bool gathers = integrator == "sppm" || integrator == "ppm" || integrator == "photon-map";
  const int photons = gathers || integrator == "photon-brute" ? draw_photons(drawing, render) : 0;
  // What is merged is blurred, over the edges of walls too.
  if (gathers || integrator == "vcm" || render.contains("consistent")) drawing.closed = false;
  const double part_of_most = decades(random, 0.001, 1);
  if (chance(random, 0.1)) render["polarisation"] = "off";
  render["seed"] = integer(random, 0, 1 << 30);
  const bool plays = chance(random, 0.8);
  const bool joins = integrator == "bdpt" || integrator == "vcm";
  if (joins || !plays || chance(random, 0.5))
    render["max_depth"] = static_cast<int>(decades(random, 1, plays && !joins ? 1000 : 60));
  render["roulette_depth"] = plays ? integer(random, 0, 12) : -1;
  const int paths = std::max(pixels, photons);
  double most = std::min(kMostSamples, kMostPaths / paths);
  most = std::min(most, kMostVertices / (paths * depth_of(render)));
  if (joins || gathers) most = std::min(most, kMostPairs / pairs_of_sample(render, pixels, photons));
  render["samples"] = static_cast<int>(most * part_of_most + 1);
}

}  // namespace abbe::soak
