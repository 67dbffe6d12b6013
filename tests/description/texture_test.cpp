#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "gltf_asset.h"
#include "io/picture.h"
#include "materials/bsdf/diffuse.h"
#include "mesh_files.h"
#include "spectral/rgb.h"
#include "tests/io/icc_profile.h"

namespace abbe {
namespace {

using Imath::V2f;
using test::Fault;
using test::Loaded;
using test::painted;
using test::write;

const SampledSpectrum kWavelengths({400, 450, 500, 550, 600, 650, 700, 750});

class TextureTest : public test::MeshFileTest {
 protected:
  // Reflectance at (u, v), at each of the test wavelengths, of a material with this reflectance.
  SampledSpectrum reflectance(const std::string& json, const V2f& uv) {
    const Loaded loaded = load(painted(json));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    if (!loaded.scene) return {};
    return std::get<DiffuseBsdf>(make_bsdf(loaded->materials.at(0), {kWavelengths, uv})).reflectance;
  }
  Loaded load_mesh(const std::string& file, const std::string& bytes,
                   const char* reflectance = R"({"image": "paint.exr", "weights": {"a": 1}})") {
    write(folder_ / file, bytes);
    return load(fmt::format(
        R"({{"materials": {{"m": {{"diffuse": {{"reflectance": {}}}}}}}, "shapes": [{{"mesh": "{}", "material": "m"}}]}})",
        reflectance, file));
  }
};

TEST_F(TextureTest, ChannelsWeighSpectra) {
  const std::string texture = R"({"image": "paint.exr", "weights": {
      "b": {"table": {"wavelength_nm": [400, 800], "values": [0, 1], "outside": "clamp"}}, "a": 0.4}})";
  const SampledSpectrum left = reflectance(texture, {0.25F, 0.5F});
  const SampledSpectrum right = reflectance(texture, {0.75F, 0.5F});
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_NEAR(left[lane], 0.1 + 0.5 * (static_cast<double>(kWavelengths[lane]) - 400) / 400, 1e-6);
    EXPECT_NEAR(right[lane], 0.4, 1e-6);
  }
}

TEST_F(TextureTest, KeysSayHowTheImageLies) {
  const std::string start = R"({"image": "paint.exr", "weights": {"a": 1}, )";
  EXPECT_NEAR(reflectance(start + R"("filter": "bilinear"})", {0.5F, 0.5F})[0], 0.625, 1e-6);
  EXPECT_NEAR(reflectance(start + R"("filter": "nearest"})", {0.49F, 0.5F})[0], 0.25, 1e-6);
  EXPECT_NEAR(reflectance(start + R"("wrap": "clamp"})", {1.5F, 0.5F})[0], 1, 1e-6);
  EXPECT_NEAR(reflectance(start + R"("wrap": "repeat"})", {1.25F, 0.5F})[0], 0.25, 1e-6);
  EXPECT_NEAR(reflectance(start + R"("scale": [3, 1], "offset": [0.125, 0]})", {0.375F, 0.5F})[0], 0.25,
              1e-6);
}

