// The matrix of the suite techniques: every film with a closed form, rendered by every integrator.
#include <algorithm>
#include <array>
#include <set>
#include <string>

#include <fmt/format.h>

#include "validation/cases/suites.h"

namespace abbe {
namespace {

using Films = std::set<std::string>;

// Measurement of an integrator on the films: changes to each film's case, and the tier in which each film is
// rendered. Films that no set names are in `default_tier`.
struct MeasuredIntegrator {
  Integrator integrator;
  int sample_factor = 1;  // multiplies the samples of the case
  int min_samples = 1;
  double margin = 0.01;
  double fine_margin = 0.002;
  std::vector<Override> settings = {};
  Films quick = {};
  Films tests = {};
  Films thorough = {};
  Tier default_tier = Tier::thorough;
  Films never = {};  // too little light arrives, or each path takes too long
};

// If all paths of a sample have the same wavelengths, a film needs many samples. The default number of
// photons for each would take too long. The samples suffice to distinguish a map that is 0.7 % low from one
// that is 1 % low.
constexpr int kSharedWavelengths = 256;

// Measurements of all integrators, in the order of `kIntegratorNames`. `ppm` gathers photons as `sppm` does
// and needs long renders for enough visible points, so it renders a few films only. Integrators that gather
// photons are biased, so their `fine_margin` is as wide as `margin`.
const std::array<MeasuredIntegrator, kIntegratorNames.size()>& all_measured() {
  static const Override few_photons{"/render/photons/per_sample", "4096"};
  // 12 neighbours among a quarter of the photons span the same radius as 48 among all, about the default.
  static const Override few_neighbours{"/render/photons/nearest", "12"};
  // `ppm` never moves its visible points, so their mean over the film takes many of them.
  static const Override many_visible_points{"/sensor/resolution", "[128, 128]"};
  static const Films long_path_films{"T1-0.8", "T1-0.95", "T8",      "T10-upper", "T10-lower",
                                     "T11",    "T11-16",  "layer-1", "layer-0.2", "scattered-blue"};
  static const Films long_or_rare_path_films = [] {
    Films both = long_path_films;
    both.insert("ball-disc");
    return both;
  }();
  static const std::array<MeasuredIntegrator, kIntegratorNames.size()> all{
      {{.integrator = Integrator::automatic, .tests = {"ball-meter"}},
       {.integrator = Integrator::path,
        .tests = {"T1-0.2", "T5-axis", "T11", "T12-white", "T12-glass", "T13-60", "T16-inside", "pane-thick",
                  "ball-axis", "scattered-once", "scattered-blue", "layer-1"}},
       // One photon in 4e8 hits the sphere of T17, and fewer come to the line of sight in the fog.
       {.integrator = Integrator::light,
        .sample_factor = 16,
        .quick = {"ball-disc"},
        .tests = {"T1-0.2", "T6-discs", "ball-meter", "ball-inside"},
        .never = {"T17-0", "T17-60", "T17-90", "scattered-once", "scattered-blue"}},
       {.integrator = Integrator::bdpt,
        .sample_factor = 2,
        .quick = {"T1-0.2", "T3-corner", "T5-axis", "T6-discs", "T9-outer", "T12-glass", "T13-60", "T17-60",
                  "ball-axis", "ball-inside"},
        .tests = {"T1-0.8", "T10-upper", "T11-4", "T15-R", "T16-inside", "ball-meter", "pane-thick"},
        .never = {"T1-0.95", "T8", "layer-0.2"}},
       {.integrator = Integrator::photon_map,
        .min_samples = 2 * kSharedWavelengths,
        .fine_margin = 0.01,
        .settings = {few_photons, few_neighbours},
        .tests = {"T9-outer", "T13-60"},
        .never = long_or_rare_path_films},
       {.integrator = Integrator::ppm,
        .min_samples = kSharedWavelengths,
        .fine_margin = 0.01,
        .settings = {few_photons, many_visible_points},
        .thorough = {"T1-0", "T1-0.2", "T1-0.5", "T2-centre", "T9-outer"},
        .default_tier = Tier::never},
       {.integrator = Integrator::sppm,
        .min_samples = kSharedWavelengths,
        .fine_margin = 0.01,
        .settings = {few_photons},
        .tests = {"T1-0.2", "T12-white"},
        .never = long_or_rare_path_films},
       {.integrator = Integrator::vcm,
        .min_samples = kSharedWavelengths,
        .fine_margin = 0.01,
        .quick = {"T12-white", "T9-outer"},
        .tests = {"T15-T"},
        .never = long_path_films},
       {.integrator = Integrator::photon_brute,
        .fine_margin = 0.01,
        .tests = {"T1-0.2", "T6-discs", "T6-opposite"},
        .never = {"T1-0.95", "worked-example", "flat-bessell_V-5000"}},
       {.integrator = Integrator::adjoint_brute,
        .sample_factor = 32,
        .fine_margin = 0.005,
        .quick = {"T5-axis", "T6-discs"},
        .tests = {"T9-outer", "T12-glass", "T15-T", "ball-inside"},
        .never = {"ball-disc", "ball-meter", "layer-1", "layer-0.2", "worked-example", "T4", "T5-off"}}}};
  return all;
}

Tier tier_of(const std::string& film, const MeasuredIntegrator& measured) {
  if (measured.never.contains(film)) return Tier::never;
  if (measured.quick.contains(film)) return Tier::quick;
  if (measured.tests.contains(film)) return Tier::tests;
  return measured.thorough.contains(film) ? Tier::thorough : measured.default_tier;
}

Case cell(const Case& item, const FilmMean& film, const MeasuredIntegrator& measured) {
  const char* name = kIntegratorNames.at(static_cast<std::size_t>(measured.integrator));
  TechniqueMean method{item.id, measured.integrator, film, tier_of(item.id, measured)};
  method.film.samples = std::max(measured.min_samples, film.samples * measured.sample_factor);
  method.film.fine_margin = measured.fine_margin;
  for (const Override& setting : measured.settings) method.film.settings.push_back(setting);
  return {Suite::techniques,
          fmt::format("{} by {}", item.id, name),
          fmt::format("{}, by {}", item.title, name),
          item.source,
          item.unit,
          {measured.margin, Margin::Kind::relative},
          std::move(method)};
}

// The flat fields differ only in light and filter, so one represents all.
bool is_repeated(const std::string& film) {
  return film.starts_with("flat-") && film != "flat-bessell_V-5000";
}

}  // namespace

std::vector<Case> technique_cases(const std::vector<Case>& films) {
  std::vector<Case> cells;
  for (const Case& item : films)
    if (const auto* film = std::get_if<FilmMean>(&item.method); film != nullptr && !is_repeated(item.id))
      for (const MeasuredIntegrator& measured : all_measured()) cells.push_back(cell(item, *film, measured));
  return cells;
}

}  // namespace abbe
