// Checks converted pbrt scenes.
#include "io/exr.h"
#include "pbrt_scenes.h"
#include "spectral/rgb.h"

#include <cmath>

namespace abbe {
namespace {

using test::DiscBody;
using test::kBegin;
using test::PbrtTest;
using test::QuadBody;
using test::SphereBody;

TEST_F(PbrtTest, TransformsApplyTheLastFirst) {
  const auto sphere =
      shape<SphereBody>("Translate 1 2 3\nRotate 90 0 0 1\nScale 2 2 2\nTranslate 1 0 0\nShape \"sphere\"\n")
          .surface;
  EXPECT_LT((sphere.center - Imath::V3d(1, 4, 3)).length(), 1e-12);
  EXPECT_NEAR(sphere.radius, 2, 1e-12);
  // Matrices are column by column: the last four numbers translate.
  const auto moved =
      shape<SphereBody>(
          "Transform [0 1 0 0  -1 0 0 0  0 0 1 0  5 6 7 1]\nTranslate 1 0 0\nShape \"sphere\"\n")
          .surface;
  EXPECT_LT((moved.center - Imath::V3d(5, 7, 7)).length(), 1e-12);
  const auto concatenated =
      shape<SphereBody>(
          "Translate 1 0 0\nCoordinateSystem \"here\"\nIdentity\nCoordSysTransform \"here\"\n"
          "ConcatTransform [1 0 0 0  0 1 0 0  0 0 1 0  0 0 4 1]\nShape \"sphere\"\n")
          .surface;
  EXPECT_LT((concatenated.center - Imath::V3d(1, 0, 4)).length(), 1e-12);
}

TEST_F(PbrtTest, AttributesEndWhereTheirBlockDoes) {
  const spec::Scene made = scene(
      "AttributeBegin\nTranslate 1 0 0\nMaterial \"conductor\"\nShape \"sphere\"\nAttributeEnd\nShape "
      "\"sphere\"\n");
  ASSERT_EQ(made.shapes.size(), 2U);
  const auto& inside = std::get<SphereBody>(made.shapes[0].kind);
  const auto& outside = std::get<SphereBody>(made.shapes[1].kind);
  EXPECT_EQ(inside.surface.center, Imath::V3d(1, 0, 0));
  EXPECT_EQ(outside.surface.center, Imath::V3d(0, 0, 0));
  EXPECT_EQ(inside.material.value, "conductor");
  EXPECT_EQ(outside.material.value, "diffuse");
}

TEST_F(PbrtTest, WhatACameraSeesMirroredIsTurnedRound) {
  const std::string world = "WorldBegin\nTranslate 1 2 3\nShape \"sphere\"\n";
  const auto made = convert("a.pbrt", "LookAt 1 0 -5  1 0 0  0 1 0\nCamera \"perspective\"\n" + world);
  ASSERT_TRUE(made) << told_;
  EXPECT_TRUE(tells("x is negated")) << told_;
  EXPECT_EQ(std::get<SphereBody>(made->shapes[0].kind).surface.center, Imath::V3d(-1, 2, 3));
  const auto& camera = std::get<spec::PinholeCamera>(made->camera->kind);
  EXPECT_EQ(camera.view.from, Imath::V3d(-1, 0, -5));
  EXPECT_EQ(camera.view.to, Imath::V3d(-1, 0, -4));
  EXPECT_EQ(std::get<spec::FieldOfView>(camera.lens.view).value, 90);
  ASSERT_TRUE(scene("Translate 1 2 3\nShape \"sphere\"\n").camera);
  EXPECT_FALSE(tells("x is negated")) << told_;
}

TEST_F(PbrtTest, FrontsAreWherePbrtHasThem) {
  const std::string patch = "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]\n";
  const auto normal = [&](const std::string& before) {
    const auto quad = shape<QuadBody>(before + patch).surface;
    return quad.edge_u.cross(quad.edge_v).z;
  };
  EXPECT_GT(normal(""), 0);
  EXPECT_LT(normal("ReverseOrientation\n"), 0);
  EXPECT_GT(normal("Scale -1 1 1\n"), 0);  // image of the front
  EXPECT_LT(shape<DiscBody>("ReverseOrientation\nShape \"disk\"\n").surface.normal.z, 0);
}

TEST_F(PbrtTest, StretchedShapesBecomeInstancesOrTriangles) {
  const spec::Scene made = scene("Scale 1 2 3\nShape \"sphere\"\n");
  ASSERT_EQ(made.objects.size(), 1U);
  const auto& placed = std::get<spec::Instance>(made.shapes.at(0).kind);
  EXPECT_EQ(std::get<spec::Matrix>(placed.transform.value.at(0)).rows.value,
            (std::vector<double>{1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0}));
  (void)shape<spec::MeshBody>("AreaLightSource \"diffuse\"\nScale 1 2 3\nShape \"sphere\"\n");
  EXPECT_TRUE(tells("replaced by triangles")) << told_;
  const auto file = shape<spec::MeshBody>(
      "Translate 1 0 0\nRotate 90 0 0 1\nScale 2 2 2\nShape \"plymesh\" \"string filename\" "
      "\"square.ply\"\n");
  EXPECT_EQ(std::get<std::string>(file.surface.value), "square.ply");
  ASSERT_EQ(file.transform.size(), 1U);
  EXPECT_NEAR(file.transform[0].scale.value(), 2, 1e-12);
  EXPECT_NEAR(file.transform[0].rotate.value().deg * file.transform[0].rotate.value().axis.z, 90, 1e-9);
  EXPECT_EQ(file.transform[0].translate.value(), Imath::V3d(1, 0, 0));
}

TEST_F(PbrtTest, ImagesLieAsTheyDo) {
  write_exr(folder_ / "photo.exr", {1, 1, {{"R", {0.2F}}, {"G", {0.4F}}, {"B", {0.6F}}}, {}});
  const std::string image =
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"photo.exr\" \"float uscale\" 2 \"float "
      "vdelta\" 0.5\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\"\n";
  const std::string patch = "Shape \"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0]\n";
  const spec::Scene plain = scene(image + patch);
  const auto& file =
      std::get<spec::Texture>((std::get<spec::Diffuse>(plain.materials.at(0).value.model).reflectance)).file;
  EXPECT_EQ(file.image.value, "photo.exr");
  EXPECT_EQ(file.mapping.scale, Imath::V2d(2, 1));
  EXPECT_EQ(file.mapping.offset, Imath::V2d(0, 0.5));
  EXPECT_TRUE(std::holds_alternative<QuadBody>(plain.shapes.at(0).kind));
  // Reversing a parallelogram would also mirror its texture, so it becomes a mesh.
  const auto turned =
      std::get<spec::InlineMesh>(shape<spec::MeshBody>("Scale -1 1 1\n" + image + patch).surface.value);
  EXPECT_EQ(turned.vertices.at(1), (std::array<double, 3>{-1, 0, 0}));
  EXPECT_EQ(turned.uv->value.at(1), (std::array<double, 2>{1, 0}));
  EXPECT_EQ(turned.triangles.at(0), (std::array<std::uint32_t, 3>{0, 2, 1}));
  (void)shape<SphereBody>(image + "Translate 1 0 0\nShape \"sphere\"\n");
  (void)shape<spec::Instance>(image + "Rotate 90 1 0 0\nShape \"sphere\"\n");
  const auto bare = shape<spec::MeshBody>(image + "Shape \"plymesh\" \"string filename\" \"square.ply\"\n");
  EXPECT_EQ(bare.material.value().value, "diffuse without images");
  EXPECT_TRUE(tells("triangles without texture coordinates cannot have an image")) << told_;
}

TEST_F(PbrtTest, ObjectsArePlacedByTheirInstances) {
  const spec::Scene made = scene(
      "ObjectBegin \"ball\"\nTranslate 1 0 0\nShape \"sphere\"\nObjectEnd\n"
      "Translate 0 0 3\nObjectInstance \"ball\"\nScale 1 1 -1\nObjectInstance \"ball\"\n");
  ASSERT_EQ(made.objects.size(), 1U);
  EXPECT_EQ(std::get<SphereBody>(made.objects[0].value.shapes.at(0).kind).surface.center,
            Imath::V3d(1, 0, 0));
  ASSERT_EQ(made.shapes.size(), 2U);
  const auto& second = std::get<spec::Instance>(made.shapes[1].kind);
  EXPECT_EQ(second.of.value, "ball");
  EXPECT_EQ(std::get<spec::Matrix>(second.transform.value.at(0)).rows.value,
            (std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 3}));
}

TEST_F(PbrtTest, Conductors) {
  EXPECT_EQ(std::get<std::string>(
                material<spec::Conductor>(
                    "Material \"conductor\" \"spectrum eta\" \"metal-Ag-eta\" \"spectrum k\" \"metal-Ag-k\"")
                    .ior.value),
            "Ag_Johnson");
  EXPECT_EQ(std::get<std::string>(material<spec::Conductor>("Material \"conductor\"").ior.value),
            "Cu_Johnson");
  const auto rough = material<spec::Conductor>("Material \"conductor\" \"float roughness\" 0.25");
  EXPECT_EQ(std::get<double>(rough.roughness.value().value), 0.5);  // pbrt takes the square root
  const auto plain = material<spec::Conductor>(
      "Material \"conductor\" \"float uroughness\" 0.25 \"float vroughness\" 0.5 \"bool remaproughness\" "
      "false");
  EXPECT_EQ((std::get<std::array<double, 2>>(plain.roughness.value().value)), (std::array{0.25, 0.5}));
  const auto own = material<spec::Conductor>(
      "Material \"conductor\" \"spectrum eta\" [400 1 700 2] \"spectrum k\" [500 3 700 4]");
  const auto& table = std::get<spec::TableIor>(own.ior.value);
  EXPECT_EQ(table.wavelength_nm, (std::vector<double>{400, 500, 700}));
  EXPECT_NEAR(table.n.at(1), 1 + 1.0 / 3, 1e-6);
  EXPECT_EQ(table.k.value(), (std::vector<double>{3, 3, 4}));
}

TEST_F(PbrtTest, DielectricsAndWhatIsWithin) {
  const auto milk = material<spec::Dielectric>(
      "MakeNamedMedium \"milk\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [2 2 "
      "2] "
      "\"float scale\" 10 \"float g\" 0.5\nMediumInterface \"milk\" \"\"\nMaterial \"dielectric\" \"float "
      "eta\" 1.3");
  EXPECT_EQ(std::get<double>(milk.ior.ior.value), 1.3);
  EXPECT_EQ(std::get<double>(milk.ior.absorption_per_m.value().value), 10);
  EXPECT_EQ(std::get<double>(milk.scattering.per_m.value().value), 20);
  EXPECT_EQ(std::get<spec::HenyeyGreenstein>(milk.scattering.phase.value().value).g, 0.5);
  const auto smoked = material<spec::Dielectric>(
      "MakeNamedMedium \"smoke\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 "
      "0 0]\nMediumInterface \"smoke\" \"\"\nMaterial \"dielectric\" \"spectrum eta\" [400 1.53 700 1.51]");
  EXPECT_EQ(std::get<spec::TableIor>(smoked.ior.ior.value).n, (std::vector<double>{1.53, 1.51}));
  EXPECT_EQ(std::get<double>(smoked.ior.absorption_per_m.value().value), 1);
  const auto fog = material<spec::Medium>(
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [1 1 "
      "1]\n"
      "MediumInterface \"fog\" \"\"\nMaterial \"interface\"");
  EXPECT_EQ(std::get<double>(fog.scattering.per_m.value().value), 1);
  const auto glow = material<spec::Medium>(
      "MakeNamedMedium \"glow\" \"string type\" \"homogeneous\" \"blackbody sigma_a\" 3000 \"float scale\" 2 "
      "\"rgb sigma_s\" [1 1 1]\nMediumInterface \"glow\" \"\"\nMaterial \"interface\"");
  const auto& formula = std::get<spec::CurveFormula>(glow.absorption_per_m.value().value).of;
  EXPECT_EQ(std::get<spec::Scaled>(formula).scale, 2);
}

TEST_F(PbrtTest, OtherMaterials) {
  (void)material<spec::ThinGlass>("Material \"thindielectric\"");
  const auto coated = material<spec::CoatedDiffuse>("Material \"coateddiffuse\" \"float eta\" 1.4");
  EXPECT_EQ(std::get<double>(coated.ior.value), 1.4);
  const spec::Scene mixed = scene(
      "MakeNamedMaterial \"a\" \"string type\" \"diffuse\"\nMakeNamedMaterial \"b\" \"string type\" "
      "\"conductor\"\n"
      "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" 0.25\nShape \"sphere\"\n");
  const auto& parts = std::get<spec::Mixture>(mixed.materials.back().value.model).value;
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(std::get<double>(parts[0].weight.value), 0.75);
  EXPECT_EQ(std::get<double>(parts[1].weight.value), 0.25);
  (void)material<spec::Diffuse>("Material \"hair\"");
  EXPECT_TRUE(tells("a material \"hair\" is not supported")) << told_;
}

TEST_F(PbrtTest, ColoursAreUpsampledAndNoted) {
  const auto curve = std::get<spec::Curve>(
      material<spec::Diffuse>("Material \"diffuse\" \"rgb reflectance\" [0.8 0.1 0.1]").reflectance);
  const auto& table = std::get<spec::TableCurve>(std::get<spec::CurveFormula>(curve.value).of);
  const Curve samples = table_curve(table.wavelength_nm, table.values, table.outside);
  EXPECT_NEAR(linear_rgb(samples)[0], 0.8, 1e-3);
  EXPECT_NEAR(linear_rgb(samples)[1], 0.1, 1e-3);
  EXPECT_TRUE(tells("a colour does not determine a spectrum")) << told_;
  EXPECT_EQ(
      std::get<double>(
          std::get<spec::Curve>(
              material<spec::Diffuse>("Material \"diffuse\" \"rgb reflectance\" [0.3 0.3 0.3]").reflectance)
              .value),
      0.3);
  EXPECT_FALSE(tells("a colour does not determine a spectrum")) << told_;
}

TEST_F(PbrtTest, LightsHaveTheStrengthThatPbrtGivesThem) {
  const spec::Scene made = scene(
      "LightSource \"point\" \"blackbody I\" 3000 \"float scale\" 2 \"point3 from\" [1 2 3]\n"
      "LightSource \"distant\" \"float illuminance\" 5 \"point3 from\" [0 1 0] \"point3 to\" [0 0 0]\n"
      "LightSource \"infinite\" \"spectrum L\" \"stdillum-D50\" \"float scale\" 3\n"
      "LightSource \"spot\" \"float coneangle\" 20 \"float conedeltaangle\" 0 \"float power\" 7\n"
      "AreaLightSource \"diffuse\" \"float power\" 11\nShape \"sphere\"\n");
  constexpr double kLm = 683.002;  // of one unit of pbrt
  ASSERT_EQ(made.lights.size(), 4U);
  const auto& point = std::get<spec::PointLightSource>(made.lights[0].kind);
  EXPECT_EQ(point.source.at, Imath::V3d(1, 2, 3));
  EXPECT_EQ(std::get<spec::Blackbody>(point.emission.spectrum).value, 3000);
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::luminous_intensity>>(point.emission.scale).value, 2 * kLm,
              1e-9);
  const auto& beam = std::get<spec::DirectionalLightSource>(made.lights[1].kind);
  EXPECT_EQ(beam.source.towards, Imath::V3d(0, 1, 0));
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::illuminance>>(beam.emission->scale).value, 5 * kLm, 1e-9);
  const auto& sky = std::get<spec::EnvironmentLightSource>(made.lights[2].kind);
  EXPECT_EQ(std::get<spec::Illuminant>(sky.emission.spectrum).value, "D50");
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::luminance>>(sky.emission.scale).value, 3 * kLm, 1e-9);
  const auto& spot = std::get<spec::SpotLightSource>(made.lights[3].kind);
  EXPECT_EQ(spot.source.half_angle_deg, 20);
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::luminous_intensity>>(spot.emission.scale).value,
              7 * kLm / (2 * M_PI * (1 - std::cos(20 * M_PI / 180))), 1e-6);
  const auto& ball = std::get<SphereBody>(made.shapes.at(0).kind);
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::luminous_flux>>(ball.emission->scale).value, 11 * kLm,
              1e-9);
}

