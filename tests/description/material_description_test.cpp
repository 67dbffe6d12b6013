#include <limits>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"

namespace abbe {
namespace {

using test::DescriptionTest;
using test::Loaded;
using test::shaped;
using test::write;

TEST_F(DescriptionTest, ReadsMaterials) {
  const Loaded loaded = load(R"({"materials": {
    "tinted": {"dielectric": {"ior": 1.5, "absorption_per_m": {"table": {"wavelength_nm": [400, 700], "values": [100, 400], "outside": "clamp"}}}},
    "glass": {"dielectric": {"ior": "N-BK7"}}, "absorbing": {"dielectric": {"ior": {"n": 1.4, "k": 1e-6}}},
    "silver": {"conductor": {"ior": "Ag_Johnson"}}}})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  const auto& tinted = std::get<DielectricMaterial>(loaded->materials[0].model).index;
  EXPECT_NEAR(tinted.absorption_per_m(500), 200, 1e-3);
  EXPECT_NEAR(tinted.absorption_per_m(900), 400, 1e-3);
  EXPECT_EQ(tinted.n(500), 1.5);
  EXPECT_FALSE(tinted.dispersive());
  EXPECT_TRUE(tinted.absorbing());
  EXPECT_NEAR(std::get<DielectricMaterial>(loaded->materials[1].model).index.n(587.5618), 1.516800, 1e-6);
  EXPECT_NEAR(std::get<DielectricMaterial>(loaded->materials[2].model).index.k(500), 1e-6, 1e-12);
  EXPECT_GT(std::get<ConductorMaterial>(loaded->materials[3].model).index.k(500), 2);
}

TEST_F(DescriptionTest, AbsorptionGoesWithAnyIndexThatHasNone) {
  const std::string dispersive = R"({"wavelength_nm": [400, 700], "n": [1.53, 1.51]})";
  for (const std::string& ior :
       {std::string("1.5"), dispersive, std::string(R"("fused_silica")"), std::string(R"("water_20.0C")")}) {
    SCOPED_TRACE(ior);
    const auto index = [&](const std::string& beside) {
      const Loaded loaded =
          load(fmt::format(R"({{"materials": {{"m": {{"dielectric": {{"ior": {}{}}}}}}}}})", ior, beside));
      EXPECT_TRUE(loaded.scene) << loaded.text();
      return loaded.scene ? std::get<DielectricMaterial>(loaded->materials[0].model).index
                          : RefractiveIndex(1.0);
    };
    const RefractiveIndex clear = index("");
    const RefractiveIndex tinted = index(
        R"(, "absorption_per_m": {"table": {"wavelength_nm": [400, 700], "values": [100, 400], "outside": "clamp"}})");
    EXPECT_FALSE(clear.absorbing());
    EXPECT_NEAR(tinted.absorption_per_m(350), 100, 1e-3);
    EXPECT_NEAR(tinted.absorption_per_m(500), 200, 1e-3);
    EXPECT_NEAR(tinted.absorption_per_m(SampledSpectrum(500))[0], 200, 1e-3);
    EXPECT_EQ(tinted.dispersive(), clear.dispersive());
    for (const double nm : {350.0, 500.0, 900.0}) EXPECT_EQ(tinted.n(nm), clear.n(nm));
    EXPECT_EQ(tinted.low_nm(), clear.low_nm());
    EXPECT_EQ(tinted.high_nm(), clear.high_nm());
  }
  expect_refused(
      {{"a table's own",
        R"({"materials": {"m": {"dielectric": {"ior": {"wavelength_nm": [400, 700], "n": [1.5, 1.5], "k": [0, 1e-6]}, "absorption_per_m": 1}}}})",
        ErrorCode::scene, "absorption_per_m requires an index without k; this index already has one"}});
}

TEST_F(DescriptionTest, ReadsTablesOfIndices) {
  const Loaded loaded = load(R"({"materials": {
    "melt": {"dielectric": {"ior": {"wavelength_nm": [400, 600], "n": [1.6, 1.5]}}},
    "metal": {"conductor": {"ior": {"wavelength_nm": [400, 600], "n": [0.5, 1], "k": [2, 3]}}}}})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  const auto& melt = std::get<DielectricMaterial>(loaded->materials[0].model).index;
  EXPECT_NEAR(melt.n(450), 1.575, 1e-12);
  EXPECT_EQ(melt.n(700), 1.5);
  EXPECT_TRUE(melt.dispersive());
  EXPECT_FALSE(melt.absorbing());
  const auto& metal = std::get<ConductorMaterial>(loaded->materials[1].model).index;
  EXPECT_NEAR(metal.n(500), 0.75, 1e-12);
  EXPECT_NEAR(metal.k(500), 2.5, 1e-12);
  const auto melted = [](const std::string& table) {
    return fmt::format(R"({{"materials": {{"m": {{"dielectric": {{"ior": {{"wavelength_nm": {}}}}}}}}}}})",
                       table);
  };
  expect_refused(
      {{"turned round", melted(R"([600, 400], "n": [1, 1])"), ErrorCode::scene, "wavelengths must ascend"},
       {"too few", melted(R"([400, 600], "n": [1])"), ErrorCode::scene, "as many values as wavelengths"},
       {"nothing", melted(R"([400, 600], "n": [0, 1])"), ErrorCode::scene, "allowed (0, 100]"}});
}

