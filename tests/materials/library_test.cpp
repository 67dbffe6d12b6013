#include "materials/index/library.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <fmt/format.h>

#include "tests/materials/index_of.h"

namespace abbe {
namespace {

// A user's table in a temporary folder.
class UserTable : public testing::Test {
 protected:
  UserTable() { std::filesystem::create_directories(folder_); }
  ~UserTable() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& text) {
    const std::string path = (folder_ / "glass.csv").string();
    std::ofstream(path) << text;
    return path;
  }

 private:
  std::filesystem::path folder_ = std::filesystem::path(testing::TempDir()) /
                                  testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST(IndexLibrary, LoadsEveryMaterialItLists) {
  const std::vector<std::string> names = index_names();
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
  EXPECT_GE(names.size(), 48U + 6U + 73U);
  for (const char* name : {"N-BK7", "rutile_o", "air_15C", "water_segelstein", "Cr_Johnson", "Al_Rakic"})
    EXPECT_TRUE(std::binary_search(names.begin(), names.end(), name)) << name;
  for (const char* name : {"dielectrics", "N-SF11_k", "n", "k", "c1", "formula"})
    EXPECT_FALSE(std::binary_search(names.begin(), names.end(), name)) << name;
  for (const std::string& name : names) {
    const RefractiveIndex index = index_of(name);
    EXPECT_GT(index.n(550.0), 0) << name;
    EXPECT_LT(index.low_nm(), index.high_nm()) << name;
  }
}

TEST(IndexLibrary, GivesTheIdentity) {
  Diagnostics diagnostics;
  const auto glass = load_index("N-SF11", {}, diagnostics);
  ASSERT_TRUE(glass);
  EXPECT_EQ(glass->name, "N-SF11");
  EXPECT_NE(glass->source.find("SCHOTT"), std::string::npos);
  EXPECT_DOUBLE_EQ(glass->index.low_nm(), 370);
  EXPECT_DOUBLE_EQ(glass->index.k(400), 6.504e-07);
  EXPECT_EQ(glass->index.medium(), IndexMedium::air);
  const auto metal = load_index("Al_Rakic", {}, diagnostics);
  ASSERT_TRUE(metal);
  EXPECT_NE(metal->source.find("Rakić"), std::string::npos);
  EXPECT_DOUBLE_EQ(metal->index.low_nm(), 206.64);
  EXPECT_EQ(load_index("water_20.0C", {}, diagnostics)->index.medium(), IndexMedium::vacuum);
}

TEST(IndexLibrary, KnowsWhereExtinctionsAreMeasured) {
  const auto lasf = index_of("N-LASF31A").k_range();
  ASSERT_TRUE(lasf);
  EXPECT_EQ(lasf->low_nm, 334);
  EXPECT_EQ(lasf->high_nm, 2500);
  const auto aluminium = index_of("Al_Rakic");
  ASSERT_TRUE(aluminium.k_range());
  EXPECT_EQ(aluminium.k_range()->low_nm, aluminium.low_nm());
  for (const char* clear : {"water", "fused_silica", "hoya/FCD1"})
    EXPECT_FALSE(index_of(clear).k_range()) << clear;
}

TEST(IndexLibrary, KnowsCustomaryNames) {
  Diagnostics diagnostics;
  EXPECT_EQ(load_index("BK7", {}, diagnostics)->name, "N-BK7");
  EXPECT_EQ(load_index("water", {}, diagnostics)->name, "water_20.0C");
}

TEST(IndexLibrary, SuggestsTheNearestName) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_index("N-SF12x", {}, diagnostics));
  ASSERT_EQ(diagnostics.all().size(), 1U);
  EXPECT_EQ(diagnostics.code(), ErrorCode::scene);
  EXPECT_NE(diagnostics.all()[0].message.find("unknown material \"N-SF12x\""), std::string::npos);
  EXPECT_NE(diagnostics.all()[0].message.find("N-SF1"), std::string::npos);
}

