#include "film/white.h"

#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calibration/output/color_spaces.h"
#include "description/white.h"
#include "io/standard_stream.h"
#include "scene/colors.h"
#include "sensor/film/recorded_film_observer.h"
#include "sensor/film/recorded_white.h"
#include "spectral/rgb.h"
#include "transport/render/white.h"

namespace abbe {
namespace {

using Json = nlohmann::ordered_json;  // keys keep their order

constexpr std::size_t kMostLights = 256;
constexpr double kSame = 1e-6;  // of chromaticities: names of bands are rounded

void require_adaptable(const White& white, ErrorCode code, const std::string& where) {
  if (adaptation(unit_xyz(white.xy), unit_xyz(kD65))) return;
  throw Error(code, where,
              fmt::format("is no white that an eye adapts to (got {}, x {:.4f}, y {:.4f})", white.name,
                          white.xy[0], white.xy[1]));
}

White read_asked(const std::string& text, const WhiteNames& names, std::string_view said_by,
                 Diagnostics& diagnostics) {
  JsonValue root{JsonValue::Object{}, {}, 0};
  set_json(root, kWhitePointer, text, diagnostics, said_by);
  const JsonValue* output = root.find("output");
  const JsonValue* json = output != nullptr ? output->find("white") : nullptr;
  std::optional<White> white = json != nullptr ? read_white(*json, names, diagnostics) : std::nullopt;
  if (!white) throw Error(ErrorCode::usage, "", diagnostics.text());
  return *std::move(white);
}

// What the film says of its white, by a light of the scene where that is the same one.
std::optional<White> white_of_film(const Scene& scene, const Image& film) {
  const std::optional<Chromaticity> xy = recorded_white(film);
  if (!xy) return std::nullopt;
  const std::string& name = film.metadata.at(kWhiteKey);
  const FilmObserver of_film = recorded_film_observer(film);
  const FilmObserver film_observer = film_observer_of(scene);
  for (const Light& light : scene.lights) {
    if (light.name != name) continue;
    const Chromaticity found = white_of(light, of_film, "").xy;
    if (std::abs(found[0] - (*xy)[0]) + std::abs(found[1] - (*xy)[1]) < kSame)
      return white_of(light, film_observer, "the film's");
  }
  if (film_observer.observer != of_film.observer) return std::nullopt;
  return White{name, "the film's", *xy};
}

}  // namespace

void settle_white(Scene& scene, const std::filesystem::path& path, int threads,
                  const std::shared_ptr<const Guides>& guides) {
  if (!has_colors(scene)) return;
  if (scene.output.white)
    require_adaptable(*scene.output.white, ErrorCode::scene,
                      fmt::format("{}: {}", input_name(path), kWhitePointer));
  scene.output.white = white_of(scene, threads, guides);
}

void settle_white(Scene& scene, const std::filesystem::path& path, const Image& film,
                  const std::optional<std::string>& asked, std::string_view said_by) {
  Diagnostics diagnostics;
  scene.image_band_edges_nm = recorded_film_observer(film).band_edges_nm;
  if (asked)
    scene.output.white =
        read_asked(*asked, white_names(scene.lights, film_observer_of(scene)), said_by, diagnostics);
  std::optional<White>& white = scene.output.white;
  if (!white) white = white_of_film(scene, film);
  if (white && white->spectrum) white->xy = chromaticity(*white->spectrum, film_observer_of(scene));
  settle_white(scene, path);
  // The sensor is characterised in the light that it is shown.
  if (white && white->spectrum && !scene.image_band_edges_nm.empty())
    white->spectrum = in_bands(*white->spectrum, scene.image_band_edges_nm);
}

void add_white(const Scene& scene, FilmIdentity& identity) {
  if (!has_colors(scene)) return;
  const White white = white_of(scene);
  if (!std::isfinite(white.xy[0])) return;
  record_white(white.name, white.xy, identity);
  if (scene.lights.size() > kMostLights) return;
  const FilmObserver film_observer = film_observer_of(scene);
  Json lights = Json::object();
  for (const Light& light : scene.lights)
    if (std::count_if(scene.lights.begin(), scene.lights.end(),
                      [&light](const Light& other) { return other.name == light.name; }) > 1)
      lights[light.name] = nullptr;
    else if (const Chromaticity xy = white_of(light, film_observer, "").xy; std::isfinite(xy[0]))
      lights[light.name] = xy;
  if (!lights.empty()) identity[kLightsXyKey] = lights.dump();
}

std::vector<RecordedLight> recorded_lights(const Image& film) {
  const auto recorded = film.metadata.find(kLightsXyKey);
  Json told = Json::object();
  if (recorded != film.metadata.end()) told = Json::parse(recorded->second, nullptr, false);
  std::vector<RecordedLight> lights;
  for (const auto& [name, xy] : told.items())
    if (xy.is_null())
      lights.push_back({name, {}});
    else if (xy.is_array() && xy.size() == 2 && xy[0].is_number() && xy[1].is_number())
      lights.push_back({name, xy.get<Chromaticity>()});
  return lights;
}

White asked_white(const std::string& text, const Image& film, std::string_view said_by) {
  Diagnostics diagnostics;
  const std::vector<Light> none;
  WhiteNames names = white_names(none, recorded_film_observer(film));
  std::vector<Chromaticity> colors;
  for (const RecordedLight& light : recorded_lights(film))
    for (int i = light.xy ? 1 : 2; i > 0; --i) {
      names.lights.push_back(light.name);
      colors.push_back(light.xy.value_or(Chromaticity{}));
    }
  names.white_of_light = [&](std::size_t i) { return White{names.lights[i], "", colors[i]}; };
  White white = read_asked(text, names, said_by, diagnostics);
  require_adaptable(white, ErrorCode::usage, kWhitePointer);
  return white;
}

}  // namespace abbe