TEST_F(DescriptionTest, ReadsRoughness) {
  const Loaded loaded = load(R"({"materials": {
    "ground": {"dielectric": {"ior": 1.5, "roughness": 0.3}},
    "brushed": {"conductor": {"ior": "Ag_Johnson", "roughness": {"alpha": [0.1, 0.4], "distribution": "beckmann"}}},
    "pair": {"conductor": {"ior": "Ag_Johnson", "roughness": [0, 0.01]}},
    "polished": {"dielectric": {"ior": 1.5, "roughness": 0.00099, "coating": [{"ior": 1.38, "thickness_nm": 100}]}},
    "mirror": {"conductor": {"ior": "Ag_Johnson", "roughness": {"alpha": 0}}}}})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  const auto facets = [&](std::size_t i) {
    const MaterialModel& model = loaded->materials[i].model;
    const auto* glass = std::get_if<RoughDielectricMaterial>(&model);
    return glass ? glass->surface->facets : std::get<RoughConductorMaterial>(model).surface->facets;
  };
  EXPECT_EQ(facets(0).shape, FacetShape::ggx);
  EXPECT_EQ(facets(0).alpha_x, 0.3F);
  EXPECT_EQ(facets(0).alpha_y, 0.3F);
  EXPECT_EQ(facets(1).shape, FacetShape::beckmann);
  EXPECT_EQ(facets(1).alpha_x, 0.1F);
  EXPECT_EQ(facets(1).alpha_y, 0.4F);
  EXPECT_EQ(facets(2).alpha_x, 1e-3F);
  EXPECT_TRUE(std::holds_alternative<DielectricMaterial>(loaded->materials[3].model));
  EXPECT_TRUE(std::holds_alternative<ConductorMaterial>(loaded->materials[4].model));
}

TEST_F(DescriptionTest, ReadsScatteringModels) {
  const Loaded loaded = load(R"({"units": "mm", "materials": {
    "mixed": {"mixture": [{"material": "clay", "weight": 0.3}, {"material": "pane", "weight": {"band": [400, 500], "value": 0.7}}]},
    "clay": {"oren_nayar": {"reflectance": 0.6, "sigma_deg": 20}},
    "pane": {"thin_glass": {"ior": 1.52, "thickness": 4, "absorption_per_m": 10}},
    "glaze": {"coated_diffuse": {"ior": "N-BK7", "reflectance": 0.6}},
    "gold": {"schlick": {"ior": {"n": 0.2, "k": 3}}},
    "art": {"principled": {"base_color": 0.25, "metallic": 1, "roughness": 0.3}},
    "one way": {"cosine_power": {"reflectance": 1, "exponent": 2}},
    "both ways": {"cosine_power": {"reflectance": 1, "exponent": 2, "reciprocal": true}}}})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  const auto model = [&](std::size_t i) -> const MaterialModel& { return loaded->materials.at(i).model; };
  const auto& mixture = std::get<MixtureMaterial>(model(0));
  ASSERT_EQ(mixture.components.size(), 2U);
  EXPECT_EQ(mixture.components[0].material->name, "clay");
  EXPECT_EQ(mixture.components[1].weight(450), 0.7);
  EXPECT_TRUE(mixture.lobes().delta && mixture.lobes().spread);
  EXPECT_EQ(std::get<OrenNayarMaterial>(model(1)).sigma_deg, 20);
  const auto& pane = std::get<ThinGlassMaterial>(model(2));
  EXPECT_NEAR(pane.thickness * pane.index.absorption_per_m(550), 0.04, 1e-6);
  EXPECT_NEAR(std::get<CoatedDiffuseMaterial>(model(3)).index.n(587.5618), 1.516800, 1e-6);
  EXPECT_NEAR(std::get<SchlickMaterial>(model(4)).reflectance.curve()(550), (0.8 * 0.8 + 9) / (1.2 * 1.2 + 9),
              1e-9);
  EXPECT_NEAR(std::get<PrincipledMaterial>(model(5)).principled.albedo(1).coloured, 0.984, 0.003);
  EXPECT_FALSE(std::get<CosinePowerMaterial>(model(6)).reciprocal);
  EXPECT_TRUE(std::get<CosinePowerMaterial>(model(7)).reciprocal);
}

