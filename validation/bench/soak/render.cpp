#include <algorithm>

#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

constexpr int kMaxPaths = 2'400'000;
constexpr int kMaxSceneSamples = 40'000;
constexpr double kMaxVertices = 6e8;
// Pairs of vertices, or of a vertex and a photon; they take minutes of CPU time at most.
constexpr double kMaxVertexPairs = 3e7;

// Draws the photon settings. Returns a lower bound of the photons per sample.
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

// Connections of two paths of n events may join any two events. Photon gathering may find each event of all
// photons from every event of a camera path.
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
  // Photon merging blurs the film, also across the edges of walls.
  if (gathers || integrator == "vcm" || render.contains("consistent")) drawing.closed = false;
  const double sample_fraction = decades(random, 0.001, 1);
  if (chance(random, 0.1)) render["polarisation"] = "off";
  render["seed"] = integer(random, 0, 1 << 30);
  const bool uses_roulette = chance(random, 0.8);
  const bool connects = integrator == "bdpt" || integrator == "vcm";
  if (connects || !uses_roulette || chance(random, 0.5))
    render["max_depth"] = static_cast<int>(decades(random, 1, uses_roulette && !connects ? 1000 : 60));
  render["roulette_depth"] = uses_roulette ? integer(random, 0, 12) : -1;
  const int paths = std::max(pixels, photons);
  double max_samples = std::min(kMaxSceneSamples, kMaxPaths / paths);
  max_samples = std::min(max_samples, kMaxVertices / (paths * depth_of(render)));
  if (connects || gathers)
    max_samples = std::min(max_samples, kMaxVertexPairs / pairs_of_sample(render, pixels, photons));
  render["samples"] = static_cast<int>(max_samples * sample_fraction + 1);
}

}  // namespace abbe::soak
