#include <gtest/gtest.h>

#include <vector>

#include "materials/index/library.h"
#include "materials/interface/fresnel.h"
#include "spectral/colorimetry.h"
#include "spectral/library.h"
#include "tests/reference/reference_table.h"

namespace abbe {
namespace {

Curve normal_reflectance(const RefractiveIndex& index) {
  std::vector<Knot> knots;
  for (int nm = 380; nm <= 780; ++nm)
    knots.push_back({static_cast<double>(nm), fresnel_conductor(1.0, index.n(nm), index.k(nm)).R()});
  return Curve(std::move(knots));
}

TEST(Conductors, ColourAtNormalIncidenceIsTheKnownOne) {
  const test::ReferenceTable colours("metal_colour_normal_incidence");
  for (std::size_t row = 0; row < colours.rows(); ++row) {
    Diagnostics diagnostics;
    const auto metal = load_index(colours.text(row, "name"), {}, diagnostics);
    const auto light = load_illuminant(colours.text(row, "illuminant"), {}, diagnostics);
    ASSERT_TRUE(metal && light) << diagnostics.text();
    const XYZ xyz = tristimulus(light->curve, normal_reflectance(metal->index), Observer::cie1931);
    const Lab lab = xyz_to_lab(xyz, tristimulus(light->curve, Curve(1.0), Observer::cie1931));
    const char* const xyz_columns[] = {"X", "Y", "Z"};
    const char* const lab_columns[] = {"L", "a", "b"};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(xyz[i], colours.number(row, xyz_columns[i]), 1e-5) << metal->name;
      EXPECT_NEAR(lab[i], colours.number(row, lab_columns[i]), 2e-5) << metal->name;
    }
  }
}

}  // namespace
}  // namespace abbe
