#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>
#include <utility>

#include "io/data_directory.h"
#include "io/table.h"
#include "spectral/library.h"

namespace abbe {
namespace {

std::vector<std::filesystem::path> shipped_tables() {
  std::vector<std::filesystem::path> paths;
  for (const char* folder : {"camera", "filter", "glass", "illuminant", "metal", "observer", "reflectance"}) {
    for (const auto& entry : std::filesystem::directory_iterator(data_directory() / folder)) {
      if (entry.path().extension() == ".csv") paths.push_back(entry.path());
    }
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

TEST(Data, every_table_carries_its_provenance) {
  const auto paths = shipped_tables();
  EXPECT_GE(paths.size(), 211U);
  for (const auto& path : paths) {
    Diagnostics diagnostics;
    const auto table = read_table(path, TableOrigin::shipped, diagnostics);
    ASSERT_TRUE(table && !diagnostics.has_errors()) << path << "\n" << diagnostics.text();
    for (const char* key : {"title", "unit", "source", "status", "processing", "outside"}) {
      EXPECT_TRUE(table->keys.contains(key) && !table->keys.at(key).empty()) << path << " " << key;
    }
    EXPECT_GT(table->rows.size(), 0U) << path;
  }
}

TEST(Data, spectral_tables_ascend_and_are_finite) {
  for (const auto& path : shipped_tables()) {
    Diagnostics diagnostics;
    const auto table = read_table(path, TableOrigin::shipped, diagnostics);
    ASSERT_TRUE(table);
    if (!table->column("wavelength_nm")) continue;
    for (std::size_t column = 0; column < table->columns.size(); ++column) {
      const auto values = table->numbers(column, diagnostics);
      ASSERT_TRUE(values) << path << "\n" << diagnostics.text();
      EXPECT_TRUE(std::all_of(values->begin(), values->end(), [](double v) { return std::isfinite(v); }))
          << path;
    }
    const auto nm = *table->numbers(*table->column("wavelength_nm"), diagnostics);
    EXPECT_EQ(std::adjacent_find(nm.begin(), nm.end(), std::greater_equal<>{}), nm.end()) << path;
  }
}

TEST(Data, extinction_is_not_negative_and_index_is_positive) {
  for (const auto& path : shipped_tables()) {
    Diagnostics diagnostics;
    const auto table = read_table(path, TableOrigin::shipped, diagnostics);
    if (path.parent_path().filename() != "metal") continue;
    const auto n = *table->numbers(table->column("n").value(), diagnostics);
    const auto k = *table->numbers(table->column("k").value(), diagnostics);
    EXPECT_GT(*std::min_element(n.begin(), n.end()), 0) << path;
    EXPECT_GE(*std::min_element(k.begin(), k.end()), 0) << path;
  }
}

// Table 2 of Bessell (1990) has responses to energy; divided by the wavelength they are per photon.
TEST(Data, bessells_passbands_are_per_photon) {
  Diagnostics diagnostics;
  const auto b = load_curve("filter", "bessell_B", {}, diagnostics);
  const auto v = load_curve("filter", "bessell_V", {}, diagnostics);
  ASSERT_TRUE(b && v) << diagnostics.text();
  EXPECT_NEAR(b->curve.max(), 1, 1e-6);
  for (const auto& [nm, response] : {std::pair{400, 0.92}, {420, 1.0}, {480, 0.536}, {540, 0.043}})
    EXPECT_NEAR(b->curve(nm) * nm / (b->curve(420) * 420), response, 1e-5) << nm;
  for (const auto& [nm, response] : {std::pair{480, 0.03}, {530, 1.0}, {560, 0.792}, {640, 0.081}})
    EXPECT_NEAR(v->curve(nm) * nm / (v->curve(530) * 530), response, 1e-5) << nm;
}

TEST(Data, illuminant_names_are_unique) {
  const auto names = table_names("illuminant");
  const std::set<std::string> known(names.begin(), names.end());
  for (const char* name : {"A", "C", "D50", "D65", "E", "FL2", "F2", "FL3.15", "HP1", "LED-B3", "ID50",
                           "cornell_box_light", "iso7589_studio_tungsten"}) {
    EXPECT_TRUE(known.contains(name)) << name;
  }
}

}  // namespace
}  // namespace abbe
