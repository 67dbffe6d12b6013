#include "results/white.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calibration/chart/patches.h"
#include "calibration/output/color_spaces.h"
#include "description/white.h"
#include "io/error.h"
#include "io/spectral_exr.h"
#include "io/text.h"
#include "results/rendered_film.h"
#include "scene/camera/camera.h"
#include "sensor/film/recorded_attributes.h"
#include "sensor/response/polarised_channels.h"
#include "spectral/rgb.h"
#include "transport/render/layers.h"
#include "transport/render/white.h"

namespace abbe {
namespace {

using Json = nlohmann::ordered_json;  // preserves the order of keys

constexpr std::size_t kMaxLights = 256;
constexpr double kSame = 1e-6;  // tolerance of chromaticities: names of bands are rounded

bool is_adaptable(const Chromaticity& xy) {
  return adaptation(unit_xyz(xy), unit_xyz(kD65)).has_value();
}

// The spectrum of a white, whether it illuminates the scene or not.
const std::optional<Curve>& light_of(const White& white) {
  return white.spectrum ? white.spectrum : white.illuminant;
}

// If the bands of a film leave nothing of a requested white to which adaptation is possible, uses the
// chromaticity of its full spectrum. Throws an error if that does not help.
void make_adaptable(White& white, Observer observer, ErrorCode code, const std::string& where) {
  if (is_adaptable(white.xy)) return;
  if (light_of(white)) white.xy = chromaticity(*light_of(white), observer);
  if (is_adaptable(white.xy)) return;
  throw Error(code, where,
              fmt::format("chromatic adaptation to this white is impossible (got {}, x {:.4f}, y {:.4f})",
                          white.name, white.xy[0], white.xy[1]));
}

White read_requested(const std::string& text, const WhiteNames& names, std::string_view origin,
                     Diagnostics& diagnostics) {
  JsonValue root{JsonValue::Object{}, {}, 0};
  set_json(root, kWhitePointer, text, diagnostics, origin);
  const JsonValue* output = root.find("output");
  const JsonValue* json = output != nullptr ? output->find("white") : nullptr;
  std::optional<White> white = json != nullptr ? read_white(*json, names, diagnostics) : std::nullopt;
  if (!white) throw Error(ErrorCode::usage, "", diagnostics.text());
  return *std::move(white);
}

// The white that the film records. If a light of the scene has its name and chromaticity, within the film's
// bands or by its full spectrum, it is that light's white.
std::optional<White> white_of_film(const Scene& scene, const Image& film) {
  const std::optional<Chromaticity> xy = recorded_white(film);
  if (!xy) return std::nullopt;
  const std::string& name = film.metadata.at(kWhiteKey);
  const FilmObserver recorded_observer = recorded_film_observer(film);
  const Observer observer = film_observer_of(scene).observer;
  for (const Light& light : scene.lights) {
    if (light.name != name) continue;
    for (const std::vector<double>& edges_nm : {recorded_observer.band_edges_nm, {}}) {
      const Chromaticity found = white_of(light, {recorded_observer.observer, edges_nm}, "").xy;
      if (std::abs(found[0] - (*xy)[0]) + std::abs(found[1] - (*xy)[1]) < kSame)
        return white_of(light, {observer, edges_nm}, "the film's");
    }
  }
  if (observer != recorded_observer.observer) return std::nullopt;
  return White{name, "the film's", *xy};
}

struct RecordedLight {
  std::string name;
  std::optional<Chromaticity> xy;  // Empty if several lights have this name.
};

std::vector<RecordedLight> recorded_lights(const Image& film) {
  const Json parsed = Json::parse(attribute_of(film.metadata, kLightsXyKey).value_or("{}"), nullptr, false);
  std::vector<RecordedLight> lights;
  for (const auto& [name, xy] : parsed.items())
    if (xy.is_null())
      lights.push_back({name, {}});
    else if (xy.is_array() && xy.size() == 2 && xy[0].is_number() && xy[1].is_number())
      lights.push_back({name, xy.get<Chromaticity>()});
  return lights;
}

// The chromaticity that a film records of a light. For the light of the film's white it is that of the white,
// which may be that of the full spectrum.
Chromaticity recorded_color(const RecordedLight& light, const Image& film) {
  const bool is_white = attribute_of(film.metadata, kWhiteKey) == light.name;
  const std::optional<Chromaticity> xy = is_white ? recorded_white(film) : std::nullopt;
  return xy ? *xy : light.xy.value_or(Chromaticity{});
}

bool is_visible(const Curve& light, const Scene& scene) {
  const XYZ xyz = tristimulus(light, Curve(1.0), film_observer_of(scene).observer);
  const std::vector<Channel> channels = intensities(scene.channels);
  return std::ranges::all_of(xyz, [](double value) { return value > 0; }) &&
         std::ranges::all_of(channels, [&](const Channel& channel) {
           return sum_product(light, channel.weight, sensed(channels)) > 0;
         });
}

// Relative noise of the pilot that determined the film's main light.
constexpr double kPilotNoise = 0.02;

// A layer of one or more lights, with their name and colour if all have the same one.
struct LightLayer {
  LightContribution contribution;
  std::string name;
  std::optional<Chromaticity> xy;
};

bool is_same(const std::optional<Chromaticity>& a, const std::optional<Chromaticity>& b) {
  constexpr double kRounding = 1e-9;
  return a && b && std::abs((*a)[0] - (*b)[0]) + std::abs((*a)[1] - (*b)[1]) < kRounding;
}

// The layer that contains a light: its own or that of all other lights; nullptr if there is neither.
LightLayer* layer_of(std::vector<LightLayer>& layers, const std::string& light) {
  for (const std::string& name : {layer_name(light), std::string(kRestOfLights)})
    for (LightLayer& layer : layers)
      if (layer.contribution.light == name) return &layer;
  return nullptr;
}

std::vector<LightLayer> layers_of(std::vector<LightContribution> contributions,
                                  const std::vector<RecordedLight>& lights) {
  std::vector<LightLayer> layers;
  for (LightContribution& contribution : contributions) layers.push_back({std::move(contribution), "", {}});
  for (const RecordedLight& light : lights) {
    LightLayer* layer = layer_of(layers, light.name);
    if (layer == nullptr) continue;
    if (layer->name.empty())
      *layer = {layer->contribution, light.name, light.xy};
    else if (!is_same(layer->xy, light.xy))
      *layer = {layer->contribution, layer->contribution.light, {}};
  }
  return layers;
}

double group_contribution(const std::vector<LightLayer>& layers, const LightLayer& layer,
                          double LightContribution::*when) {
  double sum = 0;
  for (const LightLayer& other : layers)
    if (&other == &layer || is_same(other.xy, layer.xy)) sum += other.contribution.*when;
  return sum;
}

// The layer whose colour contributes most; among layers of this colour, the one that contributes most.
const LightLayer& main_layer(const std::vector<LightLayer>& layers, double LightContribution::*when) {
  return *std::max_element(layers.begin(), layers.end(), [&](const LightLayer& a, const LightLayer& b) {
    return std::pair(group_contribution(layers, a, when), a.contribution.*when) <
           std::pair(group_contribution(layers, b, when), b.contribution.*when);
  });
}

bool is_main(const std::vector<LightLayer>& layers, const LightLayer& layer,
             double LightContribution::*when) {
  return group_contribution(layers, layer, when) >=
         (1 - kPilotNoise) * group_contribution(layers, main_layer(layers, when), when);
}

// The layer of the film's white, whose colour is set to the white. nullptr if the white is not that of a
// layer.
LightLayer* layer_of_white(std::vector<LightLayer>& layers, const std::vector<RecordedLight>& lights,
                           const Image& film) {
  const auto xy = recorded_white(film);
  if (!xy) return nullptr;
  const std::string& name = film.metadata.at(kWhiteKey);
  const auto light = std::ranges::find(lights, name, &RecordedLight::name);
  if (light != lights.end() ? light->xy && !is_same(light->xy, xy) : !lights.empty()) return nullptr;
  LightLayer* layer = layer_of(layers, name);
  if (layer != nullptr) layer->xy = xy;
  return layer;
}

constexpr int kDistances = 9;  // from the centre to the corner

// The channels at a film position. `distance` is 0 at the centre of the film and 1 at its lower right corner.
// If no light arrives there, the channels at the centre.
std::vector<Channel> channels_at(const Scene& scene, double distance) {
  if (!any_angular(scene.channels)) return scene.channels;
  const auto along = [distance](int size) { return static_cast<float>(size * (1 + distance) / 2); };
  const std::vector<Incidence> angles =
      incidence_angles(scene.camera, {along(scene.camera.width), along(scene.camera.height)});
  if (angles.empty()) return distance == 0 ? scene.channels : channels_at(scene, 0);
  std::vector<Channel> channels = scene.channels;
  for (Channel& channel : channels) channel = averaged(std::move(channel), angles);
  return channels;
}

}  // namespace

void resolve_white(Scene& scene, const std::filesystem::path& path, int threads,
                   const std::shared_ptr<const GuidingData>& guides) {
  if (!has_colors(scene)) return;
  std::optional<White>& white = scene.output.white;
  if (white && white->requested)
    make_adaptable(*white, film_observer_of(scene).observer, ErrorCode::scene,
                   fmt::format("{}: {}", input_name(path), kWhitePointer));
  white = white_of(scene, threads, guides);
}

void resolve_white(Scene& scene, const std::filesystem::path& path, const Image& film,
                   const std::optional<std::string>& requested, std::string_view origin) {
  Diagnostics diagnostics;
  scene.image_band_edges_nm = recorded_film_observer(film).band_edges_nm;
  const FilmObserver film_observer = film_observer_of(scene);
  std::optional<White>& white = scene.output.white;
  if (requested)
    white = read_requested(*requested, white_names(scene.lights, film_observer), origin, diagnostics);
  else if (!white)
    white = white_of_film(scene, film);
  else if (light_of(*white))
    white->xy = chromaticity(*light_of(*white), film_observer);
  resolve_white(scene, path);
  // The sensor is characterised under the light it receives, unless a channel receives none.
  if (!white || !white->spectrum || scene.image_band_edges_nm.empty()) return;
  Curve in_film_bands = in_bands(*white->spectrum, scene.image_band_edges_nm);
  if (is_visible(in_film_bands, scene)) white->spectrum = std::move(in_film_bands);
}

void add_white(const Scene& scene, FilmIdentity& identity) {
  if (!has_colors(scene)) return;
  const White white = white_of(scene);
  if (!std::isfinite(white.xy[0])) return;
  record_white(white.name, white.xy, white.requested, identity);
  if (scene.lights.size() > kMaxLights) return;
  const FilmObserver film_observer = film_observer_of(scene);
  Json lights = Json::object();
  for (const Light& light : scene.lights)
    if (std::ranges::count(scene.lights, light.name, &Light::name) > 1)
      lights[light.name] = nullptr;
    else if (const Chromaticity xy = white_of(light, film_observer, "").xy; std::isfinite(xy[0]))
      lights[light.name] = xy;
  if (!lights.empty()) identity[kLightsXyKey] = lights.dump();
}

White requested_white(const std::string& text, const Image& film, std::string_view origin) {
  Diagnostics diagnostics;
  const std::vector<Light> none;
  WhiteNames names = white_names(none, recorded_film_observer(film));
  std::vector<Chromaticity> colors;
  for (const RecordedLight& light : recorded_lights(film))
    for (int i = light.xy ? 1 : 2; i > 0; --i) {
      names.lights.push_back(light.name);
      colors.push_back(recorded_color(light, film));
    }
  names.white_of_light = [&](std::size_t i) { return White{names.lights[i], "", colors[i]}; };
  White white = read_requested(text, names, origin, diagnostics);
  make_adaptable(white, names.film_observer.observer, ErrorCode::usage, kWhitePointer);
  return white;
}

RelitWhite relit_white(const Image& film, std::span<const LightFactor> factors) {
  if (film.metadata.contains(kWhiteRequestedKey)) return {};
  const std::vector<RecordedLight> lights = recorded_lights(film);
  std::vector<LightLayer> layers = layers_of(light_contributions(film, factors), lights);
  const LightLayer* own = layer_of_white(layers, lights, film);
  if (own == nullptr || !is_main(layers, *own, &LightContribution::before) ||
      is_main(layers, *own, &LightContribution::after))
    return {};
  const std::string& white = film.metadata.at(kWhiteKey);
  const LightLayer& left = main_layer(layers, &LightContribution::after);
  if (!left.xy)
    return {
        {},
        fmt::format("the white remains that of \"{}\", which is no longer the main light: the film does not "
                    "record the colour of \"{}\" (choose a white with --white)",
                    white, left.contribution.light)};
  RelitWhite relit{White{left.name, "the remaining main light", *left.xy}, ""};
  if (!is_spectral(film) && !is_of_observer(film))
    relit.warning = fmt::format(
        "\"{}\", the remaining main light, is now white, but the sensor's colours are still corrected for "
        "\"{}\", the white of the render (--white {} restores that white)",
        left.name, white, white);
  return relit;
}

std::vector<Channel> channels_at_center(const Scene& scene) {
  return channels_at(scene, 0);
}

std::optional<WhiteField> white_field(const Scene& scene) {
  if (scene.spectral || !has_colors(scene) || !any_angular(scene.channels)) return std::nullopt;
  const std::optional<Curve> light = white_of(scene).spectrum;
  if (!light) return std::nullopt;
  WhiteField field;
  for (int i = 0; i < kDistances; ++i) {
    const std::vector<Channel> channels =
        intensities(channels_at(scene, i / static_cast<double>(kDistances - 1)));
    std::vector<double>& values = field.relative.emplace_back();
    for (const Channel& channel : channels) {
      values.push_back(sum_product(*light, channel.weight, sensed(channels)));
      if (!(values.back() > 0)) return std::nullopt;
    }
  }
  const std::vector<double> center = field.relative.front();
  for (std::vector<double>& values : field.relative)
    for (std::size_t k = 0; k < values.size(); ++k) values[k] /= center[k];
  return field;
}

std::optional<double> neutral_shift(const Scene& scene) {
  const std::optional<WhiteField> field = white_field(scene);
  if (!field) return std::nullopt;
  try {
    return neutral_shift(*field, display_of(scene).to_xyz_d65());
  } catch (const Error& error) {
    if (error.code != ErrorCode::usage) throw;
    return std::nullopt;  // these channels have no pictures
  }
}

}  // namespace abbe
