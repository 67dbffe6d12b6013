#include "tests/description/description.h"

namespace abbe::test {
namespace {

class MediumDescription : public DescriptionTest {
 protected:
  // Loads a scene with a ball of this material, which is the first.
  Loaded ball_of(const std::string& material) {
    return load(fmt::format(R"({{"materials": {{"m": {}}},
      "shapes": [{{"sphere": {{"center": [0, 0, 0], "radius": 1}}, "material": "m"}}]}})",
                            material));
  }
  static std::string npy(const std::string& header, const std::string& values, char version = 1) {
    std::string text = header;
    text.resize(117, ' ');
    return std::string("\x93NUMPY") + version + '\0' + static_cast<char>(text.size() + 1) +
           std::string(version == 1 ? 1 : 3, '\0') + text + '\n' + values;
  }
  static std::string eight(float value) {
    std::string bytes;
    for (int i = 0; i < 8; ++i) bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
    return bytes;
  }
  // The error code and diagnostics of a grid with this file; empty without an error.
  std::string complaint(const std::string& file) {
    write(folder_ / "g.npy", file);
    const Loaded ball =
        ball_of(R"({"medium": {"grid": {"densities": "g.npy", "from": [0, 0, 0], "to": [1, 1, 1]}}})");
    return ball.scene ? "" : fmt::format("{}: {}", static_cast<int>(ball.diagnostics.code()), ball.text());
  }
};

const std::string kHeader = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2, 2), }";

TEST_F(MediumDescription, FillsDielectricsAndStandsAlone) {
  const Loaded fog = ball_of(
      R"({"medium": {"absorption_per_m": 0.1, "scattering_per_m": {"band": [500, 600]}, "phase": {"henyey_greenstein": -0.5}}})");
  ASSERT_TRUE(fog.scene) << fog.text();
  const Medium& medium = *abbe::medium(fog->materials[0]);
  EXPECT_EQ(medium.absorption_per_m(400.0), 0.1);
  EXPECT_EQ(medium.scattering_per_m(550.0), 1);
  EXPECT_FLOAT_EQ(std::get<HenyeyGreensteinPhase>(medium.phase).g, -0.5F);
  EXPECT_TRUE(is_boundary(fog->materials[0]));
  EXPECT_TRUE(fog->features.media && fog->features.scattering && fog->features.boundaries);
  EXPECT_EQ(fog->features.reasons.at("scattering"), fog->features.reasons.at("boundaries"));

  const Loaded milk = ball_of(
      R"({"dielectric": {"ior": 1.3, "absorption_per_m": 2, "scattering_per_m": 5, "phase": "rayleigh"}})");
  ASSERT_TRUE(milk.scene) << milk.text();
  EXPECT_EQ(abbe::medium(milk->materials[0])->scattering_per_m(550.0), 5);
  EXPECT_TRUE(std::holds_alternative<RayleighPhase>(abbe::medium(milk->materials[0])->phase));
  EXPECT_NEAR(interior_index(milk->materials[0])->absorption_per_m(550.0), 2, 1e-9);
  EXPECT_TRUE(milk->features.media && milk->features.scattering && !milk->features.boundaries);

  const Loaded clear = ball_of(R"({"dielectric": {"ior": 1.3}})");
  EXPECT_EQ(abbe::medium(clear->materials[0]), nullptr);
  EXPECT_FALSE(clear->features.scattering);
}

TEST_F(MediumDescription, GridsMoveWithTheScene) {
  write(folder_ / "g.npy", npy(kHeader, eight(3)));
  const Loaded smoke = load(R"({"units": "mm", "materials": {"m": {"medium": {"scattering_per_m": 1,
      "grid": {"densities": "g.npy", "from": [0, 0, 0], "to": [1000, 2000, 3000]}}}},
      "shapes": [{"sphere": {"center": [5000, 0, 0], "radius": 1}, "material": "m"}]})");
  ASSERT_TRUE(smoke.scene) << smoke.text();
  const PlacedGrid& grid = *abbe::medium(smoke->materials[0])->grid;
  EXPECT_EQ(grid.from, Imath::V3d(-5, 0, 0));
  EXPECT_EQ(grid.to, Imath::V3d(-4, 2, 3));
  EXPECT_EQ(grid.grid->size, (std::array{2, 2, 2}));
  EXPECT_EQ(grid.grid->density, std::vector<float>(8, 3));
}

