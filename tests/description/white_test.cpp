#include "description/white.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "io/json.h"
#include "io/table.h"

namespace abbe {
namespace {

// Printed chromaticities of fluorescent lamps are sums at steps of 5 nm; those of daylight and of A are sums
// over a wider range. Sums at 1 nm differ by up to 3e-4.
constexpr double kPrinted = 3.5e-4;

std::optional<White> white_of_json(const std::string& text, const WhiteNames& names,
                                   Diagnostics& diagnostics) {
  const auto json = parse_json(std::make_shared<const SourceText>(SourceText{"white", text}), diagnostics);
  return json ? read_white(*json, names, diagnostics) : std::nullopt;
}

// CIE 15:2018 and CIE 15:2004 print these values for both standard observers.
TEST(White, EveryNamedIlluminantHasThePrintedChromaticity) {
  const ReferenceTable table("white_points");
  EXPECT_GE(table.rows(), 60U);
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const std::string& name = table.text(row, "illuminant");
    const bool wide = table.text(row, "observer") == "10";
    const std::vector<Light> no_lights;
    const WhiteNames names = white_names(no_lights, {wide ? Observer::cie1964 : Observer::cie1931, {}});
    Diagnostics diagnostics;
    const auto white = white_of_json('"' + name + '"', names, diagnostics);
    ASSERT_TRUE(white) << name << '\n' << diagnostics.text();
    EXPECT_EQ(white->name, name);
    EXPECT_NEAR(white->xy[0], table.number(row, "x_pub"), kPrinted) << name << ", 10 degrees: " << wide;
    EXPECT_NEAR(white->xy[1], table.number(row, "y_pub"), kPrinted) << name << ", 10 degrees: " << wide;
  }
}

}  // namespace
}  // namespace abbe