TEST_F(DescriptionTest, ReadsThinElements) {
  const Loaded loaded = load(R"({"units": "mm", "materials": {
    "ideal": {"polariser": {}},
    "sheet": {"polariser": {"transmittance": 0.8, "extinction_ratio": {"table": {"wavelength_nm": [400, 700], "values": [100, 400], "outside": "clamp"}}, "angle_deg": 30}},
    "quarter": {"wave_plate": {"retardance_deg": 90, "angle_deg": -45}},
    "quartz": {"wave_plate": {"birefringence": 0.0091, "thickness": 0.1, "transmittance": 0.9}},
    "wedge": {"depolariser": {"transmittance": 0.5}}}})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  const auto model = [&](std::size_t i) -> const MaterialModel& { return loaded->materials.at(i).model; };
  EXPECT_EQ(std::get<PolariserMaterial>(model(0)).mean_transmittance(550), 0.5);
  const auto& sheet = std::get<PolariserMaterial>(model(1));
  EXPECT_NEAR(sheet.blocked(550), 1 / 250.0, 1e-6);
  EXPECT_NEAR(sheet.mean_transmittance(550), 0.4 * (1 + 1 / 250.0), 1e-6);
  EXPECT_NEAR(sheet.angle, 0.5235987756, 1e-9);
  EXPECT_TRUE(needs_coordinates(loaded->materials[1]));
  const auto& quarter = std::get<WavePlateMaterial>(model(2));
  EXPECT_NEAR(quarter.retardance(400), 1.5707963268, 1e-9);
  EXPECT_NEAR(quarter.angle, -0.7853981634, 1e-9);
  EXPECT_NEAR(std::get<WavePlateMaterial>(model(3)).retardance(550), 6.283185307 * 0.0091 * 1e-4 / 550e-9,
              1e-6);
  EXPECT_EQ(std::get<DepolariserMaterial>(model(4)).transmittance(550), 0.5);
}

TEST_F(DescriptionTest, PanesAbsorbByTheirThickness) {
  const auto text = [&](const char* more) {
    return load(fmt::format(R"({{"materials": {{"pane": {{"thin_glass": {{"ior": 1.5{}}}}}}}}})", more))
        .text();
  };
  const std::string told =
      "/materials/pane/thin_glass/absorption_per_m: warning: absorption has no effect in a pane of thickness "
      "0";
  for (const char* none : {R"(, "absorption_per_m": 10)", R"(, "absorption_per_m": 10, "thickness": 0)"})
    EXPECT_NE(text(none).find(told), std::string::npos) << text(none);
  for (const char* sound : {"", R"(, "absorption_per_m": 10, "thickness": 0.01)", R"(, "thickness": 0.01)"})
    EXPECT_EQ(text(sound).find("effect"), std::string::npos) << text(sound);
  const auto of_index = [&](const char* ior) {
    return load(fmt::format(R"({{"materials": {{"pane": {{"thin_glass": {{"ior": {}}}}}}}}})", ior)).text();
  };
  for (const char* absorbing :
       {R"({"n": 1.5, "k": 1e-6})", R"({"wavelength_nm": [400, 700], "n": [1.5, 1.5], "k": [0, 1e-6]})"})
    EXPECT_NE(of_index(absorbing).find("/materials/pane/thin_glass/ior: warning: absorption has no effect"),
              std::string::npos)
        << of_index(absorbing);
  for (const char* clear : {R"({"n": 1.5, "k": 0})", R"("N-BK7")",
                            R"({"wavelength_nm": [400, 700], "n": [1.5, 1.5], "k": [0, 0]})"})
    EXPECT_EQ(of_index(clear).find("effect"), std::string::npos) << of_index(clear);
}

TEST_F(DescriptionTest, WhatIsTakenAsClearIsClear) {
  for (const char* model : {"dielectric", "thin_glass"}) {
    const Loaded gold =
        load(fmt::format(R"({{"materials": {{"m": {{"{}": {{"ior": {{"n": 0.2, "k": 3}}}}}}}}}})", model));
    EXPECT_FALSE(gold.scene);
    EXPECT_NE(gold.text().find("\"m\" is not clear: with n = 0.2 and k = 3 at 300 nm it reflects"),
              std::string::npos)
        << gold.text();
  }
}

