#include <gtest/gtest.h>

#include "sensor/response/channel.h"
#include "spectral/library.h"
#include "spectral/sources.h"
#include "tests/reference/reference_table.h"

namespace abbe {
namespace {

Curve load(const char* folder, const std::string& name) {
  Diagnostics diagnostics;
  const std::optional<NamedCurve> curve = load_curve(folder, name, {}, diagnostics);
  EXPECT_TRUE(curve.has_value()) << diagnostics.text();
  return curve ? curve->curve : Curve();
}

TEST(Response, AFilteredCcdCountsTheElectronsOfPlanckianSources) {
  const test::ReferenceTable counts("ccd_bandpass_counts");
  for (std::size_t row = 0; row < counts.rows(); ++row) {
    const std::string& efficiency = counts.text(row, "ccd_qe");
    const Curve response = product(load("filter", counts.text(row, "passband")),
                                   efficiency == "none" ? Curve(1.0) : load("camera", efficiency));
    const Channel channel = quantum_channel("counts", response);
    const double expected = counts.number(row, "N");
    const double measured = sum_product(planck(counts.number(row, "T_K")), channel.weight, {300, 1050});
    EXPECT_NEAR(measured, expected, 1e-6 * expected) << counts.text(row, "passband") << ' ' << efficiency;
  }
}

}  // namespace
}  // namespace abbe
