// Compares converted glTF scenes with the same scenes written by hand.
#include <cmath>

#include "gltf_asset.h"
#include "importers.h"
#include "io/schema/write.h"
#include "spectral/rgb.h"
#include "tests/io/icc_profile.h"

namespace abbe {
namespace {

using test::Asset;
using test::DoorFault;

// A triangle of material 0 with a camera that sees it, and further nodes.
std::string gltf(const std::string& material, const std::string& nodes = "", const std::string& roots = "",
                 const std::string& more = "") {
  Asset asset;
  asset.nodes = R"([{"mesh": 0}, {"camera": 0, "translation": [0, 0, 5]})" + nodes + "]";
  asset.roots = "[0, 1" + roots + "]";
  asset.primitive = R"("attributes": {"POSITION": 0}, "indices": 1, "material": 0)";
  asset.more =
      R"(, "materials": [)" + material +
      R"(], "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "aspectRatio": 2, "znear": 1}}])" +
      more;
  return asset.text();
}

class GltfSceneTest : public test::ImportersTest {
 protected:
  // The parts that all scenes of `gltf` have in common, with the additions of a test.
  static std::string twin(const std::string& material, const std::string& lights = "",
                          const std::string& shape = "") {
    return R"({"abbe": 1, "camera": {"pinhole": {"fov_deg": 28.64788975654116}, "from": [0, 0, 5], "to": [0, 0, 4], "up": [0, 1, 0]},
      "sensor": {"resolution": [1440, 720], "observer": "1931"}, "materials": {"m": )" +
           material +
           R"(}, "shapes": [{"name": "m", "mesh": {"file": "a.gltf", "of_material": "m"}, "material": "m")" +
           shape + "}]" + (lights.empty() ? "" : R"(, "lights": [)" + lights + "]") + "}";
  }
  void expect_twin(const std::string& theirs, const std::string& ours) {
    const auto made = convert("a.gltf", theirs);
    ASSERT_TRUE(made) << told_;
    Diagnostics diagnostics;
    const auto json = parse_json(std::make_shared<const SourceText>(SourceText{"ours", ours}), diagnostics);
    ASSERT_TRUE(json) << diagnostics.text();
    const auto said = schema::read<spec::Scene>(*json, diagnostics);
    ASSERT_TRUE(said) << diagnostics.text();
    EXPECT_EQ(to_text(schema::write(*made)), to_text(schema::write(*said)));
  }
};

TEST_F(GltfSceneTest, MetallicRoughness) {
  expect_twin(
      gltf(
          R"({"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0.3, "roughnessFactor": 0.6}})"),
      twin(
          R"({"principled": {"base_color": 0.5, "metallic": 0.3, "roughness": 0.6, "specular": 0.5000000000000001}})"));
  expect_twin(
      gltf(
          R"({"name": "m", "pbrMetallicRoughness": {"metallicFactor": 0}, "extensions": {"KHR_materials_ior": {"ior": 1}, "KHR_materials_clearcoat": {"clearcoatFactor": 0.125, "clearcoatRoughnessFactor": 0.25}}})"),
      twin(
          R"({"principled": {"base_color": 1, "roughness": 1, "specular": 0, "clearcoat": 0.5, "clearcoat_gloss": 0.37878787878787884}})"));
  EXPECT_FALSE(tells("clamped")) << told_;
}

