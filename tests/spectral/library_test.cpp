#include "spectral/library.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "spectral/sources.h"

namespace abbe {
namespace {

/// A user's file that vanishes with the test.
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
  // A Planckian radiator of 1.435e7/2848 nm, in the temperature scale of the exact constants 2855.5 K.
  const double kelvin = 2848 * photon_energy(1) / kBoltzmann / 1.435e7;
  for (const int nm : {781, 900, 1100}) {
    EXPECT_NEAR(a->curve(nm) / 100, planck_radiance(kelvin, nm) / planck_radiance(kelvin, 560), 1e-9);
  }
  EXPECT_NEAR(a->curve(300), 0.930483, 1e-9);
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
  expect_refused("# unit: 1\nwavelength_nm,r\n400,0\n700,1\n", "covers 400 to 700 nm");
  const UserFile file("# unit: 1\nwavelength_nm,r\n400,0\n700,1\n");
  Diagnostics diagnostics;
  EXPECT_TRUE(load_curve("reflectance", file.name(), {}, diagnostics, {400, 700})) << diagnostics.text();
}

}  // namespace
}  // namespace abbe