TEST_F(DescriptionTest, FilmsTakeNoPriority) {
  const Loaded film =
      load(R"({"materials": {"m": {"film": {"layers": [{"ior": 1.3, "thickness_nm": 9}]}, "priority": 1}}})");
  EXPECT_NE(film.text().find("priority applies only to a medium inside a shape"), std::string::npos)
      << film.text();
}

TEST_F(DescriptionTest, ReadsCoatings) {
  const Loaded loaded = load(R"({"materials": {
    "lens": {"dielectric": {"ior": "N-BK7", "coating": [{"ior": "MgF2", "thickness_nm": 99.6}]}, "priority": -3},
    "stack": {"conductor": {"ior": "Al_Rakic", "coating": [{"ior": 1.5, "thickness_nm": 10},
       {"repeat": 3, "layers": [{"ior": 2.3, "thickness_nm": 20}, {"ior": {"n": 1.5, "k": 0.1}, "thickness_nm": 30}]},
       {"ior": 2.3, "thickness_nm": 40}]}},
    "bubble": {"film": {"layers": [{"ior": "water", "thickness_nm": 400}]}}}})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  const Coating& coat = std::get<DielectricMaterial>(loaded->materials[0].model).coating;
  ASSERT_EQ(coat.layers.size(), 1U);
  EXPECT_EQ(coat.layers[0].thickness_nm, 99.6);
  EXPECT_NEAR(coat.materials[0].index.n(587.5618), 1.3777439, 1e-6);
  const Coating& stack = std::get<ConductorMaterial>(loaded->materials[1].model).coating;
  ASSERT_EQ(stack.materials.size(), 3U) << "one for each of 1.5, 2.3 and 1.5 + 0.1i";
  std::vector<double> thicknesses;
  for (const Coating::Layer& layer : stack.layers) thicknesses.push_back(layer.thickness_nm);
  EXPECT_EQ(thicknesses, (std::vector<double>{10, 20, 30, 20, 30, 20, 30, 40}));
  EXPECT_EQ(stack.materials[stack.layers[2].material].index.k(500), 0.1);
  EXPECT_EQ(stack.materials[stack.layers[7].material].index.n(500.0), 2.3);
  EXPECT_EQ(loaded->materials[0].priority, -3);
  EXPECT_EQ(loaded->materials[2].priority, 0);
  EXPECT_EQ(std::get<FilmMaterial>(loaded->materials[2].model).layers.layers.size(), 1U);
  EXPECT_FALSE(encloses_medium(loaded->materials[2])) << "the same matter is on both sides";
  const std::string narrow = load(R"({"materials": {"m": {"dielectric": {"ior": 1.5, "coating":
      [{"ior": "diamond", "thickness_nm": 9}]}}}})")
                                 .text();
  EXPECT_NE(narrow.find("diamond has data on [226, 760] nm"), std::string::npos) << narrow;
}

// Compares with the characteristic matrices of 100 nm of n = 1.38 over 60 nm of n = 2.3, at 550 nm and normal
// incidence.
TEST_F(DescriptionTest, FilmsOfDifferentTablesAreDifferentMaterials) {
  const std::string low = R"({"wavelength_nm": [300, 1100], "n": [1.38, 1.38]})";
  const std::string high = R"({"wavelength_nm": [300, 1100], "n": [2.3, 2.3]})";
  const auto layers = [](const std::string& outer, const std::string& inner) {
    return fmt::format(R"([{{"ior": {}, "thickness_nm": 100}}, {{"ior": {}, "thickness_nm": 60}}])", outer,
                       inner);
  };
  const auto coating = [&](const std::string& said) {
    const Loaded loaded =
        load(fmt::format(R"({{"materials": {{"m": {{"dielectric": {{"ior": 1.52, "coating": {0}}}}},
          "bubble": {{"film": {{"layers": {0}}}}}}}}})",
                         said));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    if (!loaded.scene) return std::pair<Coating, Coating>();
    return std::pair(std::get<DielectricMaterial>(loaded->materials[0].model).coating,
                     std::get<FilmMaterial>(loaded->materials[1].model).layers);
  };
  const std::vector<std::pair<std::string, std::string>> same{{low, high}, {"1.38", "2.3"}, {low, "2.3"}};
  for (const auto& [outer, inner] : same) {
    const auto [on_glass, bubble] = coating(layers(outer, inner));
    ASSERT_EQ(on_glass.materials.size(), 2U) << outer << inner;
    EXPECT_NEAR(coated_power(on_glass, 550, 1.52, 0, 1, false).R(), 0.08566344, 1e-7) << outer << inner;
    EXPECT_NEAR(coated_power(bubble, 550, 1, 0, 1, false).R(), 0.22147345, 1e-7) << outer << inner;
  }
  const std::string words = "\"MgF2\"";
  for (const std::string& one : {low, words, std::string("1.38")})
    EXPECT_EQ(coating(layers(one, one)).first.materials.size(), 1U) << one;
}

