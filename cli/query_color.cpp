#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "calibration/chart/delta_e.h"
#include "calibration/chart/patches.h"
#include "calibration/metrics/camera_quality.h"
#include "cli/answer.h"
#include "cli/query.h"
#include "io/table.h"
#include "materials/index/library.h"
#include "report/image_difference.h"
#include "sensor/response/channel.h"
#include "sensor/response/table_range.h"
#include "spectral/astm_e308.h"
#include "spectral/curve_use.h"
#include "spectral/library.h"

namespace abbe::cli {
namespace {

struct IlluminatedSurface {
  Curve illuminant;
  Curve reflectance;
};

// Loads an illuminant and a reflectance for these channels.
IlluminatedSurface load(const std::string& illuminant, const std::string& reflectance,
                        Diagnostics& diagnostics, std::span<const Channel> channels) {
  const NeededRange needed = needed_by(channels);
  const auto light = load_illuminant(illuminant, {}, diagnostics, needed);
  if (light) check_light_range(*light, channels, {}, diagnostics);
  std::optional<NamedCurve> surface;
  if (!reflectance.empty()) surface = load_curve(kReflectanceUse, reflectance, {}, diagnostics, needed);
  check(diagnostics);
  return {light->curve, surface ? surface->curve : Curve(1.0)};
}

// X, Y, Z of a surface and of the perfect diffuser under the same illuminant.
struct SurfaceColor {
  XYZ xyz;
  XYZ white;
};

SurfaceColor color_every_nm(const ColorOptions& options, Diagnostics& diagnostics) {
  const IlluminatedSurface surface =
      load(options.illuminant, options.reflectance, diagnostics, observer_channels(options.observer));
  const SumRange range = options.range.value_or(SumRange{});
  return {tristimulus(surface.illuminant, surface.reflectance, options.observer, range),
          tristimulus(surface.illuminant, Curve(1.0), options.observer, range)};
}

SurfaceColor color_by_astm(const ColorOptions& options, Diagnostics& diagnostics) {
  if (options.range)
    throw Error(ErrorCode::usage, "--range",
                fmt::format("applies to --method 1nm only: the weights of ASTM E308 cover {} to {} nm",
                            kAstmRange.low_nm, kAstmRange.high_nm));
  const auto light = load_illuminant(options.illuminant, {}, diagnostics,
                                     {double{kAstmRange.low_nm}, double{kAstmRange.high_nm}});
  if (light) check_light_range(*light, observer_channels(options.observer), {}, diagnostics);
  std::optional<Samples> samples = Samples{{double{kAstmRange.low_nm}, kAstmRange.low_nm + 10.0}, {1, 1}};
  if (!options.reflectance.empty()) samples = load_astm_samples(options.reflectance, {}, diagnostics);
  check(diagnostics);
  const std::vector<double>& nm = samples->wavelengths_nm;
  const TristimulusWeights weights =
      astm_weights(light->curve, options.observer, static_cast<int>(nm[1] - nm[0]));
  return {astm_tristimulus(weights, *samples), astm_white(weights)};
}

constexpr const char* kMaterial = "material";
constexpr const char* kGlass = "glass";  // too many to list by default
constexpr std::array kTableKinds{kMaterial, kGlass,   "illuminant", "reflectance",
                                 "camera",  "filter", "observer"};

std::vector<std::string> names_of_kind(std::string_view kind) {
  if (kind == kMaterial) return index_names();
  return kind == kGlass ? glass_names() : table_names(std::string(kind));
}

// Adds the ranges of n and k of each listed material and its source, as lists parallel to the names. The
// range of k is null if k is not measured.
void add_index_ranges(Json& answer, const std::string& kind) {
  Diagnostics diagnostics;
  for (const auto& name : Json(answer[kind])) {
    const NamedIndex material = accepted(load_index(name, {}, diagnostics), diagnostics);
    const auto& k = material.index.k_range();
    answer["low_nm"].push_back(material.index.low_nm());
    answer["high_nm"].push_back(material.index.high_nm());
    answer["k_low_nm"].push_back(k ? Json(k->low_nm) : Json());
    answer["k_high_nm"].push_back(k ? Json(k->high_nm) : Json());
    answer["source"].push_back(material.source);
  }
}

// Text after the name of one material: a tab, the ranges, a tab, and the source. The range of k is omitted if
// it is that of n.
std::string index_description(const Json& answer, std::size_t i) {
  const auto range = [&](const char* low, const char* high) {
    return fmt::format("{:g}-{:g} nm", answer[low][i].get<double>(), answer[high][i].get<double>());
  };
  const std::string n = range("low_nm", "high_nm");
  const std::string k = answer["k_low_nm"][i].is_null() ? "unknown" : range("k_low_nm", "k_high_nm");
  return fmt::format("\t{}{}\t{}", n, k == n ? "" : fmt::format(" (k {})", k),
                     answer["source"][i].get_ref<const std::string&>());
}

void print_camera_metrics(const std::vector<Channel>& channels, bool json) {
  const CameraSpace space = camera_space(channels);
  Json answer;
  answer["vora"] = space.vora;
  answer["luther_residual"] = {{"x", space.luther[0]}, {"y", space.luther[1]}, {"z", space.luther[2]}};
  answer["sensitivity_index"] = channels.size() == 3 ? Json(sensitivity_index(channels)) : Json();
  print(answer, json);
}

}  // namespace

void query_color(const ColorOptions& options) {
  Diagnostics diagnostics;
  const auto [xyz, white] = options.method == ColorMethod::astm_e308 ? color_by_astm(options, diagnostics)
                                                                     : color_every_nm(options, diagnostics);
  if (!std::isfinite(white[1]))
    throw Error(ErrorCode::input, options.illuminant, "has no visible light and therefore no colour");
  Json answer;
  if (options.method == ColorMethod::astm_e308) answer["method"] = "astm-e308";
  answer["XYZ"] = xyz;
  answer["xy"] = chromaticity(xyz);
  answer["Lab"] = xyz_to_lab(xyz, white);
  print(answer, options.json);
}

void query_delta_e(const DeltaEOptions& options) {
  Json answer;
  answer["dE00"] = delta_e_2000(options.lab1, options.lab2);
  answer["dE76"] = delta_e_76(options.lab1, options.lab2);
  answer["dE94"] = delta_e_94(options.lab1, options.lab2);
  for (const auto& [key, formula] :
       {std::pair{"dE_CAM16_UCS", DeltaE::cam16_ucs}, std::pair{"dE_ITP", DeltaE::itp}})
    answer[key] = delta_e(formula, options.lab1, options.lab2);
  print(answer, options.json);
}

void query_camera(const CameraOptions& options) {
  Diagnostics diagnostics;
  if (options.illuminant.empty() && !options.metrics)
    throw Error(ErrorCode::usage, "query camera", "needs --illuminant or --judge");
  const auto channels = load_camera(options.name, {}, diagnostics, options.response, ResponseScale::relative);
  if (options.metrics) return print_camera_metrics(accepted(channels, diagnostics), options.json);
  const IlluminatedSurface surface =
      load(options.illuminant, options.reflectance, diagnostics,
           channels ? std::span<const Channel>(*channels) : std::span<const Channel>());
  const std::vector<double> raw = camera_raw(*channels, surface.illuminant, surface.reflectance);
  Json answer;
  for (std::size_t i = 0; i < raw.size(); ++i) answer["raw"][(*channels)[i].name] = raw[i];
  print(answer, options.json);
}

std::vector<std::string> table_kinds() {
  return {kTableKinds.begin(), kTableKinds.end()};
}

void query_list(const ListOptions& options) {
  Json answer = Json::object();
  for (const char* kind : kTableKinds)
    if (options.kind.empty() || options.kind == kind) answer[kind] = names_of_kind(kind);
  if (answer.empty())
    throw Error(ErrorCode::usage, "--list", unknown_name("kind", options.kind, table_kinds()));
  const bool has_index = options.kind == kMaterial || options.kind == kGlass;
  if (has_index) add_index_ranges(answer, options.kind);
  if (options.json) return print(answer, true);
  for (const auto& [kind, names] : answer.items()) {
    if (has_index && kind != options.kind) continue;
    if (options.kind.empty()) fmt::print("{}\n", kind);
    if (options.kind.empty() && kind == kGlass) {
      fmt::print("  {} glasses of manufacturers, listed by --list {}\n", names.size(), kGlass);
      continue;
    }
    for (std::size_t i = 0; i < names.size(); ++i)
      fmt::print("{}{}{}\n", options.kind.empty() ? "  " : "", names[i].get_ref<const std::string&>(),
                 has_index ? index_description(answer, i) : "");
  }
}

}  // namespace abbe::cli