// In pbrt each triangle or patch is a light with that power. A ball is one light, and so is a shape that only
// the conversion turns into triangles.
TEST_F(PbrtTest, EachFaceOfAMeshHasThePower) {
  const auto units = [&](const std::string& shape) {
    const spec::Scene made = scene("AreaLightSource \"diffuse\" \"float power\" 100\nShape " + shape + "\n");
    if (made.shapes.empty()) return 0.0;
    const spec::Emission* emission = description::emission_of(made.shapes[0]);
    return std::get<spec::Amount<spec::Quantity::luminous_flux>>(emission->scale).value / 683.002;
  };
  const std::string square = "\"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] ";
  EXPECT_NEAR(units("\"trianglemesh\" " + square + "\"integer indices\" [0 1 2 0 2 3]"), 200, 1e-9);
  EXPECT_FALSE(tells("differ in radiance")) << told_;
  EXPECT_NEAR(units("\"trianglemesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  5 5 0] \"integer indices\" "
                    "[0 1 2  1 3 2  1 3 2]"),
              300, 1e-9);
  EXPECT_TRUE(tells("so that faces of different areas differ in radiance")) << told_;
  const std::string patches = "\"bilinearmesh\" \"point3 P\" [0 0 0  1 0 0  0 1 0  1 1 0  0 2 0  1 2 0] ";
  EXPECT_NEAR(units(patches + "\"integer indices\" [0 1 2 3]"), 100, 1e-9);
  EXPECT_NEAR(units(patches + "\"integer indices\" [0 1 2 3  2 3 4 5]"), 200, 1e-9);
  EXPECT_NEAR(units("\"sphere\""), 100, 1e-9);
  EXPECT_NEAR(units("\"cylinder\""), 100, 1e-9);
  EXPECT_FALSE(tells("differ in radiance")) << told_;
  EXPECT_NEAR(units("\"plymesh\" \"string filename\" \"square.ply\""), 200, 1e-9);
  EXPECT_TRUE(tells("counts as two triangles in Abbe")) << told_;
}