TEST_F(TextureTest, FilesOfIntegersAreLinearWeightsAndEncodedColours) {
  write_raw_picture(folder_ / "deep.png", {1, 1, {{"R", {13107}}, {"G", {0}}, {"B", {65535}}}, {}});
  EXPECT_NEAR(reflectance(R"({"image": "deep.png", "weights": {"R": 1}})", {0, 0})[0], 0.2, 1e-6);
  write_raw_picture(folder_ / "deep.tif", {1, 1, {{"Y", {13107}}}, {}});
  EXPECT_NEAR(reflectance(R"({"image": "deep.tif", "weights": {"Y": 1}})", {0, 0})[0], 0.2, 1e-6);
  EXPECT_NEAR(reflectance(R"({"image": "deep.tif", "rgb": true})", {0, 0})[0], std::pow(0.255 / 1.055, 2.4),
              1e-4)
      << "grey";
  write_picture(folder_ / "photo.png", {1, 1, {{"R", {0.2F}}, {"G", {0.4F}}, {"B", {0.6F}}}, {}});
  const Curve encoded = rgb_spectrum({srgb_decoded(0.2), srgb_decoded(0.4), srgb_decoded(0.6)});
  const Curve linear = rgb_spectrum({0.2, 0.4, 0.6});
  const SampledSpectrum png = reflectance(R"({"image": "photo.png", "rgb": true})", {0, 0});
  const SampledSpectrum exr = reflectance(R"({"image": "photo.exr", "rgb": true})", {0, 0});
  for (int lane = 0; lane < kLanes; ++lane) {
    EXPECT_NEAR(png[lane], encoded(static_cast<double>(kWavelengths[lane])), 1e-6);
    EXPECT_NEAR(exr[lane], linear(static_cast<double>(kWavelengths[lane])), 1e-6);
  }
}

TEST_F(TextureTest, ColoursOfIntegersThatSayThatTheyAreLinearAreNotDecoded) {
  write_raw_picture(folder_ / "deep.png", {1, 1, {{"R", {13107}}, {"G", {26214}}, {"B", {39321}}}, {}});
  const Curve linear = rgb_spectrum({0.2, 0.4, 0.6});
  const SampledSpectrum png = reflectance(R"({"image": "deep.png", "rgb": true})", {0, 0});
  for (int lane = 0; lane < kLanes; ++lane)
    EXPECT_NEAR(png[lane], linear(static_cast<double>(kWavelengths[lane])), 1e-6);
}

TEST_F(TextureTest, ColoursAreThoseOfTheProfileOfTheirFile) {
  const auto path = folder_ / "photo.jpg";
  const auto painted_with = [&](const std::array<std::array<double, 3>, 3>& xyz, const std::string& curve) {
    write_picture(path, {1, 1, {{"R", {0.8F}}, {"G", {0.25F}}, {"B", {0.15F}}}, {}});
    test::put_profile(path, test::icc_profile("Display P3", "RGB ", test::primaries_and_curve(xyz, curve)));
    return R"({"image": "photo.jpg", "rgb": true})";
  };
  const auto expect_decoded = [&](const std::string& curve, double (*decoded)(double)) {
    const double seen = reflectance(painted_with(test::kSrgbColumns, curve), {0, 0})[6];
    const Image codes = read_picture(path);
    const auto linear = [&](std::size_t c) {
      return decoded(static_cast<double>(codes.channels[c].values[0]));
    };
    EXPECT_NEAR(seen, rgb_spectrum({linear(0), linear(1), linear(2)})(700), 1e-5);
  };
  expect_decoded(test::srgb_curve(), srgb_decoded);
  expect_decoded(test::curve_tag({}), [](double code) { return code; });
  expect_decoded(test::curve_tag({512}), [](double code) { return code * code; });
  const Loaded wide = load(painted(painted_with(test::kP3Columns, test::srgb_curve())));
  EXPECT_FALSE(wide.scene);
  EXPECT_NE(wide.text().find("/reflectance/image: error: texture \"photo.jpg\": its colours are those of the "
                             "profile \"Display P3\" (allowed the primaries of sRGB, "),
            std::string::npos)
      << wide.text();
  EXPECT_TRUE(load(painted(R"({"image": "photo.jpg", "weights": {"R": 1}})")).scene) << "codes, no colours";
}

TEST_F(TextureTest, AlphaBesideColoursIsSaidNotToBeHeeded) {
  const auto warns = [&](float alpha, const char* of) {
    write_exr(folder_ / "veil.exr",
              {2, 1, {{"R", {0, 0.2F}}, {"G", {0, 0.2F}}, {"B", {0, 0.2F}}, {"A", {1, alpha}}}, {}});
    const Loaded loaded = load(painted(fmt::format(R"({{"image": "veil.exr", {}}})", of)));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    return loaded.text().find(
               "/reflectance/image: warning: texture \"veil.exr\": its alpha channel is ignored, and colours "
               "are used as stored") != std::string::npos;
  };
  EXPECT_TRUE(warns(0.5F, R"("rgb": true)"));
  EXPECT_FALSE(warns(1, R"("rgb": true)"));
  EXPECT_FALSE(warns(0.5F, R"("weights": {"R": 1})"));
}

