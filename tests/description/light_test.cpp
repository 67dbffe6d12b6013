#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"
#include "spectral/colorimetry.h"
#include "spectral/sources.h"
#include "tests/angles.h"

// Lights and their emission in scene files.

namespace abbe {
namespace {

using test::DescriptionTest;
using test::Loaded;

TEST_F(DescriptionTest, NormalisesEmission) {
  const std::string quad = R"("quad": {"corner": [0, 0, 0], "edge_u": [2, 0, 0], "edge_v": [0, 3, 0]})";
  const std::string point = R"("point": {"at": [0, 0, 0]})";
  const std::string spot = R"("spot": {"at": [0, 0, 0], "direction": [0, 0, 1], "half_angle_deg": 60})";
  EXPECT_NEAR(emission(quad, R"({"illuminant": "A", "radiant_flux_W": 5})").integral() * kPi * 6, 5, 1e-9);
  EXPECT_NEAR(
      emission(quad + R"(, "two_sided": true)", R"({"illuminant": "A", "radiant_flux_W": 5})").integral() *
          kPi * 12,
      5, 1e-9);
  EXPECT_NEAR(photometric(emission(quad, R"({"illuminant": "FL11", "luminous_flux_lm": 800})")) * kPi * 6,
              800, 1e-7);
  EXPECT_NEAR(emission(quad, R"({"daylight_K": 6504, "radiance": 7})").integral(), 7, 1e-9);
  EXPECT_NEAR(photometric(emission(quad, R"({"blackbody_K": 2856, "luminance": 900})")), 900, 1e-7);
  EXPECT_NEAR(photometric(emission(point, R"({"spectrum": 1, "luminous_flux_lm": 10})")) * 4 * kPi, 10, 1e-9);
  EXPECT_NEAR(emission(point, R"({"spectrum": 1, "intensity": 3})").integral(), 3, 1e-9);
  EXPECT_NEAR(emission(spot, R"({"spectrum": 1, "radiant_flux_W": 3})").integral() * kPi, 3, 1e-6)
      << "2 pi (1 - cos 60)";
  EXPECT_NEAR(photometric(emission(
                  spot, R"({"lines": [{"nm": 555, "width_nm": 1, "power": 4}], "luminous_intensity": 8})")),
              8, 1e-9);
  EXPECT_NEAR(emission(R"("environment": {})", R"({"illuminant": "D65", "radiance": 2})").integral(), 2,
              1e-9);
  EXPECT_NEAR(emission(quad, R"({"blackbody_K": 3000})")(500), planck_radiance(3000, 500),
              1e-9 * planck_radiance(3000, 500));
  EXPECT_NEAR(emission(point, R"({"lines": [{"nm": 500, "width_nm": 2, "power": 3}]})").integral(), 3, 1e-9);
}

TEST_F(DescriptionTest, FluxesAreInWattsPerNm) {
  const auto told = [&](const std::string& emission, const std::string& unit) {
    test::write(folder_ / "t.csv", "# unit: " + unit + "\n# outside: clamp\nwavelength_nm,a\n500,1\n600,1\n");
    return load(test::lit(emission)).text();
  };
  const std::string flux = R"({"spectral_flux_W_per_nm": "t.csv:a"})";
  for (const char* unit : {"mW/nm", "uW/nm", "lm/nm", "mW/(m2 nm)"})
    EXPECT_NE(told(flux, unit).find("(got \"" + std::string(unit) + "\", allowed W/nm"), std::string::npos)
        << told(flux, unit);
  EXPECT_EQ(told(flux, "W/nm"), "");
  EXPECT_EQ(told(R"({"spectral_flux_W_per_nm": "t.csv:a", "radiant_flux_W": 3})", "mW/nm"), "");
}

TEST_F(DescriptionTest, RelativeSpectraWithoutAScaleAreTold) {
  const auto told = [&](const std::string& emission) { return load(test::lit(emission)).text(); };
  const std::string taken = "warning: \"D65\" is used in ";
  EXPECT_NE(told(R"({"spectrum": "D65"})").find(taken + "W/(sr nm), but its unit is \"relative"),
            std::string::npos)
      << told(R"({"spectrum": "D65"})");
  EXPECT_NE(told(R"({"spectral_flux_W_per_nm": {"sum": ["D65", 0]}})").find(taken + "W/nm"),
            std::string::npos);
  test::write(folder_ / "t.csv", "# unit: transmittance\n# outside: clamp\nwavelength_nm,a\n500,1\n600,1\n");
  test::write(folder_ / "w.csv", "# unit: W/nm\n# outside: clamp\nwavelength_nm,a\n500,1\n600,1\n");
  for (const char* product : {R"(["D65", "t.csv:a"])", R"(["D65", 1])", R"([{"product": ["D65", 1]}, 1])"})
    EXPECT_NE(told(fmt::format(R"({{"spectrum": {{"product": {}}}}})", product)).find(taken),
              std::string::npos)
        << product;
  for (const char* sound :
       {R"({"spectrum": {"product": ["D65", "w.csv:a"]}})",
        R"({"spectrum": {"product": ["w.csv:a", "D65"]}})",
        R"({"spectrum": {"product": ["D65", {"product": ["t.csv:a", 0.01]}]}})",
        R"({"spectrum": {"product": ["D65", {"scale": 0.01, "of": "t.csv:a"}]}})",
        R"({"spectrum": "D65", "luminous_intensity": 1})", R"({"spectrum": {"scale": 0.01, "of": "D65"}})",
        R"({"spectrum": {"product": ["D65", {"band": [400, 700]}]}})"})
    EXPECT_EQ(told(sound).find("is taken to be"), std::string::npos) << sound;
}

TEST_F(DescriptionTest, LightsFromInfinityIrradiateASurfaceThatFacesThem) {
  const std::string beam = R"("directional": {"towards": [0, 3, 4]})";
  EXPECT_NEAR(photometric(emission(beam, R"({"illuminant": "A", "illuminance": 500})")), 500, 1e-9);
  EXPECT_NEAR(emission(beam, R"({"spectrum": 1, "irradiance": 5})").integral(), 5, 1e-9);
  const std::string sun = R"("sun": {"towards": [0, 3, 4], "angular_diameter_deg": 2})";
  const double seen = kPi * std::pow(std::sin(kPi / 180), 2);
  EXPECT_NEAR(photometric(emission(sun, R"({"illuminant": "A", "illuminance": 500})")) * seen, 500, 1e-5);
  EXPECT_NEAR(photometric(emission(sun, R"({"illuminant": "A", "luminance": 500})")), 500, 1e-9);
  EXPECT_NEAR(emission(sun, R"({"blackbody_K": 5772})")(500), planck_radiance(5772, 500),
              1e-9 * planck_radiance(5772, 500));
  // The short form without an emission uses D65.
  const Loaded brief = load(R"({"lights": [{"sun": {"towards": [0, 3, 4], "illuminance": 1e5}},
                                           {"directional": {"towards": [0, 3, 4], "irradiance": 7}}]})");
  ASSERT_TRUE(brief.scene) << brief.text();
  const Curve same =
      emission(R"("sun": {"towards": [0, 3, 4]})", R"({"illuminant": "D65", "illuminance": 1e5})");
  EXPECT_EQ(brief->lights[0].emission(560), same(560));
  EXPECT_NEAR(brief->lights[1].emission.curve().integral(), 7, 1e-9);
  const auto& disc = std::get<SunLight>(brief->lights[0].kind);
  EXPECT_NEAR((Imath::V3d(disc.towards) - Imath::V3d(0, 0.6, 0.8)).length(), 0, 1e-7);
  EXPECT_NEAR(disc.cap, 1 - std::cos(0.2665 * kPi / 180), 1e-11);
}