TEST_F(PbrtTest, SoftSpotsSendOutAsMuch) {
  const auto spot = std::get<spec::SpotLightSource>(
      scene("LightSource \"spot\" \"float coneangle\" 60 \"float conedeltaangle\" 60\n").lights.at(0).kind);
  EXPECT_NEAR(std::cos(spot.source.half_angle_deg * M_PI / 180), 0.75, 1e-12);  // between 1 and 1/2
  EXPECT_TRUE(tells("soft edge")) << told_;
}

TEST_F(PbrtTest, PictureAndRender) {
  const auto made = convert(
      "a.pbrt",
      "Film \"spectral\" \"integer xresolution\" 40 \"integer yresolution\" 20 \"float lambdamin\" 400 "
      "\"float lambdamax\" 700 \"integer nbuckets\" 30 \"string filename\" \"x.exr\"\n"
      "Sampler \"halton\" \"integer pixelsamples\" 8\nIntegrator \"volpath\" \"integer maxdepth\" 9\n"
      "Scale -1 1 1\nCamera \"perspective\" \"float fov\" 30 \"float lensradius\" 0.1 \"float "
      "focaldistance\" 4\nWorldBegin\n");
  ASSERT_TRUE(made) << told_;
  EXPECT_EQ(made->sensor->resolution->value, (std::array<std::int64_t, 2>{40, 20}));
  EXPECT_EQ(std::get<spec::Bins>(made->sensor->counts).step_nm, 10);
  EXPECT_EQ(made->render->samples, 8);
  EXPECT_EQ(made->render->max_depth, 9);
  EXPECT_EQ(made->output->image, "x.exr");
  const auto capitals = convert("a.pbrt", "Film \"rgb\" \"string filename\" \"X.EXR\"\nWorldBegin\n");
  ASSERT_TRUE(capitals) << told_;
  EXPECT_EQ(capitals->output->image, "X.EXR");
  const auto& camera = std::get<spec::ThinLensCamera>(made->camera->kind);
  const double f = camera.lens.focal_length;
  EXPECT_NEAR(f / camera.lens.aperture.f_number.value() / 2, 0.1, 1e-12);
  EXPECT_EQ(std::get<double>(camera.lens.focus_distance.value()), 4);
}