// A glTF clear coat of factor 1 reflects 0.04 at normal incidence; the coat of `principled` reflects at most
// a quarter of that.
TEST_F(GltfSceneTest, CoatsAndReflectancesBeyondWhatThereIsAreCut) {
  const auto made = convert(
      "a.gltf",
      gltf(
          R"({"name": "m", "extensions": {"KHR_materials_ior": {"ior": 2.4}, "KHR_materials_clearcoat": {"clearcoatFactor": 0.5, "clearcoatRoughnessFactor": 0.5}}})"));
  ASSERT_TRUE(made) << told_;
  const auto& surface = std::get<spec::Principled>(made->materials.at(0).value.model);
  EXPECT_EQ(surface.specular, 1);
  EXPECT_EQ(surface.clearcoat, 1);
  EXPECT_EQ(surface.clearcoat_gloss, 0);
  for (const char* what : {"a clear coat factor above 0.25 is clamped to that value",
                           "a facet width of a clear coat above 0.1 is clamped to that value",
                           "a reflectance at normal incidence above 0.08 is clamped to that value"})
    EXPECT_TRUE(tells(what)) << told_ << "lacks " << what;
  ASSERT_TRUE(convert(
      "a.gltf",
      gltf(
          R"({"name": "m", "extensions": {"KHR_materials_ior": {"ior": 1.78}, "KHR_materials_clearcoat": {"clearcoatRoughnessFactor": 0.5}}})")))
      << told_;
  EXPECT_FALSE(tells("clamped")) << told_;
}

TEST_F(GltfSceneTest, TexturesLieAsTheyDo) {
  write_exr(folder_ / "photo.exr", {1, 1, {{"R", {0.2F}}, {"G", {0.4F}}, {"B", {0.6F}}}, {}});
  Asset asset;
  asset.primitive = R"("attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0)";
  asset.accessors.back() = ',';
  asset.accessors += R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}])";
  const auto with = [&asset](const std::string& image) {
    asset.more =
        R"(, "materials": [{"name": "m", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0,
        "extensions": {"KHR_texture_transform": {"scale": [2, 3], "offset": [0.25, 0.5]}}}}}],
        "samplers": [{"wrapS": 33071}], "textures": [{"source": 0, "sampler": 0}], "images": [{"uri": ")" +
        image + "\"}]";
    return asset.text();
  };
  const auto made = convert("a.gltf", with("photo.exr"));
  ASSERT_TRUE(made) << told_;
  const auto& surface = std::get<spec::Principled>(made->materials.at(0).value.model);
  const auto& file = std::get<spec::Texture>(surface.base_color).file;
  EXPECT_EQ(file.image.value, "photo.exr");
  EXPECT_EQ(file.mapping.wrap, TextureWrap::clamp);
  EXPECT_EQ(file.mapping.scale, Imath::V2d(2, 3));
  // v increases downwards in glTF: 1 - (3 (1 - v) + 0.5).
  EXPECT_EQ(file.mapping.offset, Imath::V2d(0.25, -2.5));
  EXPECT_FALSE(convert("a.gltf", with("gone.exr")));
  EXPECT_TRUE(tells("gone.exr")) << told_;
  EXPECT_TRUE(convert("a.gltf", with("data:image/png;base64,AAAA"))) << told_;
  EXPECT_TRUE(tells("an image embedded in the file is not supported: dropped")) << told_;
}

