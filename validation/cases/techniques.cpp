// The matrix of techniques: every film with a closed form by every integrator.
#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "validation/cases/suites.h"

namespace abbe {
namespace {

// How an integrator is measured beside the film's case: by so many times its samples and no fewer than
// `least_samples`, at its own margins.
struct Measured {
  Integrator by;
  int patience = 1;
  int least_samples = 1;
  double margin = 0.01;
  double fine_margin = 0.002;
  std::vector<Override> settings = {};
};

// Whose paths all have the wavelengths of their sample: a film takes many samples, and for each of them the
// usual photons would be too many.
constexpr int kSharedWavelengths = 256;

// In the order of `kIntegratorNames`.
const std::array<Measured, kIntegratorNames.size()>& all_measured() {
  static const Override few_photons{"/render/photons/per_sample", "4096"};
  static const Override many_places{"/sensor/resolution", "[64, 64]"};  // which stay where they are
  static const std::array<Measured, kIntegratorNames.size()> all{
      {{Integrator::automatic},
       {Integrator::path},
       {Integrator::light},
       {Integrator::bdpt},
       {Integrator::photon_map, 1, kSharedWavelengths, 0.01, 0.01},
       {Integrator::ppm, 1, kSharedWavelengths, 0.01, 0.01, {few_photons, many_places}},
       {Integrator::sppm, 1, kSharedWavelengths, 0.01, 0.01, {few_photons}},
       {Integrator::vcm, 1, kSharedWavelengths, 0.01, 0.01},
       {Integrator::photon_brute, 1, 1, 0.01, 0.01},
       {Integrator::adjoint_brute, 32}}};
  return all;
}

Case cell(const Case& item, const FilmMean& film, const Measured& measured) {
  const char* name = kIntegratorNames.at(static_cast<std::size_t>(measured.by));
  TechniqueMean method{item.id, measured.by, film, Tier::thorough};
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

}  // namespace

std::vector<Case> technique_cases(const std::vector<Case>& films) {
  std::vector<Case> cells;
  for (const Case& item : films)
    if (const auto* film = std::get_if<FilmMean>(&item.method))
      for (const Measured& measured : all_measured()) cells.push_back(cell(item, *film, measured));
  return cells;
}

}  // namespace abbe
