// The matrix of techniques: every film with a closed form by every integrator.
#include <algorithm>
#include <array>
#include <set>
#include <string>

#include <fmt/format.h>

#include "validation/cases/suites.h"

namespace abbe {
namespace {

using Films = std::set<std::string>;

// How an integrator is measured beside the film's case, and which runs afford it for which films.
struct MeasuredTechnique {
  Integrator by;
  int patience = 1;  // by which the samples are multiplied
  int least_samples = 1;
  double margin = 0.01;
  double fine_margin = 0.002;
  std::vector<Override> settings = {};
  Films quick = {};
  Films tests = {};
  Films thorough = {};
  Tier others = Tier::thorough;
  Films never = {};  // too little arrives, or each path takes too long
};

// Where all paths of a sample have the same wavelengths a film takes many samples, for each of which the
// usual photons would be too many. A map whose light is .7 % low must be told from one that is 1 % low.
constexpr int kSharedWavelengths = 256;

// In the order of `kIntegratorNames`. `ppm` gathers as `sppm` does, from places that take much time to be
// enough: a few films stand for all. What gathers photons is biased, and stays at its quick margin.
const std::array<MeasuredTechnique, kIntegratorNames.size()>& all_measured() {
  static const Override few_photons{"/render/photons/per_sample", "4096"};
  static const Override few_neighbours{"/render/photons/nearest", "12"};  // no farther than 48 of the usual
  static const Override many_places{"/sensor/resolution", "[128, 128]"};  // which `ppm` never leaves
  static const Films of_long_paths{"T1-0.8", "T1-0.95", "T8",      "T10-upper", "T10-lower",
                                   "T11",    "T11-16",  "layer-1", "layer-0.2", "scattered-blue"};
  static const Films of_long_paths_or_rare = [] {
    Films both = of_long_paths;
    both.insert("ball-disc");
    return both;
  }();
  static const std::array<MeasuredTechnique, kIntegratorNames.size()> all{
      {{.by = Integrator::automatic, .tests = {"ball-meter"}},
       {.by = Integrator::path,
        .tests = {"T1-0.2", "T5-axis", "T11", "T12-white", "T12-glass", "T13-60", "T16-inside", "pane-thick",
                  "ball-axis", "scattered-once", "scattered-blue", "layer-1"}},
       // The sphere of T17 is met by one photon in 4e8, and the line of sight of the lamp in fog by fewer.
       {.by = Integrator::light,
        .patience = 16,
        .quick = {"ball-disc"},
        .tests = {"T1-0.2", "T6-discs", "ball-meter", "ball-inside"},
        .never = {"T17-0", "T17-60", "T17-90", "scattered-once", "scattered-blue"}},
       {.by = Integrator::bdpt,
        .patience = 2,
        .quick = {"T1-0.2", "T3-corner", "T5-axis", "T6-discs", "T9-outer", "T12-glass", "T13-60", "T17-60",
                  "ball-axis", "ball-inside"},
        .tests = {"T1-0.8", "T10-upper", "T11-4", "T15-R", "T16-inside", "ball-meter", "pane-thick"},
        .never = {"T1-0.95", "T8", "layer-0.2"}},
       {.by = Integrator::photon_map,
        .least_samples = 2 * kSharedWavelengths,
        .fine_margin = 0.01,
        .settings = {few_photons, few_neighbours},
        .tests = {"T9-outer", "T13-60"},
        .never = of_long_paths_or_rare},
       {.by = Integrator::ppm,
        .least_samples = kSharedWavelengths,
        .fine_margin = 0.01,
        .settings = {few_photons, many_places},
        .thorough = {"T1-0", "T1-0.2", "T1-0.5", "T2-centre", "T9-outer"},
        .others = Tier::never},
       {.by = Integrator::sppm,
        .least_samples = kSharedWavelengths,
        .fine_margin = 0.01,
        .settings = {few_photons},
        .tests = {"T1-0.2", "T12-white"},
        .never = of_long_paths_or_rare},
       {.by = Integrator::vcm,
        .least_samples = kSharedWavelengths,
        .fine_margin = 0.01,
        .quick = {"T12-white", "T9-outer"},
        .tests = {"T15-T"},
        .never = of_long_paths},
       {.by = Integrator::photon_brute,
        .fine_margin = 0.01,
        .tests = {"T1-0.2", "T6-discs", "T6-opposite"},
        .never = {"T1-0.95", "worked-example", "flat-bessell_V-5000"}},
       {.by = Integrator::adjoint_brute,
        .patience = 32,
        .fine_margin = 0.005,
        .quick = {"T5-axis", "T6-discs"},
        .tests = {"T9-outer", "T12-glass", "T15-T", "ball-inside"},
        .never = {"ball-disc", "ball-meter", "layer-1", "layer-0.2", "worked-example", "T4", "T5-off"}}}};
  return all;
}

Tier tier_of(const std::string& film, const MeasuredTechnique& measured) {
  if (measured.never.contains(film)) return Tier::never;
  if (measured.quick.contains(film)) return Tier::quick;
  if (measured.tests.contains(film)) return Tier::tests;
  return measured.thorough.contains(film) ? Tier::thorough : measured.others;
}

Case cell(const Case& item, const FilmMean& film, const MeasuredTechnique& measured) {
  const char* name = kIntegratorNames.at(static_cast<std::size_t>(measured.by));
  TechniqueMean method{item.id, measured.by, film, tier_of(item.id, measured)};
  method.film.samples = std::max(measured.least_samples, film.samples * measured.patience);
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

// Of the flat fields, which differ in lamp and filter alone, one stands for all.
bool is_repeated(const std::string& film) {
  return film.starts_with("flat-") && film != "flat-bessell_V-5000";
}

}  // namespace

std::vector<Case> technique_cases(const std::vector<Case>& films) {
  std::vector<Case> cells;
  for (const Case& item : films)
    if (const auto* film = std::get_if<FilmMean>(&item.method); film != nullptr && !is_repeated(item.id))
      for (const MeasuredTechnique& measured : all_measured()) cells.push_back(cell(item, *film, measured));
  return cells;
}

}  // namespace abbe