TEST_F(PbrtTest, UnusedParametersAreNoted) {
  (void)scene("Shape \"sphere\" \"float alpha\" 0.5\nShape \"sphere\" \"float alpha\" 0.5\n");
  EXPECT_TRUE(tells("a.pbrt:5:")) << told_;
  EXPECT_TRUE(tells("\"alpha\" of shape \"sphere\" is not supported: dropped (2 times)")) << told_;
}

TEST_F(PbrtTest, ReadsIncludedFiles) {
  put("more.pbrt", "Translate 1 0 0 # and back\nShape \"sphere\"\n");
  EXPECT_EQ(scene("Include \"more.pbrt\"\nShape \"sphere\"\n").shapes.size(), 2U);
  put("loop.pbrt", "Include \"loop.pbrt\"\n");
  expect_refused({{"files without end", kBegin + "Include \"loop.pbrt\"\n",
                   "loop.pbrt:1:1: error: files are included more than 64 levels deep"}});
}

TEST_F(PbrtTest, FaultsHaveTheirPlace) {
  expect_refused({
      {"nothing", "", "a.pbrt"},
      {"before the world", "Camera \"perspective\"\n", "a.pbrt:2:1: error: the file ends before WorldBegin"},
      {"directive", kBegin + "Shaep \"sphere\"\n",
       "a.pbrt:5:1: error: unknown directive \"Shaep\"; did you mean \"Shape\"?"},
      {"shape", kBegin + "Shape \"spere\"\n",
       "a.pbrt:5:1: error: unknown shape \"spere\"; did you mean \"sphere\"?"},
      {"material", kBegin + "Material \"difuse\"\nShape \"sphere\"\n",
       "a.pbrt:5:1: error: unknown material \"difuse\"; did you mean \"diffuse\"?"},
      {"named material", kBegin + "NamedMaterial \"a\"\n", "a.pbrt:5:1: error: unknown material \"a\""},
      {"texture", kBegin + "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n",
       "a.pbrt:5:20: error: unknown spectrum texture \"t\""},
      {"value", kBegin + "Shape \"sphere\" \"float radius\" x\n",
       "a.pbrt:5:31: error: expected a number of \"float radius\" (got \"x\")"},
      {"type", kBegin + "Shape \"sphere\" \"string radius\" \"x\"\n",
       "a.pbrt:5:16: error: \"radius\" has a wrong type (got string, allowed float)"},
      {"unknown type", kBegin + "Shape \"sphere\" \"flaot radius\" 1\n",
       "a.pbrt:5:16: error: unknown type of parameter \"flaot\"; did you mean \"float\"?"},
      {"integer", "Film \"rgb\" \"integer xresolution\" 1.5\n", "a.pbrt:1:34: error: expected an integer"},
      {"pairs", kBegin + "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1]\n",
       "takes multiples of 3 values (got 4)"},
      {"corner",
       kBegin + "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 3]\n",
       "an index is out of range (got 3, allowed [0, 2])"},
      {"numbers", "LookAt 0 0 0 1 0\n", "a.pbrt:2:1: error: the file ends within LookAt"},
      {"bracket", kBegin + "Shape \"sphere\" \"float radius\" [1\n",
       "error: the values of \"radius\" have no closing ]"},
      {"quote", kBegin + "Shape \"sphere\n", "a.pbrt:5:7: error: a quoted text without its closing quote"},
      {"block", kBegin + "AttributeBegin\n", "a.pbrt:5:1: error: the block that begins here is not closed"},
      {"block's end", kBegin + "AttributeEnd\n",
       "a.pbrt:5:1: error: AttributeEnd without a matching begin directive"},
      {"object", kBegin + "ObjectInstance \"o\"\n", "a.pbrt:5:1: error: unknown object \"o\""},
      {"include", kBegin + "Include \"gone.pbrt\"\n", "a.pbrt:5:1: error: "},
      {"mesh", kBegin + "Shape \"plymesh\" \"string filename\" \"gone.ply\"\n", "a.pbrt:5:17: error: "},
      {"spectrum", kBegin + "Material \"diffuse\" \"spectrum reflectance\" [500 1 400 1]\nShape \"sphere\"\n",
       "a.pbrt:5:20: error: wavelengths must ascend (got 400 nm after 500 nm)"},
      {"no matrix", kBegin + "Transform [0 0 0 0 0 0 0 0 0 0 0 0 0 0 0 1]\n",
       "a.pbrt:5:1: error: a matrix is singular"},
  });
  put("cut.ply", "ply\nformat ascii 1.0\nelement vertex 4\n");
  expect_refused({{"cut mesh", kBegin + "Shape \"plymesh\" \"string filename\" \"cut.ply\"\n",
                   "a.pbrt:5:17: error: mesh"}});
  put("bad.spd", "# a comment\n400 1\n500\n");
  expect_refused({{"spectrum file",
                   kBegin + "Material \"diffuse\" \"spectrum reflectance\" \"bad.spd\"\nShape \"sphere\"\n",
                   "bad.spd:3:1: error: expected a wavelength and a value"}});
}

