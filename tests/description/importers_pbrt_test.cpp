// What scenes of pbrt in the wild say and small examples do not.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "io/exr.h"
#include "pbrt_scenes.h"
#include "spectral/curve.h"
#include "tests/materials/index_of.h"

namespace abbe {
namespace {

using test::kBegin;
using test::PbrtTest;
using test::SphereBody;

// Of these n alone, as there.
TEST_F(PbrtTest, GlassesAreThoseOfItsNames) {
  for (const auto& [theirs, ours] : {std::pair{"glass-BK7", "N-BK7"}, std::pair{"glass-BAF10", "N-BAF10"},
                                     std::pair{"glass-FK51A", "N-FK51A"}, std::pair{"glass-F5", "schott/SF5"},
                                     std::pair{"glass-F10", "SF10"}, std::pair{"glass-F11", "SF11"}}) {
    SCOPED_TRACE(theirs);
    const spec::TintedIor glass =
        material<spec::Dielectric>(fmt::format("Material \"dielectric\" \"spectrum eta\" \"{}\"", theirs))
            .ior;
    const auto& table = std::get<spec::TableIor>(glass.ior.value);
    const Curve n = table_curve(table.wavelength_nm, table.n, Outside::clamp);
    for (const double nm : {400.0, 550.0, 700.0}) EXPECT_NEAR(n(nm), index_of(ours).n(nm), 1e-9);
    EXPECT_EQ(std::ranges::count(table.k.value(), 0), std::ssize(table.k.value()));
    EXPECT_FALSE(glass.absorption_per_m);
  }
}

TEST_F(PbrtTest, WidthsOfFacetsBeyond1AreCut) {
  const auto width = [&](const std::string& said) {
    const auto metal = material<spec::Conductor>("Material \"conductor\" \"float roughness\" " + said);
    return metal.roughness ? std::get<double>(metal.roughness->value) : 0;
  };
  for (const char* said : {"2", "1.5 \"bool remaproughness\" false"}) {
    EXPECT_EQ(width(said), 1);
    EXPECT_TRUE(tells("a.pbrt:5:1: warning: a facet width outside [0, 1] is clamped")) << told_;
  }
  EXPECT_EQ(width("-0.25"), 0);
  EXPECT_TRUE(tells("outside [0, 1]")) << told_;
  EXPECT_EQ(width("1"), 1);
  EXPECT_FALSE(tells("outside [0, 1]")) << told_;
}

TEST_F(PbrtTest, MagnesiaIsANumber) {
  const auto metal = material<spec::Conductor>(
      "Material \"conductor\" \"spectrum eta\" \"metal-MgO-eta\" \"spectrum k\" \"metal-MgO-k\"");
  const auto& index = std::get<spec::MetalIor>(metal.ior.value);
  EXPECT_EQ(index.n, 1.7375);
  EXPECT_EQ(index.k, 0);
  EXPECT_TRUE(tells("no table of MgO is shipped")) << told_;
}

void expect_at_550(const spec::Ior& index, double n, double k, double within = 1e-9) {
  const auto& table = std::get<spec::TableIor>(index.value);
  const auto found = std::ranges::find(table.wavelength_nm, 550);
  ASSERT_NE(found, table.wavelength_nm.end());
  const auto i = static_cast<std::size_t>(found - table.wavelength_nm.begin());
  EXPECT_NEAR(table.n.at(i), n, within);
  EXPECT_NEAR(table.k.value().at(i), k, within);
}

TEST_F(PbrtTest, MetalsTakeFromCopperWhatTheyDoNotSay) {
  const auto index = [&](const std::string& parameters) {
    return material<spec::Conductor>("Material \"conductor\" " + parameters).ior;
  };
  const RefractiveIndex copper = index_of("Cu_Johnson");
  const RefractiveIndex silver = index_of("Ag_Johnson");
  EXPECT_EQ(std::get<std::string>(index("\"spectrum k\" \"metal-Cu-k\"").value), "Cu_Johnson");
  expect_at_550(index("\"float eta\" 1.5"), 1.5, copper.k(550));
  expect_at_550(index("\"float k\" 3"), copper.n(550), 3);
  expect_at_550(index("\"spectrum eta\" \"metal-Ag-eta\""), silver.n(550), copper.k(550));
  expect_at_550(index("\"spectrum eta\" \"metal-Cu-eta\" \"spectrum k\" \"metal-Ag-k\""), copper.n(550),
                silver.k(550));
  expect_at_550(index("\"float eta\" 1.5 \"spectrum k\" \"metal-Ag-k\""), 1.5, silver.k(550));
}

// By the shares of the three spectra at 550 nm: 0.00748131, 0.9758122 and 0.01670649.
TEST_F(PbrtTest, IndicesThatAreColoursHaveTheirSpectra) {
  const auto metal = material<spec::Conductor>(
      "Material \"conductor\" \"rgb eta\" [0.143 0.375 1.442] \"rgb k\" [3.983 2.386 1.603]");
  EXPECT_TRUE(tells("a colour does not determine a spectrum")) << told_;
  expect_at_550(metal.ior, 0.39109, 2.38487, 2e-5);
  const auto glass = [&](const std::string& rgb) {
    return material<spec::Dielectric>("Material \"dielectric\" \"rgb eta\" " + rgb).ior.ior;
  };
  expect_at_550(glass("[1.5 1.6 1.7]"), 1.60092, 0, 2e-5);
  EXPECT_EQ(std::get<double>(glass("[1.6 1.6 1.6]").value), 1.6);
  expect_refused(
      {{"a lamp", kBegin + "Material \"conductor\" \"spectrum eta\" \"stdillum-D65\"\nShape \"sphere\"\n",
        "a.pbrt:5:22: error: n and k are numbers, colours or samples (got the spectrum of a light)"},
       {"a lamp as a metal's colour",
        kBegin + "Material \"conductor\" \"spectrum reflectance\" \"stdillum-D65\"\nShape \"sphere\"\n",
        "n and k are numbers, colours or samples (got the spectrum of a light)"}});
}

TEST_F(PbrtTest, SpectraMayBeThoseOfMetalsAndGlasses) {
  expect_at_550(material<spec::Conductor>(
                    "Material \"conductor\" \"spectrum eta\" \"glass-BK7\" \"spectrum k\" \"metal-MgO-k\"")
                    .ior,
                index_of("N-BK7").n(550), 0);
  expect_at_550(
      material<spec::Dielectric>("Material \"dielectric\" \"spectrum eta\" \"metal-Cu-eta\"").ior.ior,
      index_of("Cu_Johnson").n(550), 0);
  expect_refused(
      {{"no end", kBegin + "Material \"conductor\" \"spectrum eta\" \"metal-Ag\"\nShape \"sphere\"\n",
        "a.pbrt:5:22: error: unknown spectrum \"metal-Ag\"; did you mean \"metal-Ag-k\"?"}});
}

TEST_F(PbrtTest, ImagesOfTheSkyGiveTheirMean) {
  write_exr(folder_ / "sky.exr", {2, 1, {{"R", {1, 3}}, {"G", {2, 6}}, {"B", {0, 8}}}, {}});
  const auto luminance = [&](const std::string& more) {
    const spec::Scene made = scene("LightSource \"infinite\" \"string filename\" \"sky.exr\" " + more + "\n");
    if (made.lights.empty()) return 0.0;
    const auto& sky = std::get<spec::EnvironmentLightSource>(made.lights[0].kind);
    return std::get<spec::Amount<spec::Quantity::luminance>>(sky.emission.scale).value;
  };
  constexpr double kLm = 683.002;
  const double y = 0.2126390 * 2 + 0.7151687 * 4 + 0.0721923 * 4;  // of Rec.709
  EXPECT_NEAR(luminance("") / kLm, y, 1e-3);
  EXPECT_TRUE(tells("replaced by a uniform environment of the mean colour")) << told_;
  EXPECT_NEAR(luminance("\"float scale\" 10") / kLm, 10 * y, 1e-2);
  EXPECT_NEAR(luminance("\"float illuminance\" 5") / kLm, 5 / M_PI, 1e-3);
  write_exr(folder_ / "wide.exr", {1,
                                   1,
                                   {{"R", {1}}, {"G", {1}}, {"B", {1}}},
                                   {{kPrimariesKey, "0.708 0.292 0.17 0.797 0.131 0.046 0.3127 0.329"}}});
  expect_refused({{"gone", kBegin + "LightSource \"infinite\" \"string filename\" \"gone.exr\"\n",
                   "a.pbrt:5:24: error: "},
                  {"wide", kBegin + "LightSource \"infinite\" \"string filename\" \"wide.exr\"\n",
                   "its chromaticities are not those of Rec.709"}});
}

TEST_F(PbrtTest, WithoutACameraItIsPbrtsOwn) {
  const auto made = convert("a.pbrt", "WorldBegin\nShape \"sphere\"\n");
  ASSERT_TRUE(made) << told_;
  EXPECT_TRUE(tells("the scene has no camera: pbrt's default, 90 degrees along z, is used")) << told_;
  const auto& camera = std::get<spec::PinholeCamera>(made->camera->kind);
  EXPECT_EQ(camera.view.to, Imath::V3d(0, 0, 1));
  EXPECT_EQ(std::get<spec::FieldOfView>(camera.lens.view).value, 90);
}

TEST_F(PbrtTest, ParametersAreOfTheirTypeAndOne) {
  expect_refused({{"an integer", kBegin + "Shape \"sphere\" \"integer radius\" 1\n",
                   "a.pbrt:5:16: error: \"radius\" has a wrong type (got integer, allowed float)"},
                  {"two numbers", kBegin + "Shape \"sphere\" \"float radius\" [1 2]\n",
                   "a.pbrt:5:16: error: \"radius\" takes one value (got 2)"},
                  {"a float", "Sampler \"halton\" \"float pixelsamples\" 4\n" + kBegin,
                   "a.pbrt:1:18: error: \"pixelsamples\" has a wrong type (got float, allowed integer)"},
                  {"two points", kBegin + "LightSource \"point\" \"point3 from\" [1 2 3 4 5 6]\n",
                   "a.pbrt:5:21: error: \"from\" takes 3 values (got 6)"},
                  {"two truths",
                   kBegin + "Material \"conductor\" \"bool remaproughness\" [true false]\nShape "
                            "\"sphere\"\n",
                   "\"remaproughness\" takes one value (got 2)"}});
}

TEST_F(PbrtTest, ExtensionsMayBeCapitals) {
  ASSERT_TRUE(is_importable_scene("A.PBRT"));
  EXPECT_TRUE(convert("A.PBRT", kBegin + "Shape \"sphere\"\n")) << told_;
}

TEST_F(PbrtTest, InterfacesAroundMatterHaveAName) {
  const spec::Scene made = scene(
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\nMediumInterface \"fog\" \"\"\nMaterial "
      "\"\"\nShape \"sphere\"\n");
  EXPECT_EQ(made.materials.at(0).name, "interface with fog");
}

TEST_F(PbrtTest, ManyMaterialsWithoutANameAreShared) {
  std::string world;
  for (int i = 0; i < 3000; ++i)
    world +=
        "Material \"diffuse\" \"float reflectance\" 0." + std::to_string(i % 2 + 1) + "\nShape \"sphere\"\n";
  const spec::Scene made = scene(world);
  ASSERT_EQ(made.materials.size(), 2U);
  EXPECT_EQ(made.materials[0].name, "diffuse");
  EXPECT_EQ(made.materials[1].name, "diffuse 2");
  EXPECT_EQ(std::get<SphereBody>(made.shapes.at(2).kind).material.value, "diffuse");
  EXPECT_EQ(std::get<SphereBody>(made.shapes.at(2999).kind).material.value, "diffuse 2");
}

TEST_F(PbrtTest, IncludesHaveALimitInAll) {
  put("x0.pbrt", "\n");
  for (int i = 1; i <= 20; ++i) {
    const std::string before = "Include \"x" + std::to_string(i - 1) + ".pbrt\"\n";
    put("x" + std::to_string(i) + ".pbrt", before + before);
  }
  expect_refused(
      {{"doubling", kBegin + "Include \"x20.pbrt\"\n", "error: more than 10000 files are included"}});
  EXPECT_EQ(code_, ErrorCode::resource);
}

TEST_F(PbrtTest, WhatItBecameIsNamedAsSuch) {
  EXPECT_FALSE(convert("a.pbrt", kBegin + "Shape \"sphere\" \"float radius\" -1\n"));
  EXPECT_TRUE(tells("a.pbrt (converted):")) << told_;
}

TEST_F(PbrtTest, NamesOfFilesStayInTheirLine) {
  const auto text = written("two\nlines.pbrt", kBegin + "Shape \"sphere\" \"float alpha\" 1\n");
  ASSERT_TRUE(text) << told_;
  EXPECT_TRUE(text->starts_with("// Converted from two lines.pbrt. Approximated or dropped:\n")) << *text;
  EXPECT_TRUE(convert("two\nlines.pbrt", kBegin)) << told_;
}

TEST_F(PbrtTest, IntegratorsSayHowDeepPathsGo) {
  const auto depth = [&](const std::string& integrator) {
    const auto made = convert("a.pbrt", integrator + kBegin);
    EXPECT_TRUE(made) << told_;
    return made ? made->render->max_depth : std::nullopt;
  };
  EXPECT_EQ(depth("Integrator \"simplepath\" \"integer maxdepth\" 3\n"), 3);
  EXPECT_FALSE(tells("integrator")) << told_;
  EXPECT_EQ(depth("Integrator \"path\" \"integer maxdepth\" 0\n"), 1);
  EXPECT_TRUE(tells("a maximum depth below 1 is not supported")) << told_;
  EXPECT_EQ(depth("Integrator \"sppm\"\n"), 5);
  EXPECT_TRUE(tells("limits camera paths and photons separately")) << told_;
  for (const std::string type : {"ambientocclusion", "function"}) {
    EXPECT_EQ(depth("Integrator \"" + type + "\"\n"), 5);
    EXPECT_TRUE(tells("the output of an integrator \"" + type + "\" is not supported")) << told_;
  }
  expect_refused({{"integrator", "Integrator \"volpth\"\n" + kBegin,
                   "a.pbrt:1:1: error: unknown integrator \"volpth\"; did you mean \"volpath\"?"}});
}

TEST_F(PbrtTest, IntegratorsThatLeaveMediaOutAreTold) {
  const auto told_of = [&](const std::string& integrator) {
    EXPECT_TRUE(
        convert("a.pbrt", integrator + kBegin +
                              "MakeNamedMedium \"milk\" \"string type\" \"homogeneous\"\n"
                              "MediumInterface \"milk\" \"\"\nMaterial \"dielectric\"\nShape \"sphere\"\n"))
        << told_;
    return tells("ignores media");
  };
  EXPECT_FALSE(told_of("")) << told_;
  EXPECT_FALSE(told_of("Integrator \"volpath\"\n")) << told_;
  EXPECT_FALSE(told_of("Integrator \"bdpt\"\n")) << told_;
  EXPECT_TRUE(told_of("Integrator \"path\"\n")) << told_;
  EXPECT_TRUE(told_of("Integrator \"sppm\"\n")) << told_;
  EXPECT_TRUE(convert("a.pbrt", "Integrator \"path\"\n" + kBegin + "Shape \"sphere\"\n")) << told_;
  EXPECT_FALSE(tells("media")) << told_;
}

TEST_F(PbrtTest, WhatIntegratorsSayIsOfNoiseOrTold) {
  const std::string more =
      "\"bool regularize\" true \"float rrthreshold\" 0.5 \"string lightsampler\" \"power\"\n";
  ASSERT_TRUE(convert("a.pbrt", "Integrator \"volpath\" " + more + kBegin)) << told_;
  EXPECT_TRUE(tells("\"regularize\" of integrator is not supported: dropped")) << told_;
  EXPECT_FALSE(tells("rrthreshold")) << told_;
  EXPECT_FALSE(tells("lightsampler")) << told_;
}

TEST_F(PbrtTest, SamplersSayHowMany) {
  const auto samples = [&](const std::string& sampler) {
    const auto made = convert("a.pbrt", "Sampler " + sampler + "\n" + kBegin);
    EXPECT_TRUE(made) << told_;
    return made ? made->render->samples : 0;
  };
  EXPECT_EQ(samples("\"stratified\" \"integer xsamples\" 16 \"integer ysamples\" 8 \"bool jitter\" false"),
            128);
  EXPECT_EQ(samples("\"stratified\""), 16);
  EXPECT_EQ(samples("\"independent\""), 4);
  EXPECT_EQ(samples("\"halton\""), 16);
  EXPECT_FALSE(tells("sampler")) << told_;
  EXPECT_EQ(samples("\"halton\" \"integer xsamples\" 8"), 16);
  EXPECT_TRUE(tells("\"xsamples\" of sampler is not supported: dropped")) << told_;
  expect_refused(
      {{"more than an int holds",
        "Sampler \"stratified\" \"integer xsamples\" 1000000000 \"integer ysamples\" 1000000000\n" + kBegin,
        "/render/samples: error: expected an integer (got 1000000000, allowed [1, "}});
}

TEST_F(PbrtTest, WiderFiltersAreTold) {
  const auto told = [&](const std::string& filter) {
    EXPECT_TRUE(convert("a.pbrt", "PixelFilter " + filter + "\n" + kBegin)) << told_;
    return tells("pixel filters are not supported: a box of one pixel is used");
  };
  EXPECT_TRUE(told("\"gaussian\""));
  EXPECT_TRUE(told("\"box\" \"float xradius\" 3"));
  EXPECT_TRUE(told("\"box\" \"float yradius\" 3"));
  EXPECT_FALSE(told("\"box\""));
  EXPECT_FALSE(told("\"box\" \"float xradius\" 0.5 \"float yradius\" 0.5"));
}

TEST_F(PbrtTest, CornersAreThoseOfWholeFaces) {
  const std::string four = "\"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]";
  const auto mesh = [&](const std::string& text) {
    return std::get<spec::InlineMesh>(shape<spec::MeshBody>(text).surface.value);
  };
  const std::string three = "Shape \"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0]\n";
  EXPECT_EQ(mesh(three).triangles.size(), 1U);
  EXPECT_FALSE(tells("indices")) << told_;
  EXPECT_EQ(mesh("Shape \"trianglemesh\" " + four + " \"integer indices\" [0 1 2 3 2]\n").triangles.size(),
            1U);
  EXPECT_TRUE(tells("a.pbrt:5:1: ")) << told_;
  EXPECT_TRUE(tells("indices after the last complete face of a shape \"trianglemesh\" are dropped")) << told_;
  const std::string five = "\"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0  2 2 0]\n";
  expect_refused(
      {{"four points", kBegin + "Shape \"trianglemesh\" " + four + "\n",
        "a.pbrt:5:1: error: a shape \"trianglemesh\" needs \"indices\" unless it has 3 points (got 4)"},
       {"five points", kBegin + "Shape \"bilinearmesh\" " + five,
        "a.pbrt:5:1: error: a shape \"bilinearmesh\" needs \"indices\" unless it has 4 points (got 5)"},
       {"no points", kBegin + "Shape \"trianglemesh\" \"integer indices\" [0 1 2]\n",
        "a.pbrt:5:1: error: a shape \"trianglemesh\" needs \"P\""}});
}

TEST_F(PbrtTest, PatchesKeepTheirCoordinates) {
  const std::string patch = "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0] ";
  const auto mesh = std::get<spec::InlineMesh>(
      shape<spec::MeshBody>(patch + "\"point2 uv\" [0 0  3 0  0 3  3 3]\n").surface.value);
  EXPECT_EQ(mesh.uv.value().value, (std::vector<std::array<double, 2>>{{0, 0}, {3, 0}, {0, 3}, {3, 3}}));
  EXPECT_EQ(mesh.triangles.size(), 2U);
  (void)shape<test::QuadBody>(patch + "\"point2 uv\" [0 0  1 0  0 1  1 1]\n");
  (void)shape<test::QuadBody>(patch + "\n");
  // Those of a corner, not of a vertex.
  (void)shape<test::QuadBody>(patch + "\"integer indices\" [2 3 0 1] \"point2 uv\" [0 1  1 1  0 0  1 0]\n");
  EXPECT_FALSE(tells("dropped")) << told_;
  (void)shape<test::QuadBody>(patch + "\"point2 uv\" [0 0  3 0  0 3]\n");
  EXPECT_TRUE(tells("texture coordinates whose number differs from that of the points are dropped")) << told_;
}

TEST_F(PbrtTest, WhatImagesSayIsDoneOrTold) {
  put_image("photo.png", false);
  const std::string paint = "\"texture reflectance\"";
  const std::string relief = "\"texture displacement\"";
  const auto image = [&](const std::string& more, const std::string& use) {
    const std::string kind = use == relief ? "float" : "spectrum";
    return scene("Texture \"t\" \"" + kind + "\" \"imagemap\" \"string filename\" \"photo.png\" " + more +
                 "\nMaterial \"diffuse\" " + use + " \"t\"\nShape \"sphere\"\n");
  };
  const auto texture = [&](const std::string& more) {
    return std::get<spec::Texture>(
        std::get<spec::Diffuse>(image(more, paint).materials.at(0).value.model).reflectance);
  };
  EXPECT_TRUE(std::holds_alternative<spec::Weights>(texture("\"string encoding\" \"linear\"").of));
  EXPECT_TRUE(std::holds_alternative<spec::Rgb>(texture("\"string encoding\" \"sRGB\"").of));
  EXPECT_FALSE(tells("encoding")) << told_;
  (void)texture("\"string encoding\" \"gamma 2.2\"");
  EXPECT_TRUE(tells("a gamma encoding of an image is not supported: sRGB is used")) << told_;
  EXPECT_EQ(texture("\"string wrap\" \"black\"").file.mapping.wrap, TextureWrap::clamp);
  EXPECT_TRUE(tells("the wrap mode \"black\" is not supported")) << told_;
  EXPECT_EQ(texture("\"string wrap\" \"clamp\"").file.mapping.wrap, TextureWrap::clamp);
  EXPECT_FALSE(tells("edges")) << told_;
  put_image("photo.png", true);
  (void)image("", relief);
  EXPECT_TRUE(tells("values of a height or normal map are taken as linear")) << told_;
  (void)image("\"string encoding\" \"linear\"", relief);
  EXPECT_FALSE(tells("height or normal map")) << told_;
  expect_refused({{"wrap",
                   kBegin + "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"photo.png\" "
                            "\"string wrap\" \"blak\"\n",
                   "unknown wrap mode \"blak\"; did you mean \"black\"?"}});
}

}  // namespace
}  // namespace abbe