TEST_F(TextureTest, PicturesStandUprightAsTheirFilesSay) {
  // A row of two texels stored from the right, 0.25 and 0.5; the second must appear on the left.
  write(folder_ / "mirrored.hdr",
        "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 -X 2\n\x80\x80\x80\x7f\x80\x80\x80\x80");
  const std::string texture = R"({"image": "mirrored.hdr", "weights": {"R": 1}, "filter": "nearest"})";
  EXPECT_NEAR(reflectance(texture, {0.25F, 0.5F})[0], 0.5, 1e-6);
  EXPECT_NEAR(reflectance(texture, {0.75F, 0.5F})[0], 0.25, 1e-6);
}

TEST_F(TextureTest, ColoursAreSaidToHaveNoSpectrum) {
  const Loaded loaded = load(painted(R"({"image": "photo.exr", "rgb": true})"));
  ASSERT_TRUE(loaded.scene) << loaded.text();
  EXPECT_NE(
      loaded.text().find("/reflectance/image: warning: texture \"photo.exr\": RGB values do not determine a "
                         "spectrum: the smooth spectrum of the same colour under D65 is used"),
      std::string::npos)
      << loaded.text();
}

TEST_F(TextureTest, ImagesAreCountedAsMemory) {
  const auto bytes = [&](const std::string& reflectance) {
    return load(painted(reflectance))->memory_bytes();
  };
  const std::string paint = R"({"image": "paint.exr", "weights": {"a": 1, "b": 0}})";
  EXPECT_EQ(bytes(paint) - bytes("1"), 4 * sizeof(float));
  const std::vector<std::string> others{R"("mirror": {{"reflectance": {0}}})",
                                        R"("schlick": {{"reflectance": {0}}})",
                                        R"("oren_nayar": {{"reflectance": {0}, "sigma_deg": 20}})",
                                        R"("principled": {{"base_color": {0}}})",
                                        R"("cosine_power": {{"reflectance": {0}, "exponent": 2}})",
                                        R"("phong": {{"reflectance": {0}, "exponent": 2}})",
                                        R"("retroreflector": {{"reflectance": {0}, "exponent": 2}})",
                                        R"("coated_diffuse": {{"ior": 1.5, "reflectance": {0}}})"};
  for (const std::string& model : others) {
    const auto made_of = [&](const std::string& reflectance) {
      const Loaded loaded = load(fmt::format(
          R"({{"materials": {{"m": {{{}}}}}, "shapes": [{{"disc": {{"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1}}, "material": "m"}}]}})",
          fmt::format(fmt::runtime(model), reflectance)));
      EXPECT_TRUE(loaded.scene) << loaded.text();
      return loaded.scene ? loaded->memory_bytes() : 0;
    };
    EXPECT_EQ(made_of(paint) - made_of("0.5"), 4 * sizeof(float)) << model;
  }
}

TEST_F(TextureTest, SlightExcessIsCut) {
  write_exr(folder_ / "over.exr", {2, 1, {{"a", {0.5F, 1.0005F}}}, {}});
  const Loaded loaded = load(painted(R"({"image": "over.exr", "weights": {"a": 1}})"));
  ASSERT_TRUE(loaded.scene) << loaded.text();
  EXPECT_NE(loaded.text().find("texel (1, 0) reflects 1.0005 at"), std::string::npos) << loaded.text();
  EXPECT_NE(loaded.text().find("clamped to [0, 1]"), std::string::npos) << loaded.text();
  EXPECT_EQ(load(painted(R"({"image": "paint.exr", "weights": {"a": 1}})")).text().find("texture"),
            std::string::npos);
}

