#include "spectral/air.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/data_directory.h"
#include "io/table.h"

namespace abbe {
namespace {

TEST(Air, index_of_standard_air_at_a_label) {
  // The violet end, where the wavelengths in air and in vacuum differ by 0.113 nm.
  EXPECT_NEAR(air_index(400), 1.00028276, 5e-9);
}

TEST(Air, agrees_with_the_catalogued_formula) {
  const ReferenceTable lines("refractive_index_lines");
  const std::size_t air = lines.rows() - 1;
  ASSERT_EQ(lines.text(air, "id"), "air_15C");
  EXPECT_NEAR(air_index(404.6561), lines.number(air, "n_h"), 6e-8);
  EXPECT_NEAR(air_index(587.5618), lines.number(air, "n_d"), 6e-8);
  EXPECT_NEAR(air_index(706.5188), lines.number(air, "n_r"), 6e-8);
}

TEST(Air, coefficients_are_those_of_the_catalogue) {
  Diagnostics diagnostics;
  const auto table =
      read_table(data_directory() / "glass" / "dielectrics.csv", TableOrigin::shipped, diagnostics);
  ASSERT_TRUE(table) << diagnostics.text();
  const auto is_air = [](const std::vector<std::string>& row) { return row.front() == "air_15C"; };
  const auto air = std::find_if(table->rows.begin(), table->rows.end(), is_air);
  ASSERT_NE(air, table->rows.end());
  const auto c = [&](const char* name) { return std::stod(air->at(table->column(name).value())); };
  for (const double nm : {300.0, 550.0, 1100.0}) {
    const double s2 = 1e6 / (air_to_vacuum(nm) * air_to_vacuum(nm));
    EXPECT_NEAR(air_index(nm), 1 + c("c1") + c("c2") / (c("c3") - s2) + c("c4") / (c("c5") - s2), 1e-14)
        << nm;
  }
}

TEST(Air, conversions_are_inverse_and_mean_the_same_index) {
  for (double nm = 300; nm <= 1100; nm += 12.5) {
    const double vacuum = air_to_vacuum(nm);
    EXPECT_NEAR(vacuum_to_air(vacuum), nm, 1e-11);
    EXPECT_NEAR(vacuum / nm, air_index(nm), 1e-14);
    EXPECT_GT(vacuum, nm);
  }
}

TEST(Air, sodium_d2_line) {
  // Measured in both: 589.1583 nm in vacuum, 588.9951 nm in air.
  EXPECT_NEAR(air_to_vacuum(588.9951), 589.1583, 1e-4);
}

}  // namespace
}  // namespace abbe