// glTF decodes all images as sRGB, whatever their files declare.
TEST_F(GltfSceneTest, WhatAnImageSaysOfItsColoursIsTold) {
  Asset asset;
  asset.primitive = R"("attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0)";
  asset.accessors.back() = ',';
  asset.accessors += R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}])";
  const auto scene_of = [&](const std::string& colour) {
    asset.more = R"(, "materials": [{"pbrMetallicRoughness": {)" + colour +
                 R"(}}], "textures": [{"source": 0}], "images": [{"uri": "photo.jpg"}])";
    const auto made = convert("a.gltf", asset.text());
    return made ? to_text(schema::write(*made)) : "";
  };
  const auto scene_with = [&](const auto& xyz, const std::string& curve) {
    put_image("photo.jpg", false);
    test::put_profile(folder_ / "photo.jpg",
                      test::icc_profile("wide", "RGB ", test::primaries_and_curve(xyz, curve)));
    return scene_of(R"("baseColorTexture": {"index": 0})");
  };
  const std::string plain = scene_with(test::kSrgbColumns, test::srgb_curve());
  EXPECT_NE(plain.find("photo.jpg"), std::string::npos) << told_;
  EXPECT_FALSE(tells("takes it as sRGB")) << told_;
  EXPECT_EQ(scene_with(test::kSrgbColumns, test::curve_tag({})), plain);
  EXPECT_TRUE(tells("an image is decoded as it declares: the source renderer takes it as sRGB")) << told_;

  const std::string wide = scene_with(test::kP3Columns, test::srgb_curve());
  EXPECT_TRUE(
      tells("baseColorTexture: warning: an image that Abbe rejects is replaced by its mean as sRGB, as which "
            "the source renderer takes all images: its colours are those of the profile \"wide\" (allowed "))
      << told_;
  const Image photo = read_picture(folder_ / "photo.jpg");
  const auto linear = [&](std::size_t c) {
    return srgb_decoded(static_cast<double>(photo.channels[c].values[0]));
  };
  EXPECT_EQ(wide, scene_of(fmt::format(R"("baseColorFactor": [{:.17g}, {:.17g}, {:.17g}, 1])", linear(0),
                                       linear(1), linear(2))));
  put("photo.jpg", "no image");
  EXPECT_EQ(scene_of(R"("baseColorTexture": {"index": 0})"), "");
  EXPECT_TRUE(tells("baseColorTexture: error: ")) << told_;
}

TEST_F(GltfSceneTest, WhatImagesSayAndIsNotSoHereIsTold) {
  put_image("normals.exr", false);
  const auto read = [&](const std::string& sampler, const std::string& scale) {
    Asset asset;
    asset.primitive = R"("attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0)";
    asset.accessors.back() = ',';
    asset.accessors += R"({"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}])";
    asset.more = R"(, "materials": [{"name": "m", "normalTexture": {"index": 0)" + scale +
                 R"(}}], "samplers": [{)" + sampler +
                 R"(}], "textures": [{"source": 0, "sampler": 0}], "images": [{"uri": "normals.exr"}])";
    EXPECT_TRUE(convert("a.gltf", asset.text())) << told_;
  };
  read(R"("wrapS": 33071, "wrapT": 33071)", R"(, "scale": 1)");
  EXPECT_FALSE(tells("wrap modes")) << told_;
  EXPECT_FALSE(tells("normal map")) << told_;
  read(R"("wrapT": 33071)", R"(, "scale": 0.25)");
  EXPECT_TRUE(tells("different wrap modes along u and v are not supported: that of u is used")) << told_;
  EXPECT_TRUE(tells("the scale of a normal map is not supported: dropped")) << told_;
  read(R"("wrapT": 33648)", "");
  EXPECT_TRUE(tells("mirrored repetition of an image is not supported: it repeats")) << told_;
}

TEST_F(GltfSceneTest, GlassAndPanes) {
  expect_twin(
      gltf(
          R"({"name": "m", "pbrMetallicRoughness": {"roughnessFactor": 0}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.45}}})"),
      twin(R"({"thin_glass": {"ior": 1.45}})"));
  expect_twin(
      gltf(
          R"({"name": "m", "pbrMetallicRoughness": {"roughnessFactor": 0.5}, "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                       "KHR_materials_volume": {"thicknessFactor": 1, "attenuationColor": [0.5, 0.5, 0.5], "attenuationDistance": 2}}})"),
      twin(R"({"dielectric": {"ior": 1.5, "absorption_per_m": 0.34657359027997264, "roughness": 0.25}})"));
}

TEST_F(GltfSceneTest, DispersionHasTheAbbeNumber) {
  const auto made = convert(
      "a.gltf", gltf(R"({"name": "m", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 1}, "KHR_materials_ior": {"ior": 1.6}, "KHR_materials_dispersion": {"dispersion": 0.5}}})"));
  ASSERT_TRUE(made) << told_;
  const auto& table =
      std::get<spec::TableIor>(std::get<spec::Dielectric>(made->materials.at(0).value.model).ior.ior.value);
  const Curve n = table_curve(table.wavelength_nm, table.n, Outside::clamp);
  EXPECT_NEAR(n(587.5618), 1.6, 1e-4);
  EXPECT_NEAR((n(587.5618) - 1) / (n(486.1327) - n(656.2725)), 40, 0.1);
}