TEST_F(UserTable, MayHaveOnlyAnIndex) {
  const std::string path = write("# unit: index, nm\nwavelength_nm,n\n400,1.6\n700,1.5\n");
  Diagnostics diagnostics;
  const auto named = load_index(path, {}, diagnostics);
  ASSERT_TRUE(named) << diagnostics.text();
  EXPECT_EQ(named->name, "glass");
  EXPECT_NE(named->source.find("SHA-256"), std::string::npos);
  EXPECT_DOUBLE_EQ(named->index.n(550.0), 1.55);
  EXPECT_DOUBLE_EQ(named->index.n(350.0), 1.6);
  EXPECT_FALSE(named->index.absorbing());
  EXPECT_EQ(named->index.high_nm(), 700);
}

TEST_F(UserTable, MayAbsorbAndBeRelativeToVacuum) {
  const std::string path =
      write("# unit: index, nm\n# index_relative_to: vacuum\nwavelength_nm,n,k\n400,1.6,0\n700,1.5,0.3\n");
  Diagnostics diagnostics;
  const auto named = load_index(path, {}, diagnostics);
  ASSERT_TRUE(named) << diagnostics.text();
  EXPECT_DOUBLE_EQ(named->index.catalogued_k(550.0), 0.15);
  EXPECT_EQ(named->index.medium(), IndexMedium::vacuum);
}

TEST_F(UserTable, IsRefusedByWhatItMayHaveMeant) {
  const std::string rows = "wavelength_nm,n\n400,1.6\n700,1.5\n";
  const auto complaint = [&](const std::string& text) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_index(write("# unit: index, nm\n" + text), {}, diagnostics)) << text;
    return diagnostics.text();
  };
  for (const char* medium : {"Vacuum", "water"})
    EXPECT_NE(complaint(fmt::format("# index_relative_to: {}\n", medium) + rows)
                  .find(fmt::format("unknown index_relative_to \"{}\"", medium)),
              std::string::npos);
  EXPECT_NE(complaint("# Index_relative_to: vacuum\n" + rows).find("did you mean \"index_relative_to\"?"),
            std::string::npos);
  for (const char* column : {"K", "kappa"})
    EXPECT_NE(complaint(fmt::format("wavelength_nm,n,{}\n400,1.6,0.1\n700,1.5,0.1\n", column))
                  .find(fmt::format("column \"{}\" (the extinction column must be called k)", column)),
              std::string::npos);
}

TEST_F(UserTable, IsRefusedWithColumnsOrRangesThatNoIndexHas) {
  const auto complaint = [&](const std::string& text) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_index(write("# unit: index, nm\n" + text), {}, diagnostics)) << text;
    EXPECT_EQ(diagnostics.code(), ErrorCode::input);
    return diagnostics.text();
  };
  const std::string alpha = complaint("wavelength_nm,n,alpha\n400,1.6,100\n700,1.5,100\n");
  EXPECT_NE(
      alpha.find("unknown column of an index (got \"alpha\", allowed wavelength_nm, wavelength_um, n, k)"),
      std::string::npos)
      << alpha;
  const std::string zero = complaint("# outside: zero\nwavelength_nm,n\n400,1.6\n700,1.5\n");
  EXPECT_NE(zero.find("an index cannot be 0 outside the rows of its table (got \"# outside: zero\", allowed "
                      "clamp, error"),
            std::string::npos)
      << zero;
}

TEST_F(UserTable, IsRefusedWithoutAnIndexOrWithAnImpossibleOne) {
  for (const char* text :
       {"# unit: index, nm\nwavelength_nm,index\n400,1.6\n700,1.5\n",
        "# unit: index, nm\nwavelength_nm,n\n400,1.6\n700,0\n",
        "# unit: index, nm\nwavelength_nm,n,k\n400,1.6,0\n700,1.5,-0.1\n",
        "# unit: index, nm\nwavelength_nm,n\n700,1.6\n400,1.5\n", "wavelength_nm,n\n400,1.6\n700,1.5\n"}) {
    Diagnostics diagnostics;
    EXPECT_FALSE(load_index(write(text), {}, diagnostics)) << text;
    EXPECT_EQ(diagnostics.code(), ErrorCode::input) << text;
  }
}

TEST(IndexLibrary, ReportsAMissingFile) {
  Diagnostics diagnostics;
  EXPECT_FALSE(load_index("nowhere.csv", {}, diagnostics));
  EXPECT_EQ(diagnostics.code(), ErrorCode::input);
}

}  // namespace
}  // namespace abbe