TEST_F(DescriptionTest, AFarQuadIrradiatesAsItsAreaDoes) {
  const double radiance =
      emission(R"("quad": {"corner": [0, 0, 0], "edge_u": [2, 0, 0], "edge_v": [1, 3, 0]})",
               R"({"spectrum": 1, "irradiance": 1, "distance": 1e11})")
          .integral();
  EXPECT_NEAR(radiance * 6 / 1e22, 1, 1e-12);
}

TEST_F(DescriptionTest, LampsLightASurfaceAtADistance) {
  const auto luminance = [this](const std::string& lamp, const char* distance) {
    return photometric(emission(
        lamp, fmt::format(R"({{"illuminant": "A", "illuminance": 500, "distance": {}}})", distance)));
  };
  EXPECT_NEAR(luminance(R"("point": {"at": [1, 0, 0]})", "2"), 500 * 4, 1e-9);
  EXPECT_NEAR(luminance(R"("spot": {"at": [0, 0, 0], "direction": [0, 0, 1], "half_angle_deg": 9})", "3"),
              500 * 9, 1e-9);
  EXPECT_NEAR(luminance(R"("sphere": {"center": [0, 0, 0], "radius": 0.5})", "2") * kPi / 16, 500, 1e-9);
  EXPECT_NEAR(luminance(R"("disc": {"center": [0, 0, 0], "normal": [1, 0, 0], "radius": 0.5})", "2") * kPi *
                  0.25 / 4.25,
              500, 1e-9);
  // Four times the configuration factor of a unit square one unit away, over its corner [Howell2010, B-4].
  const double corner = std::atan(std::sqrt(0.5)) * std::sqrt(0.5) / kPi;
  EXPECT_NEAR(luminance(R"("quad": {"corner": [-3, 0, 0], "edge_u": [0, 2, 0], "edge_v": [0, 0, 2]})", "1") *
                  4 * kPi * corner,
              500, 1e-9);
  // A skewed quad, compared with a sum over its area.
  double sum = 0;
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 400; ++j) {
      const double v = (j + 0.5) / 400 - 0.5;
      const double x = 2 * ((i + 0.5) / 400 - 0.5) + v;
      sum += 2.0 / (400 * 400) * 9 / std::pow(x * x + v * v + 9, 2);
    }
  EXPECT_NEAR(
      luminance(R"("quad": {"corner": [0, 0, 0], "edge_u": [2, 0, 0], "edge_v": [1, 1, 0]})", "3") * sum, 500,
      1e-2);
  EXPECT_NEAR(emission(R"("point": {"at": [0, 0, 0]})", R"({"spectrum": 1, "irradiance": 3, "distance": 2})")
                  .integral(),
              12, 1e-9);
  const Loaded millimetres = load(R"({"units": "mm", "lights": [{"point": {"at": [0, 0, 0]},
      "emission": {"spectrum": 1, "irradiance": 3, "distance": 2000}}]})");
  EXPECT_NEAR(millimetres->lights.at(0).emission.curve().integral(), 12, 1e-9);
}