TEST_F(DescriptionTest, WarnsOfAnExtinctionThatEndsBeforeItsIndex) {
  const auto told = [&](const char* ior, const char* band) {
    return load(fmt::format(R"({{"materials": {{"m": {{"dielectric": {{"ior": "{}"}}}}}},
      "lights": [{{"environment": {{}}, "emission": {{"spectrum": 1}}}}],
      "sensor": {{"resolution": [1, 1], "channels": {{"a": {{"band": {}}}}}}}}})",
                            ior, band))
        .text();
  };
  EXPECT_NE(told("N-LASF31A", "[300, 330]")
                .find("N-LASF31A has data on [250, 2500] nm, its k on [334, 2500] nm, but the sensor "
                      "responds on [300, 330] nm"),
            std::string::npos);
  EXPECT_EQ(told("N-LASF31A", "[400, 700]"), "");
  EXPECT_NE(told("BAF10_hoya", "[600, 710]").find("its k on [340, 700] nm"), std::string::npos);
  EXPECT_EQ(told("N-SF11", "[350, 500]").find("its k"), std::string::npos) << "which begins where n does";
  EXPECT_EQ(told("water", "[400, 700]"), "") << "of which no k is known";
}

TEST_F(DescriptionTest, RefusesImpossibleCoatings) {
  const auto told = [&](const std::string& layers) {
    const Loaded loaded =
        load(R"({"materials": {"m": {"dielectric": {"ior": 1.5, "coating": )" + layers + "}}}}");
    EXPECT_FALSE(loaded.scene) << layers;
    return loaded.text();
  };
  const auto holds = [](const std::string& text, const std::string& words) {
    EXPECT_NE(text.find(words), std::string::npos) << text;
  };
  holds(told("[]"), "/materials/m/dielectric/coating: error: expected an array of layers");
  holds(told(R"([{"ior": 1.4, "thickness_nm": 0}])"), "/coating/0/thickness_nm: error");
  holds(told(R"([{"ior": 1.4}])"), "thickness_nm");
  holds(told(R"([{"ior": "MgF3", "thickness_nm": 9}])"), "MgF2");
  holds(told(R"([{"repeat": 86, "layers": [{"ior": 1.4, "thickness_nm": 9}, {"ior": 1.5, "thickness_nm": 9},
      {"ior": 1.6, "thickness_nm": 9}]}])"),
        "too many layers (allowed 256)");
  std::string many;
  for (int i = 0; i < 17; ++i)
    many += fmt::format("{}{{\"ior\": 1.{:02}, \"thickness_nm\": 9}}", i ? ", " : "", i + 1);
  holds(told("[" + many + "]"), "too many materials in a coating (allowed 16)");
}

// A scene whose path is relative to the working directory, as on the command line.
TEST_F(DescriptionTest, FindsIndicesBesideTheScene) {
  write(folder_ / "own.csv", "# unit: index, nm\nwavelength_nm,n\n300,1.6\n1100,1.6\n");
  write(folder_ / "own.yml",
        "DATA:\n  - type: formula 5\n    wavelength_range: 0.3 1.1\n    coefficients: 1.7 0 1\n");
  write(folder_ / "scene.json", test::completed(R"({"materials": {"table": {"dielectric": {"ior": "own.csv"}},
    "entry": {"dielectric": {"ior": "own.yml"}}}})"));
  Diagnostics diagnostics;
  const auto scene = load_scene(std::filesystem::relative(folder_ / "scene.json"), {}, diagnostics);
  ASSERT_TRUE(scene) << diagnostics.text();
  EXPECT_EQ(std::get<DielectricMaterial>(scene->materials[0].model).index.n(500.0), 1.6);
  EXPECT_EQ(std::get<DielectricMaterial>(scene->materials[1].model).index.n(500.0), 1.7);
  write(folder_ / "own.yml",
        "DATA:\n  - type: formula 5\n    wavelength_range: 0.3 1.1\n    coefficients: 1.8 0 1\n");
  Diagnostics again;
  EXPECT_NE(load_scene(folder_ / "scene.json", {}, again)->sha256, scene->sha256) << "part of the scene";
}

}  // namespace
}  // namespace abbe