TEST_F(MediumDescription, RefusesWhatMatterCannotBe) {
  const auto text = [&](const std::string& material) { return ball_of(material).text(); };
  EXPECT_NE(text(R"({"medium": {"absorption_per_m": -1}})").find("allowed"), std::string::npos);
  EXPECT_NE(text(R"({"medium": {"scattering_per_m": {"band": [500, 600], "value": -1}}})").find("allowed"),
            std::string::npos);
  EXPECT_NE(text(R"({"medium": {"phase": {"henyey_greenstein": 1}}})").find("[-0.9999, 0.9999]"),
            std::string::npos);
  EXPECT_NE(text(R"({"medium": {"phase": "raleigh"}})").find("rayleigh"), std::string::npos);
  EXPECT_NE(text(R"({"dielectric": {"ior": 1.5, "scattering_per_m": -1}})").find("allowed"),
            std::string::npos);
  EXPECT_NE(load(R"({"materials": {"m": {"medium": {}}}, "shapes": [{"sphere": {"center": [0, 0, 0],
      "radius": 1}, "material": "m", "emission": {"spectrum": 1}}]})")
                .text()
                .find("a medium has no surface that could emit"),
            std::string::npos);
}

TEST_F(MediumDescription, TellsWhatHasNoEffectWithoutCoefficients) {
  const auto text = [&](const std::string& material) { return ball_of(material).text(); };
  const std::string phase = "/phase: warning: phase has no effect without scattering_per_m";
  for (const char* material : {R"({"dielectric": {"ior": 1.3, "phase": "rayleigh"}})",
                               R"({"medium": {"absorption_per_m": 1, "phase": "isotropic"}})"})
    EXPECT_NE(text(material).find(phase), std::string::npos) << text(material);
  EXPECT_EQ(
      text(R"({"dielectric": {"ior": 1.3, "scattering_per_m": 0, "phase": "rayleigh"}})").find("effect"),
      std::string::npos);
  write(folder_ / "g.npy", npy(kHeader, eight(3)));
  const auto grid = [&](const std::string& beside) {
    return text(fmt::format(
        R"({{"medium": {{{}"grid": {{"densities": "g.npy", "from": [0, 0, 0], "to": [1, 1, 1]}}}}}})",
        beside));
  };
  EXPECT_NE(grid("").find("/medium/grid: warning: grid has no effect: its densities multiply "
                          "absorption_per_m and scattering_per_m"),
            std::string::npos)
      << grid("");
  EXPECT_EQ(grid(R"("absorption_per_m": 1, )").find("effect"), std::string::npos);
  EXPECT_EQ(grid(R"("scattering_per_m": 1, )").find("effect"), std::string::npos);
}

TEST_F(MediumDescription, RefusesDamagedGrids) {
  EXPECT_EQ(complaint(npy(kHeader, eight(3))).find("error"), std::string::npos);
  EXPECT_EQ(complaint(npy(kHeader, eight(3), 2)).find("error"), std::string::npos);
  const auto fails = [&](const std::string& file, const char* with) {
    EXPECT_NE(complaint(file).find(with), std::string::npos) << complaint(file);
  };
  fails("no", "4: ");
  fails(npy(kHeader, eight(3)).substr(0, 50), "damaged header");
  fails(npy(kHeader, eight(3)).substr(0, 140), "the file size does not fit its 8 values");
  fails(npy(kHeader, eight(3) + "x"), "the file size does not fit");
  fails(npy(kHeader, eight(3), 3), "unsupported format version (got 3, allowed 1 or 2)");
  fails(npy(kHeader, eight(-1)), "has a density that is not in [0, 1e9]");
  fails(npy(kHeader, eight(NAN)), "has a density that is not in");
  fails(npy("{'descr': '<i4', 'fortran_order': False, 'shape': (2, 2, 2), }", eight(3)),
        "unsupported type of numbers (got '<i4', allowed '<f4' or '<f8')");
  fails(npy("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 2, 2), }", eight(3)), "Fortran");
  fails(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (8,), }", eight(3)), "has 1 axes");
  fails(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (8, 1, 1), }", eight(3)), "fewer than 2");
  fails(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 2", eight(3)), "damaged header");
  fails(npy("{'fortran_order': False, 'shape': (2, 2, 2), }", eight(3)), "has no descr");
  fails(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999, 99999999999, 2), }", eight(3)),
        "6: ");
  EXPECT_NE(ball_of(R"({"medium": {"grid": {"densities": "g.npy", "from": [0, 0, 0], "to": [1, 0, 1]}}})")
                .text()
                .find("`to` must be greater than its `from`"),
            std::string::npos);
}

}  // namespace
}  // namespace abbe::test
