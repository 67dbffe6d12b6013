#include "spectral/library.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "spectral/colorimetry.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

/// A user's file that is deleted with the object.
class UserFile {
 public:
  explicit UserFile(const std::string& text) {
    path_ = std::filesystem::temp_directory_path() /
            ("abbe_library_test_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) + "_" +
             ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".csv");
    std::ofstream(path_) << text;
  }
  ~UserFile() { std::filesystem::remove(path_); }
  UserFile(const UserFile&) = delete;
  UserFile& operator=(const UserFile&) = delete;

  [[nodiscard]] std::string name() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

void expect_refused(const std::string& text, const std::string& complaint) {
  const UserFile file(text);
  Diagnostics diagnostics;
  EXPECT_FALSE(load_curve("reflectance", file.name(), {}, diagnostics)) << text;
  EXPECT_NE(diagnostics.text().find(complaint), std::string::npos) << diagnostics.text();
}

TEST(Library, finds_illuminants_by_their_names) {
  for (const char* name : {"A", "cie_A", "D65", "FL11", "F11", "LED-B3", "HP5", "iso7589_photoflood"}) {
    Diagnostics diagnostics;
    const auto curve = load_illuminant(name, {}, diagnostics);
    ASSERT_TRUE(curve) << diagnostics.text();
    EXPECT_EQ(curve->name, name);
    EXPECT_FALSE(curve->source.empty());
    EXPECT_GT(curve->curve.max(), 0);
  }
}

TEST(Library, an_unknown_name_suggests_the_nearest) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_illuminant("FL22", {}, diagnostics));
  EXPECT_NE(diagnostics.text().find("FL2"), std::string::npos) << diagnostics.text();
}

TEST(Library, illuminant_a_follows_its_definition_beyond_the_table) {
  Diagnostics diagnostics;
  const auto a = load_illuminant("A", {}, diagnostics);
  ASSERT_TRUE(a);
  EXPECT_NEAR(a->curve(560), 100, 1e-9);
  EXPECT_NEAR(a->curve(780), 241.675, 1e-3);
  // A Planckian radiator of 1.435e7/2848 nm, which is 2855.5 K with the exact constants.
  const double kelvin = 2848 * photon_energy(1) / kBoltzmann / 1.435e7;
  for (const int nm : {781, 900, 1100}) {
    EXPECT_NEAR(a->curve(nm) / 100, planck_radiance(kelvin, nm) / planck_radiance(kelvin, 560), 1e-9);
  }
  EXPECT_NEAR(a->curve(300), 0.930483, 1e-9);
}

// E has constant power. 1 W of it therefore has 683.002 times the mean of V over [300, 1100] nm, whose sum is
// 106.857 nm.
TEST(Library, illuminant_e_follows_its_definition_beyond_the_table) {
  for (const char* name : {"E", "cie_E"}) {
    Diagnostics diagnostics;
    const auto e = load_illuminant(name, {}, diagnostics, kEveryWavelength);
    ASSERT_TRUE(e) << diagnostics.text();
    EXPECT_EQ(e->low_nm, 300);
    EXPECT_EQ(e->high_nm, 1100);
    for (const double nm : {300.0, 359.9, 360.0, 560.0, 830.0, 830.1, 1100.0})
      EXPECT_EQ(e->curve(nm), 100) << nm;
    EXPECT_NEAR(photometric(e->curve) / e->curve.integral(), 683.002 * 106.857 / 800, 1e-3);
  }
}

TEST(Library, illuminants_are_the_same_within_curves) {
  for (const std::string name : {"A", "E"})
    for (const std::string& said : {name, "cie_" + name, "cie_" + name + ":" + name}) {
      Diagnostics diagnostics;
      const auto lamp = load_illuminant(name, {}, diagnostics);
      const auto curve = load_curve("illuminant", said, {}, diagnostics);
      ASSERT_TRUE(lamp && curve) << diagnostics.text();
      EXPECT_EQ(curve->high_nm, 1100) << said;
      for (const double nm : {310.0, 560.0, 1000.0}) EXPECT_EQ(curve->curve(nm), lamp->curve(nm)) << said;
    }
}

// Only D65 is tabulated over this range in ISO/CIE 11664-2. The others are S0 + M1 S1 + M2 S2 with the CIE's
// rounded factors, such as 61.9 + 1.039 * 9.8 + 0.363 * 6.5 for D50.
TEST(Library, daylight_illuminants_go_on_to_830_nm) {
  Diagnostics diagnostics;
  const auto d65 = load_illuminant("D65", {}, diagnostics);
  ASSERT_TRUE(d65) << diagnostics.text();
  const std::vector<double> published = {63.8434, 64.304,  61.8779, 59.4519, 55.7054,
                                         51.959,  54.6998, 57.4406, 58.8765, 60.3125};
  for (std::size_t i = 0; i < published.size(); ++i) {
    const double nm = 785 + 5.0 * static_cast<double>(i);
    EXPECT_NEAR(d65->curve(nm), published[i], 1e-9) << nm;
  }
  for (const auto& [name, at_830] :
       {std::pair{"D50", 74.4417}, {"D55", 68.306}, {"D65", 60.3125}, {"D75", 55.539}}) {
    const auto light = load_illuminant(name, {}, diagnostics);
    ASSERT_TRUE(light) << diagnostics.text();
    EXPECT_EQ(light->high_nm, 830) << name;
    EXPECT_NEAR(light->curve(830), at_830, 5e-4) << name;
    EXPECT_EQ(light->curve(830.1), 0) << name;
  }
}

