#include "film/relit_white.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "film/white.h"
#include "io/spectral_exr.h"
#include "sensor/film/recorded_white.h"
#include "spectral/colorimetry.h"
#include "transport/render/layers.h"

namespace abbe {
namespace {

// Of what the film gets: to it the pilot tells which light is the main one.
constexpr double kPilotNoise = 0.02;

// A layer of lights with their name and colour, where they have one.
struct Lamp {
  LightShare share;
  std::string name;
  std::optional<Chromaticity> xy;
};

bool is_same(const std::optional<Chromaticity>& a, const std::optional<Chromaticity>& b) {
  constexpr double kRounding = 1e-9;
  return a && b && std::abs((*a)[0] - (*b)[0]) + std::abs((*a)[1] - (*b)[1]) < kRounding;
}

// The layer that a light is in, its own or that of all others; null where there is neither.
Lamp* lamp_of(std::vector<Lamp>& lamps, const std::string& light) {
  for (const std::string& layer : {layer_name(light), std::string(kRestOfLights)})
    for (Lamp& lamp : lamps)
      if (lamp.share.light == layer) return &lamp;
  return nullptr;
}

std::vector<Lamp> lamps_of(std::vector<LightShare> shares, const std::vector<RecordedLight>& lights) {
  std::vector<Lamp> lamps;
  for (LightShare& share : shares) lamps.push_back({std::move(share), "", {}});
  for (const RecordedLight& light : lights) {
    Lamp* lamp = lamp_of(lamps, light.name);
    if (lamp == nullptr) continue;
    if (lamp->name.empty())
      *lamp = {lamp->share, light.name, light.xy};
    else if (!is_same(lamp->xy, light.xy))
      *lamp = {lamp->share, lamp->share.light, {}};
  }
  return lamps;
}

// What a lamp gives together with those of its colour.
double given(const std::vector<Lamp>& lamps, const Lamp& lamp, double LightShare::*when) {
  double sum = 0;
  for (const Lamp& other : lamps)
    if (&other == &lamp || is_same(other.xy, lamp.xy)) sum += other.share.*when;
  return sum;
}

// The one that gives most with those of its colour, and of these the strongest.
const Lamp& main_lamp(const std::vector<Lamp>& lamps, double LightShare::*when) {
  return *std::max_element(lamps.begin(), lamps.end(), [&](const Lamp& a, const Lamp& b) {
    return std::pair(given(lamps, a, when), a.share.*when) < std::pair(given(lamps, b, when), b.share.*when);
  });
}

bool is_main(const std::vector<Lamp>& lamps, const Lamp& lamp, double LightShare::*when) {
  return given(lamps, lamp, when) >= (1 - kPilotNoise) * given(lamps, main_lamp(lamps, when), when);
}

// The lamp that the film has its white from, which then is known by that; null where it is of no lamp.
Lamp* lamp_of_white(std::vector<Lamp>& lamps, const std::vector<RecordedLight>& lights, const Image& film) {
  const auto xy = recorded_white(film);
  if (!xy) return nullptr;
  const std::string& name = film.metadata.at(kWhiteKey);
  const auto light = std::find_if(lights.begin(), lights.end(),
                                  [&](const RecordedLight& recorded) { return recorded.name == name; });
  if (light != lights.end() ? light->xy && !is_same(light->xy, xy) : !lights.empty()) return nullptr;
  Lamp* lamp = lamp_of(lamps, name);
  if (lamp != nullptr) lamp->xy = xy;
  return lamp;
}

}  // namespace

RelitWhite relit_white(const Image& film, std::span<const LightFactor> factors) {
  if (film.metadata.contains(kWhiteAskedKey)) return {};
  const std::vector<RecordedLight> lights = recorded_lights(film);
  std::vector<Lamp> lamps = lamps_of(light_shares(film, factors), lights);
  const Lamp* own = lamp_of_white(lamps, lights, film);
  if (own == nullptr || !is_main(lamps, *own, &LightShare::before) ||
      is_main(lamps, *own, &LightShare::after))
    return {};
  const std::string& white = film.metadata.at(kWhiteKey);
  const Lamp& left = main_lamp(lamps, &LightShare::after);
  if (!left.xy)
    return {{},
            fmt::format("the white stays that of \"{}\", which is the main light no more: the film does not "
                        "tell the colour of \"{}\" (--white tells another)",
                        white, left.share.light)};
  RelitWhite relit{White{left.name, "the main light that is left", *left.xy}, ""};
  if (!is_spectral(film) && !is_of_observer(film))
    relit.shortcoming = fmt::format(
        "\"{}\", the main light that is left, is white, while the colours of the sensor stay corrected for "
        "\"{}\", as they were rendered (--white {} keeps that white)",
        left.name, white, white);
  return relit;
}

}  // namespace abbe
