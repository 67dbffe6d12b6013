#include "materials/index/catalogue.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "spectral/air.h"
#include "tests/materials/index_of.h"

namespace abbe {
namespace {

constexpr const char* kGlass = R"(# a comment
REFERENCES: |
    Maker. <a href="https://x.y/z.agf">Catalogue <i>2017</i></a><br>
    n < 2, see there
COMMENTS: "step 0.5"
DATA:
  - type: formula 2
    wavelength_range: 0.3 2.5
    coefficients: 0 1.03961212 0.00600069867 0.231792344 0.0200179144 1.01046945 103.560653
  - type: tabulated k
    data: |
        0.300 2.8607E-06
        0.310 1.3679E-06
        0.700 8.9305E-09
        2.500 8.1300E-06
CONDITIONS:
    temperature: 293
PROPERTIES:
    thermal_dispersion:
      - type: formula A
        coefficients: 1.86e-06 1.31e-08
    nd: 1.5168
)";

class Entry : public testing::Test {
 protected:
  ~Entry() override { std::filesystem::remove_all(folder_); }

  std::optional<NamedIndex> read(const std::string& text, Diagnostics& diagnostics) {
    std::filesystem::create_directories(folder_);
    const std::filesystem::path path = folder_ / "glass.yml";
    std::ofstream(path, std::ios::binary) << text;
    return load_index(path.string(), {}, diagnostics);
  }
  RefractiveIndex good(const std::string& text) {
    Diagnostics diagnostics;
    const auto entry = read(text, diagnostics);
    EXPECT_TRUE(entry && diagnostics.all().empty()) << diagnostics.text();
    return entry ? entry->index : RefractiveIndex(1.0);
  }
  // "line:column: message" of the first error in a file whose DATA consists of `blocks`, beginning at line 1.
  std::string fault(const std::string& blocks) { return fault_of("DATA: \n" + blocks); }
  std::string fault_of(const std::string& text) {
    Diagnostics diagnostics;
    EXPECT_FALSE(read(text, diagnostics)) << text;
    EXPECT_EQ(diagnostics.code(), ErrorCode::input) << text;
    if (diagnostics.all().empty()) return "";
    const std::string told = format(diagnostics.all().front());
    const std::string line = told.substr(0, told.find('\n'));
    const std::size_t at = line.find("glass.yml:") + 10;
    const std::size_t colon = line.find(':', line.find(':', at) + 1);
    return line.substr(at, colon - at) + ':' + line.substr(line.find(" error:") + 7);
  }

