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

}  // namespace

std::vector<Case> sensor_cases() {
  return {computed_case(Suite::sensor, "ccd-counts", "electrons of a filtered CCD before black bodies",
                        "photon counts of Planck's law [Planck1901] in measured passbands [Bessell1990]",
                        "1/(s m² sr)", {1e-6, Margin::Kind::relative}, ccd_counts)};
}

}  // namespace abbe