TEST_F(PbrtTest, MaterialsAreReplacedByName) {
  const std::string text = kBegin +
                           "MakeNamedMaterial \"glass\" \"string type\" \"dielectric\"\nNamedMaterial "
                           "\"glass\"\nShape \"sphere\"\n";
  const auto made = convert("a.pbrt", text, R"({"glass": {"dielectric": {"ior": "N-SF11"}}})");
  ASSERT_TRUE(made) << told_;
  EXPECT_EQ(
      std::get<std::string>(std::get<spec::Dielectric>(made->materials.at(0).value.model).ior.ior.value),
      "N-SF11");
  EXPECT_FALSE(convert("a.pbrt", text, R"({"glas": {"dielectric": {"ior": "N-SF11"}}})"));
  EXPECT_TRUE(tells("materials.json:1:")) << told_;
  EXPECT_TRUE(tells("unknown material \"glas\"; did you mean \"glass\"?")) << told_;
}

TEST_F(PbrtTest, PrefixesOfAFileCrashNothing) {
  expect_no_crash_at_any_prefix(
      "a.pbrt",
      kBegin +
          "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.1 .2 .3]\nAttributeBegin\nRotate 5 0 1 0\n"
          "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"trianglemesh\" \"point3 P\" [0 0 0  1 "
          "0 0  0 1 0]\n"
          "AttributeEnd\nLightSource \"infinite\" \"rgb L\" [1 1 1] # sky\nShape \"plymesh\" \"string "
          "filename\" \"square.ply\"\n");
}

}  // namespace
}  // namespace abbe