 private:
  std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) /
                                  testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(Entry, OfAGlassHasItsFormulaItsExtinctionAndItsSource) {
  Diagnostics diagnostics;
  const auto entry = read(kGlass, diagnostics);
  ASSERT_TRUE(entry) << diagnostics.text();
  EXPECT_EQ(entry->name, "glass");
  EXPECT_TRUE(entry->source.starts_with("Maker. Catalogue 2017 n < 2, see there; step 0.5; /"))
      << entry->source;
  EXPECT_NE(entry->source.find("SHA-256"), std::string::npos);
  const RefractiveIndex shipped = index_of("N-BK7");
  for (const double nm : {300.0, 365.0, 587.5618, 1100.0})
    EXPECT_DOUBLE_EQ(entry->index.n(nm), shipped.n(nm)) << nm;
  EXPECT_DOUBLE_EQ(entry->index.k(310), 1.3679e-06);
  EXPECT_DOUBLE_EQ(entry->index.k(305), (2.8607e-06 + 1.3679e-06) / 2);
  EXPECT_EQ(entry->index.low_nm(), 300);
  EXPECT_EQ(entry->index.high_nm(), 2500);
  EXPECT_EQ(entry->index.medium(), IndexMedium::air);
}

TEST_F(Entry, MayHoldAnyFormula) {
  const auto n = [&](int id, const std::string& coefficients) {
    return good("DATA:\n  - type: formula " + std::to_string(id) +
                "\n    wavelength_range: 0.4 0.8\n    coefficients: " + coefficients + "\n")
        .n(500.0);
  };
  // Values at 0.5 um, computed by hand.
  EXPECT_NEAR(n(1, "0 1.25 0.1"), std::sqrt(1 + 1.25 * 0.25 / 0.24), 1e-14);
  EXPECT_NEAR(n(2, "0 1.25 0.01"), std::sqrt(1 + 1.25 * 0.25 / 0.24), 1e-14);
  EXPECT_NEAR(n(3, "2 0.1 2 0.01 -2"), std::sqrt(2 + 0.1 * 0.25 + 0.01 * 4), 1e-14);
  EXPECT_NEAR(n(4, "2 0.2 0 0.1 1"), std::sqrt(2 + 0.2 / (0.25 - 0.1)), 1e-14);
  EXPECT_NEAR(n(5, "1.5 0.01 -2"), 1.5 + 0.01 * 4, 1e-14);
  EXPECT_NEAR(n(6, "0 0.05 200"), 1 + 0.05 / (200 - 4), 1e-14);
  EXPECT_NEAR(n(7, "1.5 0.01 0.001"), 1.5 + 0.01 / 0.222 + 0.001 / 0.222 / 0.222, 1e-14);
  EXPECT_NEAR(
      n(8, "0.3 0.05 0.04 -0.01"),
      std::sqrt((1 + 2 * (0.3 + 0.05 * 0.25 / 0.21 - 0.0025)) / (1 - (0.3 + 0.05 * 0.25 / 0.21 - 0.0025))),
      1e-14);
  EXPECT_NEAR(n(9, "2 0.01 0.04 0.02 1.2 0.1"), std::sqrt(2 + 0.01 / 0.21 - 0.02 * 0.7 / 0.59), 1e-14);
}

TEST_F(Entry, MayBeTabulated) {
  const RefractiveIndex gold = good(
      "DATA:\n  - type: tabulated nk\n    data: |\n\n        0.1879 1.28 1.188\n"
      "        0.5 0.8 2\n\n        0.6 0.2 3\n");
  EXPECT_NEAR(gold.n(550.0), 0.5, 1e-15);
  EXPECT_NEAR(gold.k(550.0), 2.5, 1e-15);
  EXPECT_EQ(gold.low_nm(), 187.9);
  EXPECT_EQ(gold.high_nm(), 600);
  const RefractiveIndex both = good(
      "DATA:\n  - type: tabulated k\n    data: \"0.3 1e-6\\n0.8 3e-6\"\n  - type: tabulated n\n    data: "
      "|-\n      0.4 1.6\n"
      "      0.6 1.5");
  EXPECT_NEAR(both.n(500.0), 1.55, 1e-15);
  EXPECT_NEAR(both.k(550.0), 2e-6, 1e-15);
  EXPECT_EQ(both.low_nm(), 400);
  const RefractiveIndex old =
      good("DATA:\r\n  - type: formula 5\r\n    range: 0.4 0.8\r\n    coefficients: 1.5 0 1\r\n");
  EXPECT_EQ(old.n(500.0), 1.5);
}

TEST_F(Entry, SaysWhatItIsRelativeTo) {
  const std::string formula =
      "DATA:\n  - type: formula 5\n    wavelength_range: 0.4 0.8\n    coefficients: 1.5 0.01 -2\n";
  const auto n = [](double um) { return 1.5 + 0.01 / (um * um); };
  const RefractiveIndex air = good(formula + "SPECS:\n    n_is_absolute: false\n");
  EXPECT_EQ(air.medium(), IndexMedium::air);
  EXPECT_DOUBLE_EQ(air.n(500.0), n(0.5));
  for (const char* section : {"SPECS", "CONDITIONS", "PROPERTIES"}) {
    const RefractiveIndex absolute = good(formula + section + ":\n    n_is_absolute: true\n");
    EXPECT_EQ(absolute.medium(), IndexMedium::vacuum);
    EXPECT_NEAR(absolute.n(500.0), n(0.5) / air_index(500), 1e-14);
  }
  EXPECT_EQ(good(formula + "SPECS:\n    n_is_absolute: True\n").medium(), IndexMedium::vacuum);
  const std::string vacuum = "SPECS:\n    wavelength_is_vacuum: true\n";
  const RefractiveIndex shifted = good(formula + vacuum);
  EXPECT_NEAR(shifted.n(500.0), n(air_to_vacuum(500) / 1e3), 1e-14);
  EXPECT_GT(std::abs(shifted.n(500.0) - n(0.5)), 2e-5);
  EXPECT_NEAR(shifted.n(SampledSpectrum(500.0F))[0], shifted.n(500.0), 1e-6);
  EXPECT_NEAR(shifted.low_nm(), vacuum_to_air(400), 1e-12);
  const RefractiveIndex table =
      good("DATA:\n  - type: tabulated n\n    data: |\n      0.1 1\n      0.5 1.5\n      0.6 1.6\n" + vacuum);
  EXPECT_NEAR(table.n(vacuum_to_air(500)), 1.5, 1e-12);
  EXPECT_EQ(table.low_nm(), 100);
}

// Ciddor's formula for air at 15 degrees, with index and wavelengths in vacuum, in the spelling of an earlier
// edition. The index of air relative to air is 1.
TEST_F(Entry, SaysItAsEarlierEditionsDid) {
  const std::string air =
      "DATA:\n  - type: formula 6\n    wavelength_range: 0.23 1.690\n"
      "    coefficients: 0 0.05792105 238.0185 0.00167917 57.362\nSPECS:\n";
  const RefractiveIndex old = good(air + "    n_absolute: true\n    wavelength_vacuum: true\n");
  EXPECT_EQ(old.medium(), IndexMedium::vacuum);
  EXPECT_NEAR(old.n(589.3), 1, 1e-8);
  EXPECT_NEAR(old.low_nm(), vacuum_to_air(230), 1e-12);
  EXPECT_NEAR(good(air + "    n_absolute: false\n").n(589.3), 1.000277, 1e-6);
  EXPECT_EQ(good(air + "    n_absolute: true\n    n_is_absolute: true\n").medium(), IndexMedium::vacuum);
}

TEST_F(Entry, DoesNotContradictItself) {
  const std::string table = "DATA:\n  - type: tabulated n\n    data: |\n      0.4 1\n      0.5 1.5\n";
  EXPECT_EQ(fault_of(table + "SPECS:\n  n_is_absolute: true\n  n_absolute: false\n"),
            "8:15: n_absolute is false, but n_is_absolute is true");
  EXPECT_EQ(
      fault_of(table + "SPECS:\n  wavelength_vacuum: false\nCONDITIONS:\n  wavelength_is_vacuum: true\n"),
      "9:25: wavelength_is_vacuum is true, but wavelength_vacuum is false");
}

TEST_F(Entry, SaysItInWordsThatAreKnown) {
  EXPECT_EQ(fault_of("DATA:\n  - type: tabulated n\n    data: |\n      0.4 1\n      0.5 1.5\n"
                     "SPECS:\n  n_is_absolute: perhaps\n"),
            "7:18: n_is_absolute (got \"perhaps\", allowed true, false)");
}

TEST_F(Entry, SaysItWhereItIsHeeded) {
  const std::string table = "  - type: tabulated n\n    data: |\n      0.4 1\n      0.5 1.5\n";
  const std::string allowed = " is ignored here (allowed only under SPECS, CONDITIONS, PROPERTIES)";
  EXPECT_EQ(fault(table + "n_is_absolute: true\n"), "6:16: n_is_absolute" + allowed);
  EXPECT_EQ(fault(table + "    wavelength_is_vacuum: true\n"), "6:27: wavelength_is_vacuum" + allowed);
  EXPECT_EQ(fault(table + "SPEC:\n  n_is_absolute: false\n"), "7:18: n_is_absolute" + allowed);
  EXPECT_EQ(fault(table + "n_absolute: true\n"), "6:13: n_absolute" + allowed);
  EXPECT_EQ(fault(table + "SPECS:\n  more:\n    n_is_absolute: true\n"), "8:20: n_is_absolute" + allowed);
}

TEST_F(Entry, KnowsWhereItsExtinctionIsMeasured) {
  const std::string n = "DATA:\n  - type: tabulated n\n    data: |\n      0.4 1.6\n      0.7 1.5\n";
  EXPECT_FALSE(good(n).k_range());
  const RefractiveIndex both =
      good(n + "  - type: tabulated k\n    data: |\n      0.5 1e-5\n      0.6 2e-5\n");
  ASSERT_TRUE(both.k_range());
  EXPECT_EQ(both.k_range()->low_nm, 500);
  EXPECT_EQ(both.k_range()->high_nm, 600);
  EXPECT_EQ(both.k(450.0), 1e-5);
  EXPECT_FALSE(both.has_measured_k(450));
  EXPECT_TRUE(both.has_measured_k(500) && both.has_measured_k(600));
  EXPECT_FALSE(both.has_measured_k(650));
}

TEST_F(Entry, IsRefusedWithoutAnIndex) {
  EXPECT_EQ(fault_of("REFERENCES: x\n"), "1:1: expected DATA, a list of formulas and tables");
  EXPECT_EQ(fault_of("DATA: 3\n"), "1:7: expected DATA, a list of formulas and tables");
  EXPECT_EQ(fault("  - type: tabulated k\n    data: |\n      0.4 0\n      0.5 1\n"),
            "2:3: no block of DATA gives n");
  EXPECT_EQ(fault("  - kind: n\n"), "2:5: expected a block with a \"type\"");
  EXPECT_EQ(fault("  - type: formula 10\n"),
            "2:11: unknown type of data (got \"formula 10\", allowed \"formula 1\" to \"formula 9\", "
            "\"tabulated n\", "
            "\"tabulated nk\" and \"tabulated k\")");
  EXPECT_EQ(fault_of("DATA: [\n").substr(0, 15), "2:1: not YAML: ");
}

TEST_F(Entry, IsRefusedWhenItGivesSomethingTwice) {
  const std::string n = "  - type: tabulated n\n    data: |\n      0.4 1.6\n      0.6 1.5\n";
  EXPECT_EQ(fault(n + n), "6:5: n is given twice");
  EXPECT_EQ(
      fault("  - type: tabulated nk\n    data: |\n      0.4 1 1\n      0.6 1 1\n  - type: tabulated k\n"),
      "6:5: k is given twice");
  EXPECT_EQ(fault(n + "  - type: formula 5\n    wavelength_range: 0.4 0.8\n    coefficients: 1.5 0 1\n"),
            "6:5: n is given twice");
}

TEST_F(Entry, ChecksFormulas) {
  const auto of = [&](const std::string& id, const std::string& range, const std::string& coefficients) {
    return fault("  - type: formula " + id + "\n    wavelength_range: " + range +
                 "\n    coefficients: " + coefficients + "\n");
  };
  EXPECT_EQ(of("2", "0.4 0.8", "0 1.1 0.01 0.2"),
            "4:19: wrong number of coefficients for formula 2 (got 4, allowed 3 to 17, odd)");
  EXPECT_EQ(of("8", "0.4 0.8", "1 2 3"),
            "4:19: wrong number of coefficients for formula 8 (got 3, allowed 4)");
  EXPECT_EQ(of("1", "0.4 0.8", "0 1 .1 0 1 0 1 0 1 0 1 0 1 0 1 0 1 0 1"),
            "4:19: wrong number of coefficients for formula 1 (got 19, allowed 3 to 17, odd)");
  EXPECT_EQ(of("5", "0.4 0.8", "1.5 x 2"),
            "4:19: expected a number (got \"x\", allowed finite decimal numbers)");
  EXPECT_EQ(of("5", "0.4 0.8", "1.5 .nan 2"),
            "4:19: expected a number (got \".nan\", allowed finite decimal numbers)");
  EXPECT_EQ(of("5", "0.8 0.4", "1.5 0 1"),
            "2:5: expected a wavelength_range of two ascending wavelengths in micrometres");
  EXPECT_EQ(of("5", "0.4", "1.5 0 1"),
            "2:5: expected a wavelength_range of two ascending wavelengths in micrometres");
  EXPECT_EQ(fault("  - type: formula 5\n    coefficients: 1.5 0 1\n"),
            "2:5: expected numbers under \"wavelength_range\"");
  EXPECT_EQ(fault("  - type: formula 5\n    wavelength_range: 0.4 0.8\n"),
            "2:5: expected numbers under \"coefficients\"");
  EXPECT_EQ(of("5", "2.4 25", "1.5 0 1"),
            "2:5: wavelengths from 2400 to 25000 nm lie outside [300, 1100] nm; is the unit right?");
  EXPECT_EQ(of("2", "0.4 0.8", "0 1 0.25"),
            "2:5: dispersion formula 2 has a resonance at 500 nm, inside its range [400, 800] nm");
  EXPECT_EQ(of("5", "0.4 0.8", "0.9 0 1"),
            "2:5: dispersion formula 5 gives n = 0.9 at 400 nm (allowed above 1)");
}

TEST_F(Entry, ChecksTables) {
  const auto of = [&](const std::string& type, const std::string& rows) {
    return fault("  - type: tabulated " + type + "\n    data: |\n" + rows);
  };
  EXPECT_EQ(of("n", "      0.4 1.6\n      0.6 1.5 0\n"), "5:7: wrong number of cells (got 3, allowed 2)");
  EXPECT_EQ(of("n", "\n      0.4 1.6\n\n       0.6 nan\n"),
            "7:8: expected a number (got \"nan\", allowed finite decimal numbers)");
  EXPECT_EQ(of("nk", "      0.4 1.6 0\n      0.3 1.5 0\n"),
            "5:7: wavelengths must ascend (got 300 nm after 400 nm)");
  EXPECT_EQ(of("nk", "      0.4 1.6 0\n      0.4 1.5 0\n"),
            "5:7: wavelengths must ascend (got 400 nm after 400 nm)");
  EXPECT_EQ(of("n", "      -0.4 1.6\n      0.6 1.5\n"), "4:7: expected a wavelength above 0 (got -0.4)");
  EXPECT_EQ(of("n", "      0.4 1.6\n"), "3:11: needs at least two samples (got 1)");
  EXPECT_EQ(of("n", "      400 1.6\n      600 1.5\n"),
            "3:11: wavelengths from 400000 to 600000 nm lie outside [300, 1100] nm; is the unit right?");
  EXPECT_EQ(of("n", "      0.4 1.6\n      0.6 0\n"),
            "3:11: an index must be positive and its extinction not negative (got n down to 0, k down to 0)");
  EXPECT_EQ(
      of("nk", "      0.4 1.6 0\n      0.6 1 -1\n"),
      "3:11: an index must be positive and its extinction not negative (got n down to 1, k down to -1)");
  EXPECT_EQ(fault("  - type: tabulated n\n"), "2:5: expected a table under \"data\"");
}

TEST_F(Entry, HasALimitedSize) {
  Diagnostics diagnostics;
  EXPECT_FALSE(read(std::string((std::size_t{1} << 22) + 1, '#'), diagnostics));
  EXPECT_EQ(diagnostics.code(), ErrorCode::resource);
}

TEST(EntryFile, MustBeThere) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_index("nowhere.yml", {}, diagnostics));
  EXPECT_EQ(diagnostics.code(), ErrorCode::input);
  EXPECT_EQ(diagnostics.all().front().message, "no such file \"nowhere.yml\"");
}

}  // namespace
}  // namespace abbe