// Some texels reach 1 in one channel, but none does in the sum.
TEST_F(TextureTest, ExcessIsToldTexelByTexel) {
  EXPECT_TRUE(load(painted(R"({"image": "paint.exr", "weights": {"a": 1, "b": 1}})")).scene);
  EXPECT_TRUE(load(painted(R"({"image": "paint.exr", "weights": {"a": 0.9, "b": -0.45}})")).scene);
}

TEST_F(TextureTest, FaultsAreRefused) {
  write(folder_ / "text.exr", "no image");
  write(folder_ / "cut.exr", test::file_text(folder_ / "paint.exr").substr(0, 300));
  write_picture(folder_ / "whole.png", {64, 64, {{"Y", std::vector<float>(4096, 0.5F)}}, {}});
  write_exr(folder_ / "bad.exr", {2, 1, {{"a", {0.5F, NAN}}}, {}});
  write_exr(folder_ / "over.exr", {1, 3, {{"a", {0.5F, 1.5F, 0}}}, {}});
  DescriptionTest::expect_refused(
      {{"no such channel", painted(R"({"image": "paint.exr", "weights": {"c": 1}})"), ErrorCode::input,
        "texture \"paint.exr\": no channel \"c\" (it has a, b)"},
       {"not finite", painted(R"({"image": "bad.exr", "weights": {"a": 1}})"), ErrorCode::input,
        "texture \"bad.exr\": texel (1, 0) of channel a is not finite"},
       {"too much", painted(R"({"image": "over.exr", "weights": {"a": {"band": [500, 600], "value": 0.8}}})"),
        ErrorCode::scene, "texture \"over.exr\": texel (0, 1) reflects 1.2 at 500 nm (allowed [0, 1])"},
       {"less than nothing", painted(R"({"image": "over.exr", "weights": {"a": -0.1}})"), ErrorCode::scene,
        "texel (0, 1) reflects -0.15"},
       {"neither", painted(R"({"image": "paint.exr"})"), ErrorCode::scene, "weights, rgb"},
       {"both", painted(R"({"image": "paint.exr", "weights": {"a": 1}, "rgb": true})"), ErrorCode::scene,
        "exactly one"},
       {"rgb without", painted(R"({"image": "paint.exr", "rgb": true})"), ErrorCode::input,
        "no channel \"R\""},
       {"rgb false", painted(R"({"image": "paint.exr", "rgb": false})"), ErrorCode::scene, "needs weights"},
       {"no spectra", painted(R"({"image": "paint.exr", "weights": {}})"), ErrorCode::scene,
        "expected spectra by channel (got none)"},
       {"filter", painted(R"({"image": "paint.exr", "weights": {"a": 1}, "filter": "cubic"})"),
        ErrorCode::scene, "unknown filter"},
       {"key", painted(R"({"image": "paint.exr", "weights": {"a": 1}, "filtre": "nearest"})"),
        ErrorCode::scene, "filter"},
       {"URL", painted(R"({"image": "http://host/a.png", "weights": {"a": 1}})"), ErrorCode::input,
        "expected a file (got the URL"}});
  const std::string png = test::file_text(folder_ / "whole.png");
  write(folder_ / "cut.png", png.substr(0, png.size() / 2));
  for (const char* file : {"none.png", "none.exr", "text.exr", "cut.exr", "cut.png", ".", "/dev/zero"})
    DescriptionTest::expect_refused(
        {{file, painted(fmt::format(R"({{"image": "{}", "weights": {{"a": 1}}}})", file)), ErrorCode::input,
          "/reflectance/image: error: "}});
}

// v of OBJ increases upwards, that of glTF downwards.
TEST_F(TextureTest, MeshFilesBringCoordinates) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0 0\nvt 1 0.5\n";
  const Loaded obj = load_mesh("a.obj", corners + "f 1/1 2/2 3/3 4/-1\n");
  ASSERT_TRUE(obj.scene) << obj.text();
  using Corners = std::array<V2f, 3>;
  const auto& fan = std::get<Mesh>(obj->shapes.at(0).shape).coordinates;
  ASSERT_EQ(fan.size(), 2U);
  EXPECT_EQ(fan[0], (Corners{V2f(0, 0), V2f(1, 0), V2f(1, 0.5F)}));
  EXPECT_EQ(fan[1], (Corners{V2f(0, 0), V2f(1, 0.5F), V2f(1, 0.5F)}));

  test::Asset asset;
  asset.primitive = R"("attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1)";
  asset.accessors.pop_back();
  asset.accessors +=
      R"(, {"bufferView": 2, "componentType": 5121, "normalized": true, "count": 3, "type": "VEC2"}])";
  asset.views.pop_back();
  asset.views += R"(, {"buffer": 0, "byteOffset": 44, "byteStride": 4, "byteLength": 12}])";
  const std::string bytes =
      test::triangle_bytes() + test::raw<std::uint8_t>({0, 255, 0, 0, 255, 255, 0, 0, 0, 0, 0, 0});
  asset.buffer = fmt::format(R"({{"byteLength": {}, "uri": "data:application/octet-stream;base64,{}"}})",
                             bytes.size(), test::base64(bytes));
  const Loaded gltf = load_mesh("a.gltf", asset.text());
  ASSERT_TRUE(gltf.scene) << gltf.text();
  const auto& triangle = std::get<Mesh>(gltf->shapes.at(0).shape).coordinates;
  ASSERT_EQ(triangle.size(), 1U);
  EXPECT_EQ(triangle[0], (Corners{V2f(0, 0), V2f(1, 0), V2f(0, 1)}));
}