// Grey: half of the light remains after 2 m, with the same index as without absorption. Coloured: the
// spectrum of the colour.
TEST_F(GltfSceneTest, DispersionKeepsTheAbsorption) {
  const auto glass = [this](const std::string& attenuation) {
    const auto made = convert(
        "a.gltf", gltf(
                      R"({"name": "m", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 1)" +
                      attenuation + R"(}, "KHR_materials_dispersion": {"dispersion": 0.5}}})"));
    EXPECT_TRUE(made) << told_;
    return made ? std::get<spec::Dielectric>(made->materials.at(0).value.model).ior : spec::TintedIor{};
  };
  const auto clear = glass("");
  EXPECT_FALSE(clear.absorption_per_m);
  const auto grey = glass(R"(, "attenuationColor": [0.5, 0.5, 0.5], "attenuationDistance": 2)");
  EXPECT_EQ(std::get<spec::TableIor>(grey.ior.value).n, std::get<spec::TableIor>(clear.ior.value).n);
  ASSERT_TRUE(grey.absorption_per_m);
  EXPECT_NEAR(std::get<double>(grey.absorption_per_m->value), std::log(2) / 2, 1e-12);
  EXPECT_FALSE(tells("a colour does not determine a spectrum")) << told_;
  EXPECT_TRUE(glass(R"(, "attenuationColor": [0.5, 1, 1], "attenuationDistance": 2)").absorption_per_m);
  EXPECT_TRUE(tells("a colour does not determine a spectrum")) << told_;
}

TEST_F(GltfSceneTest, Emission) {
  expect_twin(
      gltf(
          R"({"name": "m", "doubleSided": true, "emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 100}}})"),
      twin(
          R"({"principled": {"base_color": 1, "metallic": 1, "roughness": 1, "specular": 0.5000000000000001}})",
          "", R"(, "emission": {"illuminant": "D65", "luminance": 100}, "two_sided": true)"));
}

TEST_F(GltfSceneTest, Lights) {
  const std::string nodes =
      R"(, {"translation": [1, 2, 3], "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "children": [3, 4]},
      {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 0, 0]},
      {"extensions": {"KHR_lights_punctual": {"light": 1}}, "rotation": [-0.7071067811865476, 0, 0, 0.7071067811865476]},
      {"extensions": {"KHR_lights_punctual": {"light": 2}}})";
  const std::string lights =
      R"(, "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 30},
      {"type": "spot", "intensity": 20, "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5}}, {"type": "directional", "intensity": 10}]}})";
  const auto made = convert("a.gltf", gltf(R"({"name": "m"})", nodes, ", 2, 5", lights));
  ASSERT_TRUE(made) << told_;
  ASSERT_EQ(made->lights.size(), 3U);
  const auto& point = std::get<spec::PointLightSource>(made->lights[0].kind);
  EXPECT_LT((point.source.at - Imath::V3d(1, 3, 3)).length(), 1e-12);
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::luminous_intensity>>(point.emission.scale).value, 30,
              1e-12);
  const auto& spot = std::get<spec::SpotLightSource>(made->lights[1].kind);
  EXPECT_LT((spot.source.direction - Imath::V3d(1, 0, 0)).length(), 1e-12);
  EXPECT_NEAR(spot.source.half_angle_deg, 0.5 * 180 / M_PI, 1e-12);
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::luminous_intensity>>(spot.emission.scale).value, 20,
              1e-12);
  const auto& beam = std::get<spec::DirectionalLightSource>(made->lights[2].kind);
  EXPECT_EQ(beam.source.towards, Imath::V3d(0, 0, 1));
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::illuminance>>(beam.emission->scale).value, 10, 1e-12);
}