TEST(Library, black_bodies_and_daylight_by_temperature) {
  Diagnostics diagnostics;
  const auto black = load_illuminant("blackbody:3200", {}, diagnostics);
  const auto day = load_illuminant("daylight:6500", {}, diagnostics);
  ASSERT_TRUE(black && day) << diagnostics.text();
  EXPECT_EQ(black->curve(600), planck_radiance(3200, 600));
  EXPECT_NEAR(day->curve(560), 100, 1e-9);
}

TEST(Library, impossible_temperatures_are_reported) {
  for (const char* name :
       {"blackbody:0", "blackbody:-5", "blackbody:hot", "daylight:3000", "daylight:", "blackbody:nan"}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_illuminant(name, {}, diagnostics)) << name;
    EXPECT_NE(diagnostics.text().find("allowed ["), std::string::npos) << diagnostics.text();
  }
}

TEST(Library, a_table_of_several_curves_needs_a_column) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_curve("reflectance", "cornell_box_walls", {}, diagnostics));
  EXPECT_NE(diagnostics.text().find("white, green, red"), std::string::npos) << diagnostics.text();
  Diagnostics none;
  const auto white = load_curve("reflectance", "cornell_box_walls:white", {}, none);
  ASSERT_TRUE(white) << none.text();
  EXPECT_EQ(white->low_nm, 400);
  EXPECT_EQ(white->high_nm, 700);
  EXPECT_EQ(white->curve(400), 0.343);
  EXPECT_EQ(white->curve(350), 0.343);
}

TEST(Library, a_table_without_wavelengths_is_no_curve) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_curve("reflectance", "colorchecker24_2005_xyY:Y", {}, diagnostics));
  EXPECT_NE(diagnostics.text().find("wavelength_nm"), std::string::npos) << diagnostics.text();
}

TEST(Library, reads_a_users_file_in_either_unit) {
  const UserFile nm("# unit: reflectance\n# outside: clamp\nwavelength_nm,r\n400,0.25\n700,0.75\n");
  Diagnostics diagnostics;
  const auto by_nm = load_curve("reflectance", nm.name(), {}, diagnostics);
  ASSERT_TRUE(by_nm) << diagnostics.text();
  EXPECT_EQ(by_nm->curve(550), 0.5);
  std::ofstream(nm.name()) << "# unit: reflectance\n# outside: zero\nwavelength_um,r\n0.4,0.25\n0.7,0.75\n";
  const auto by_um = load_curve("reflectance", nm.name() + ":r", {}, diagnostics);
  ASSERT_TRUE(by_um) << diagnostics.text();
  EXPECT_NEAR(by_um->curve(550), 0.5, 1e-12);
  EXPECT_EQ(by_um->curve(750), 0);
}

TEST(Library, refuses_malformed_spectra) {
  expect_refused("# unit: 1\n# outside: clamp\nwavelength_nm,r\n400,0\n500,1\n450,1\n",
                 "got 450 nm after 500 nm");
  expect_refused("# unit: 1\n# outside: clamp\nwavelength_nm,r\n400,0\n400,1\n", "got 400 nm after 400 nm");
  expect_refused("# unit: 1\n# outside: clamp\nwavelength_nm,r\n400,0\n", "two samples (got 1)");
  expect_refused("# unit: 1\n# outside: clamp\nwavelength_nm,r\n0.4,0\n0.7,1\n", "is the unit right?");
  expect_refused("# unit: 1\n# outside: clamp\nwavelength_um,r\n400,0\n700,1\n", "is the unit right?");
  expect_refused("# unit: 1\n# outside: clamp\nlambda,r\n400,0\n700,1\n", "no column \"wavelength_nm\"");
}

TEST(Library, a_table_that_holds_nothing_outside_must_cover_what_is_needed) {
  expect_refused("# unit: 1\nwavelength_nm,r\n400,0\n700,1\n",
                 "covers 400 to 700 nm, but 380 to 780 nm are needed (add a line \"# outside: clamp\" or \"# "
                 "outside: zero\" to extrapolate)");
  const UserFile file("# unit: 1\nwavelength_nm,r\n400,0\n700,1\n");
  Diagnostics diagnostics;
  EXPECT_TRUE(load_curve("reflectance", file.name(), {}, diagnostics, {400, 700})) << diagnostics.text();
}

const std::string kEvenRows = "400,0\n410,0\n420,0\n430,1\n440,1\n450,1\n";
std::string table_of(const std::string& keys, const std::string& rows) {
  return "# unit: 1\n# outside: clamp\n" + keys + "wavelength_nm,r\n" + rows;
}

