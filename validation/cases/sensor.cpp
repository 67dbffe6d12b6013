#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "io/reference_table.h"
#include "sensor/response/channel.h"
#include "spectral/sources.h"
#include "validation/cases/figures.h"
#include "validation/cases/suites.h"
#include "validation/cases/tables.h"

namespace abbe {
namespace {

std::vector<Figure> ccd_counts() {
  const ReferenceTable table("ccd_bandpass_counts");
  std::vector<Figure> figures;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& filter = table.text(row, "passband");
    const std::string& efficiency = table.text(row, "ccd_qe");
    const double kelvin = table.number(row, "T_K");
    const Curve response = product(shipped_curve("filter", filter),
                                   efficiency == "none" ? Curve(1.0) : shipped_curve("camera", efficiency));
    const Channel channel = quantum_channel("counts", response);
    figures.push_back(exact_figure(fmt::format("{} {} K, efficiency {}", filter, kelvin, efficiency),
                                   table.number(row, "N"),
                                   sum_product(planck(kelvin), channel.weight, {300, 1050})));
  }
  return figures;
}

// The same counts as a film's: pi/(4 N^2) of the radiance reaches the film of an f/4 lens, for 20 ms.
std::vector<Case> flat_fields() {
  const ReferenceTable table("ccd_bandpass_counts");
  std::vector<Case> cases;
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& filter = table.text(row, "passband");
    const std::string& kelvin = table.text(row, "T_K");
    const std::string& efficiency = table.text(row, "ccd_qe");
    if (efficiency == "none") continue;
    const double expected = table.number(row, "N") * std::numbers::pi / (4 * 4 * 4) * 0.02;
    cases.push_back({Suite::sensor,
                     fmt::format("flat-{}-{}", filter, kelvin),
                     fmt::format("flat field of a CCD behind {}, black body of {} K", filter, kelvin),
                     "photon counts of Planck's law [Planck1901] through an f/4 lens",
                     "electrons/m²",
                     {0.01, Margin::Kind::relative},
                     FilmMean{"flat_field.json",
                              {{"/sensor/quantum_efficiency", efficiency},
                               {"/sensor/channels/electrons/filters/0", filter},
                               {"/lights/0/emission/blackbody_K", kelvin}},
                              "electrons",
                              expected,
                              64,
                              0.001}});
  }
  return cases;
}

}  // namespace

std::vector<Case> sensor_cases() {
  std::vector<Case> cases{
      computed_case(Suite::sensor, "ccd-counts", "electrons of a filtered CCD before black bodies",
                    "photon counts of Planck's law [Planck1901] in measured passbands [Bessell1990]",
                    "1/(s m² sr)", {1e-6, Margin::Kind::relative}, ccd_counts)};
  for (Case& item : flat_fields()) cases.push_back(std::move(item));
  return cases;
}

}  // namespace abbe