TEST_F(TextureTest, CoordinatesThatNobodyNeedsAreNotKept) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt oops\nf 1/1 2/1 3/1\n";
  const Loaded plain = load_mesh("a.obj", obj, "0.5");
  ASSERT_TRUE(plain.scene) << plain.text();
  EXPECT_TRUE(std::get<Mesh>(plain->shapes.at(0).shape).coordinates.empty());
  EXPECT_FALSE(plain->features.textures);
  const Loaded mapped = load_mesh("a.obj", obj);
  EXPECT_FALSE(mapped.scene);
  EXPECT_NE(mapped.text().find("line 5: texture coordinates need two finite numbers (got oops)"),
            std::string::npos)
      << mapped.text();
}

TEST_F(TextureTest, AMeshWithoutCoordinatesTakesNoTexture) {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\n";
  for (const char* faces : {"f 1 2 3\n", "f 1/1 2/1 3/1\nf 1 3 4\n"}) {
    const Loaded loaded = load_mesh("a.obj", corners + faces);
    EXPECT_FALSE(loaded.scene);
    EXPECT_EQ(loaded.diagnostics.code(), ErrorCode::input);
    EXPECT_NE(
        loaded.text().find(
            "/shapes/0/mesh: error: mesh \"a.obj\": no texture coordinates, which its material \"m\" needs"),
        std::string::npos)
        << loaded.text();
  }
  const std::string uv = R"("uv": [[0, 0], [1, 0], [1, 1]])";
  const auto inline_mesh = [&](const std::string& more) {
    return load(fmt::format(
        R"({{"materials": {{"m": {{"diffuse": {{"reflectance": {{"image": "paint.exr", "weights": {{"a": 1}}}}}}}}}},
            "shapes": [{{"mesh": {{"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0]], "triangles": [[0, 1, 2]]{}}}, "material": "m"}}]}})",
        more));
  };
  EXPECT_FALSE(inline_mesh("").scene);
  EXPECT_TRUE(inline_mesh(", " + uv).scene) << inline_mesh(", " + uv).text();
  EXPECT_NE(
      inline_mesh(R"(, "uv": [[0, 0]])").text().find("as many uv as vertices are needed (got 1, allowed 3)"),
      std::string::npos);
}

}  // namespace
}  // namespace abbe