Curve curve_of_text(const std::string& text) {
  const UserFile file(text);
  Diagnostics diagnostics;
  const auto curve = load_curve("reflectance", file.name(), {}, diagnostics);
  EXPECT_TRUE(curve) << diagnostics.text();
  return curve ? curve->curve : Curve();
}

TEST(Library, a_table_says_how_it_is_read_between_its_samples) {
  const Curve plain = curve_of_text(table_of("", kEvenRows));
  const Curve linear = curve_of_text(table_of("# interpolation: linear\n", kEvenRows));
  const Curve smooth = curve_of_text(table_of("# interpolation: sprague\n", kEvenRows));
  const Curve cubic = curve_of_text(table_of("# interpolation: cubic\n", kEvenRows));
  for (const double nm : {400.0, 420.0, 430.0, 450.0, 380.0, 780.0}) {
    EXPECT_EQ(smooth(nm), plain(nm)) << nm;
    EXPECT_EQ(cubic(nm), plain(nm)) << nm;
  }
  EXPECT_EQ(linear(424), plain(424));
  EXPECT_EQ(smooth(424), sprague(std::vector<double>{0, 0, 0, 1, 1, 1}, 2.4));
  EXPECT_NEAR(cubic(424), 0.4 * 1.4 * 1.6 / 2 - 1.4 * 0.4 * 0.6 / 6, 1e-12);
  EXPECT_NEAR(smooth(424.5), (smooth(424) + smooth(425)) / 2, 1e-12) << "straight between whole nanometres";
}

TEST(Library, overshoot_is_cut_to_the_declared_range) {
  const std::string dip = "400,0.2\n410,0.2\n420,0.2\n430,1\n440,1\n450,1\n";
  const auto ends = [](const Curve& curve) { return std::pair{curve.min(), curve.max()}; };
  for (const char* rule : {"sprague", "cubic"}) {
    const std::string key = std::string("# interpolation: ") + rule + "\n";
    EXPECT_GT(curve_of_text(table_of(key, dip)).max(), 1.02) << rule;
    EXPECT_LT(curve_of_text(table_of(key, dip)).min(), 0.18) << rule;
    EXPECT_EQ(ends(curve_of_text(table_of(key + "# value_range: 0.2, 1\n", dip))), (std::pair{0.2, 1.0}))
        << rule;
    EXPECT_EQ(curve_of_text(table_of(key, kEvenRows)).min(), 0) << "no sample is negative";
    EXPECT_LT(curve_of_text(table_of(key, kEvenRows + "460,-1\n470,-1\n")).min(), -1) << "but here one is";
  }
}

TEST(Library, refuses_what_a_rule_of_interpolation_cannot_take) {
  const std::string sprague = "# interpolation: sprague\n";
  expect_refused(
      table_of(sprague, kEvenRows + "470,1\n"),
      ".csv:11:1: error: \"interpolation: sprague\" needs six samples or more in even steps (got a step "
      "of 20 nm after one of 10 nm); declare \"cubic\" or \"linear\"");
  expect_refused(table_of(sprague, "400,0\n410,1\n"), "(got 2 samples (allowed 6 or more))");
  expect_refused(table_of("# interpolation: cubic\n", "400,0\n410,1\n"),
                 "(got 2 samples (allowed 4 or more))");
  expect_refused(table_of("# interpolation: spraque\n", kEvenRows),
                 ".csv:3:1: error: unknown interpolation \"spraque\"; did you mean \"sprague\"?");
  expect_refused(table_of("# Interpolation: sprague\n", kEvenRows),
                 ".csv:3:1: error: unknown key \"Interpolation\"; did you mean \"interpolation\"?");
  expect_refused(table_of(sprague, "400,0\n410,0\n410,0\n430,1\n"), "wavelengths must ascend");
  expect_refused(table_of("# value_range: 0, 0.5\n", kEvenRows),
                 ".csv:8:1: error: value outside the declared range (got 1, allowed [0, 0.5])");
  for (const char* range : {"0", "1, 0", "0, x", "0, 1, 2"})
    expect_refused(table_of(std::string("# value_range: ") + range + "\n", kEvenRows),
                   ".csv:3:1: error: malformed range (got \"" + std::string(range));
}

// Both tables of CIE 224 have columns of these names; without a table, they select the finer one.
TEST(Library, samples_of_cie_224_have_their_names_alone) {
  Diagnostics diagnostics;
  const auto alone = load_curve("reflectance", "CES42", {}, diagnostics);
  const auto fine = load_curve("reflectance", "cie224_ces01-99_1nm:CES42", {}, diagnostics);
  const auto coarse = load_curve("reflectance", "cie224_ces01-99_5nm:CES42", {}, diagnostics);
  ASSERT_TRUE(alone && fine && coarse) << diagnostics.text();
  EXPECT_EQ(alone->curve(482), fine->curve(482));
  EXPECT_NE(alone->curve(482), coarse->curve(482));
}

}  // namespace
}  // namespace abbe