TEST_F(DescriptionTest, LampsSendOutTheirSpectralFlux) {
  const std::string flux = R"({"spectral_flux_W_per_nm": {"band": [500, 600], "value": 0.02}})";
  EXPECT_NEAR(emission(R"("point": {"at": [0, 0, 0]})", flux)(550) * 4 * kPi, 0.02, 1e-12);
  const std::string disc = R"("disc": {"center": [0, 0, 0], "normal": [1, 0, 0], "radius": 2})";
  EXPECT_NEAR(emission(disc, flux)(550) * kPi * kPi * 4, 0.02, 1e-12);
  EXPECT_NEAR(emission(disc + R"(, "two_sided": true)", flux)(550) * kPi * kPi * 8, 0.02, 1e-12);
}

// Lights with the same spectrum store it once, whatever their strengths.
TEST_F(DescriptionTest, ManyLampsOfOneSpectrumWeighLittle) {
  constexpr std::size_t kLamps = 1000;
  const auto strength = [](std::size_t i) {
    return std::ldexp(1 + 0.37 * static_cast<double>(i % 7), static_cast<int>(i % 5));
  };
  const auto weight = [&](std::size_t count) {
    std::string lamps;
    for (std::size_t i = 0; i < count; ++i)
      lamps += fmt::format(
          R"({}{{"point": {{"at": [{}, 0, 1]}}, "emission": {{"illuminant": "{}", "luminous_intensity": {}}}}})",
          i == 0 ? "" : ",", i, i % 2 == 0 ? "A" : "FL11", strength(i));
    const Loaded loaded = load(fmt::format(R"({{"lights": [{}]}})", lamps));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    for (std::size_t i = 0; i < count; ++i) {
      const ScaledCurve& emission = loaded->lights[i].emission;
      EXPECT_EQ(&emission.base(), &loaded->lights[i % 2].emission.base());
      EXPECT_NEAR(photometric(emission.curve()) / strength(i), 1, 1e-12) << i;
      EXPECT_LE(emission.base().max(), 1);
    }
    return loaded->memory_bytes();
  };
  EXPECT_LE(weight(kLamps) - weight(2), 300 * kLamps);
  EXPECT_GT(weight(2), 2 * 800 * 3 * sizeof(double));  // shared data count too
}

TEST_F(DescriptionTest, LampsAreShapes) {
  const Loaded loaded = load(
      R"({"lights": [{"disc": {"center": [0, 0, 1], "normal": [0, 0, -1], "radius": 2}, "two_sided": true,
      "emission": {"spectrum": 1}}, {"name": "bulb", "sphere": {"center": [0, 0, 0], "radius": 0.1}, "emission": {"spectrum": 2}, "material": "m"}],
    "materials": {"m": {"diffuse": {"reflectance": 0.5}}},
    "shapes": [{"mesh": "bench.ply", "material": "m", "emission": {"spectrum": 3}}]})");
  ASSERT_TRUE(loaded.scene) << loaded.text();
  ASSERT_EQ(loaded->shapes.size(), 3U);
  ASSERT_EQ(loaded->lights.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& area = std::get<AreaLight>(loaded->lights[i].kind);
    EXPECT_EQ(loaded->shapes[area.shape].light, static_cast<std::int32_t>(i));
    EXPECT_EQ(area.two_sided, i == 1);
  }
  EXPECT_EQ(loaded->lights[2].name, "bulb");
  EXPECT_EQ(loaded->materials[loaded->shapes[2].material].name, "m");
  EXPECT_EQ(std::get<DiffuseMaterial>(loaded->materials[loaded->shapes[1].material].model)
                .reflectance.curve()
                .max(),
            0)
      << "a lamp without a material is black";
}

}  // namespace
}  // namespace abbe
