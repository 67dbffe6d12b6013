#include "spectral/curve_use.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/table.h"
#include "spectral/astm_e308.h"
#include "spectral/chart.h"
#include "spectral/library.h"

namespace abbe {
namespace {

class CurveUseTest : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  // A user's table of two patches, measured every 10 nm.
  std::string table(const std::string& unit, double value) {
    std::ofstream file(path_);
    file << "# unit: " << unit << "\n# outside: clamp\nwavelength_nm,a,b\n";
    for (int nm = 380; nm <= 780; nm += 10) file << fmt::format("{},0.5,{}\n", nm, value);
    file.close();
    return path_.string();
  }

  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / fmt::format("abbe_curve_use_{}.csv", ::getpid());
};

TEST_F(CurveUseTest, LampsByNameArePowers) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_illuminant(table("umol/(m^2 s nm)", 1) + ":b", {}, diagnostics));
  EXPECT_NE(diagnostics.text().find("hc/lambda for each photon"), std::string::npos) << diagnostics.text();
  Diagnostics sound;
  EXPECT_TRUE(load_illuminant(table("mW/(m^2 nm)", 1) + ":b", {}, sound)) << "of any scale";
}

TEST_F(CurveUseTest, ATableIsHeldToTheUnitAndTheRangeOfItsUse) {
  const auto complaint = [](const CurveUse& use, const std::string& name) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_curve(use, name, {}, diagnostics)) << name;
    EXPECT_EQ(diagnostics.code(), ErrorCode::input);
    return diagnostics.text();
  };
  const std::string percent = table("%", 0.9);
  for (const CurveUse& use :
       {kReflectanceUse, kReflectanceFactorUse, kTransmittanceUse, kQuantumEfficiencyUse})
    EXPECT_NE(complaint(use, percent + ":b").find("has the wrong unit (got \"%\", allowed fractions of 1)"),
              std::string::npos);
  const std::string dense = table("transmittance", 1.1);
  EXPECT_NE(complaint(kTransmittanceUse, dense + ":b").find("(got 1.1, allowed [0, 1.05])"),
            std::string::npos);
  Diagnostics diagnostics;
  EXPECT_TRUE(load_curve(kQuantumEfficiencyUse, dense + ":b", {}, diagnostics)) << diagnostics.text();
}

TEST_F(CurveUseTest, ChartsAreReflectancesAsSharesOfOne) {
  const auto complaint = [](const std::string& name) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_chart(name, {}, diagnostics)) << name;
    return diagnostics.text();
  };
  EXPECT_NE(complaint(table("reflectance in percent", 0.9)).find("has the wrong unit"), std::string::npos);
  EXPECT_NE(
      complaint(table("1", 20)).find("\"b\" is no reflectance (got values in [20, 20], allowed [0, 2])"),
      std::string::npos);
  Diagnostics diagnostics;
  EXPECT_TRUE(load_chart(table("1", 1.4), {}, diagnostics)) << diagnostics.text();
}

TEST_F(CurveUseTest, SumsOfAstmE308AreOfReflectancesAsSharesOfOne) {
  for (const auto& [unit, value] : {std::pair{"%", 0.5}, {"1", 5.5}, {"1", -0.1}}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_astm_samples(table(unit, value) + ":b", {}, diagnostics)) << unit << ' ' << value;
  }
  Diagnostics diagnostics;
  EXPECT_TRUE(load_astm_samples(table("1", 0.9) + ":b", {}, diagnostics)) << diagnostics.text();
}

// Any covered range is sufficient.
constexpr NeededRange kSomeWavelength{kMaxWavelengthNm, kMinWavelengthNm};

void expect_allowed(const Table& table, const std::string& name, const CurveUse& use,
                    Diagnostics& diagnostics) {
  for (const std::string& column : table.columns) {
    if (column.starts_with("wavelength")) continue;
    const auto curve = curve_of(table, column, name, diagnostics, kSomeWavelength);
    ASSERT_TRUE(curve) << diagnostics.text();
    EXPECT_TRUE(check_use(name + ":" + column, curve->unit, curve->curve, use, {}, diagnostics))
        << diagnostics.text();
  }
}

TEST(CurveUse, EveryShippedTableIsWhatItIsUsedAs) {
  Diagnostics diagnostics;
  std::set<std::filesystem::path> seen;
  for (const CurveUse& use : {kTransmittanceUse, kReflectanceFactorUse, kQuantumResponseUse})
    for (const std::string& name : table_names(use.folder)) {
      const auto found = find_table(use.folder, name, {}, diagnostics);
      ASSERT_TRUE(found) << name;
      if (!seen.insert(found->path).second) continue;
      const auto table = read_table(found->path, TableOrigin::shipped, diagnostics);
      ASSERT_TRUE(table) << name;
      if (is_spectral(*table)) expect_allowed(*table, name, use, diagnostics);
    }
}

}  // namespace
}  // namespace abbe