// The soft edge is the squared normalised cosine: the integral of (c - 1/2)^2/(1/2)^2 from 1/2 to 1 is 1/6.
TEST_F(GltfSceneTest, SoftSpotsSendOutAsMuch) {
  const std::string node = R"(, {"extensions": {"KHR_lights_punctual": {"light": 0}}})";
  const std::string light =
      R"(, "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "intensity": 20, "spot": {"outerConeAngle": 1.0471975511965976}}]}})";
  const auto made = convert("a.gltf", gltf(R"({"name": "m"})", node, ", 2", light));
  ASSERT_TRUE(made) << told_;
  const auto& spot = std::get<spec::SpotLightSource>(made->lights.at(0).kind);
  EXPECT_NEAR(1 - std::cos(spot.source.half_angle_deg * M_PI / 180), 1.0 / 6, 1e-12);
}

TEST_F(GltfSceneTest, WithoutACameraAllIsSeen) {
  const auto made = convert("a.gltf", Asset{}.text());
  ASSERT_TRUE(made) << told_;
  EXPECT_TRUE(tells("the file has no camera")) << told_;
  EXPECT_EQ(made->materials.at(0).name, "default");
}

TEST_F(GltfSceneTest, ReadsBinaryFiles) {
  EXPECT_TRUE(convert("a.glb", test::whole_glb())) << told_;
  EXPECT_FALSE(convert("a.glb", test::whole_glb().substr(0, 60)));
  EXPECT_TRUE(tells("a.glb: error: malformed or truncated GLB")) << told_;
}

TEST_F(GltfSceneTest, MaterialsAreReplacedByName) {
  const auto made =
      convert("a.gltf", gltf(R"({"name": "m"})"), R"({"m": {"conductor": {"ior": "Ag_Johnson"}}})");
  ASSERT_TRUE(made) << told_;
  EXPECT_TRUE(std::holds_alternative<spec::Conductor>(made->materials.at(0).value.model));
}

TEST_F(GltfSceneTest, FaultsHaveTheirPlace) {
  const std::vector<DoorFault> faults{
      {"truncated", "{\"asset\": {\n", "a.gltf:2:1: /asset: error:"},
      {"no scene", "{\n}", "a.gltf:1:1: error: the file has no scene"},
      {"light", gltf(R"({"name": "m"})", R"(, {"extensions": {"KHR_lights_punctual": {"light": 0}}})", ", 2"),
       "\"extensions/KHR_lights_punctual/lights\" has no element with this index"},
      {"light's type",
       gltf(R"({"name": "m"})", R"(, {"extensions": {"KHR_lights_punctual": {"light": 0}}})", ", 2",
            R"(, "extensions": {"KHR_lights_punctual": {"lights": [{"type": "pont"}]}})"),
       "unknown light \"pont\"; did you mean \"point\"?"},
      {"colour", gltf(R"({"name": "m", "pbrMetallicRoughness": {"baseColorFactor": [2, 0, 0, 1]}})"),
       "/materials/0/pbrMetallicRoughness/baseColorFactor/0: error:"},
      {"number", gltf(R"({"name": "m", "pbrMetallicRoughness": {"metallicFactor": "x"}})"),
       "/materials/0/pbrMetallicRoughness/metallicFactor: error:"},
  };
  for (const DoorFault& fault : faults) {
    SCOPED_TRACE(fault.what);
    EXPECT_FALSE(convert("a.gltf", fault.text));
    EXPECT_TRUE(tells(fault.message)) << told_ << "lacks " << fault.message;
  }
}

TEST_F(GltfSceneTest, PrefixesOfAFileCrashNothing) {
  expect_no_crash_at_any_prefix("a.gltf", gltf(R"({"name": "m", "emissiveFactor": [1, 0.5, 1]})") + "\n");
}

}  // namespace
}  // namespace abbe
