// Scopes in pbrt files: files, blocks, names, wavelengths and times.
#include <string>
#include <vector>

#include "pbrt_scenes.h"
#include "spectral/curve.h"

namespace abbe {
namespace {

using test::kBegin;
using test::PbrtTest;
using test::SphereBody;

Curve table_of(const spec::Curve& curve) {
  const auto& table = std::get<spec::TableCurve>(std::get<spec::CurveFormula>(curve.value).of);
  return table_curve(table.wavelength_nm, table.values, table.outside);
}

double number_of(const spec::Reflectance& reflectance) {
  return std::get<double>(std::get<spec::Curve>(reflectance).value);
}

TEST_F(PbrtTest, TablesAreZeroBeyondTheirEnds) {
  put("sodium.spd", "589 1\n590 1\n");
  for (const char* spectrum : {"[589 1 590 1]", "\"sodium.spd\""}) {
    SCOPED_TRACE(spectrum);
    const spec::Scene made = scene("LightSource \"infinite\" \"spectrum L\" " + std::string(spectrum) + "\n");
    ASSERT_EQ(made.lights.size(), 1U);
    const auto& sky = std::get<spec::EnvironmentLightSource>(made.lights[0].kind);
    const Curve light = table_of(std::get<spec::Spectrum>(sky.emission.spectrum));
    EXPECT_EQ(light(589.5), 1);
    EXPECT_EQ(light(550), 0);
    EXPECT_EQ(light(600), 0);
  }
  const auto paint = material<spec::Diffuse>("Material \"diffuse\" \"spectrum reflectance\" [500 .8 550 .8]");
  EXPECT_EQ(table_of(std::get<spec::Curve>(paint.reflectance))(499), 0);
  const auto metal =
      material<spec::Conductor>("Material \"conductor\" \"spectrum reflectance\" [600 .8 700 .8]");
  EXPECT_FALSE(tells("the index of the nearer end is used")) << told_;
  const auto& index = std::get<spec::TableIor>(metal.ior.value);
  const Curve k = table_curve(index.wavelength_nm, index.k.value(), Outside::clamp);
  for (const double nm : {400.0, 599.99, 700.01, 900.0}) EXPECT_EQ(k(nm), 0) << nm;
  for (const double nm : {600.0, 650.0, 700.0}) EXPECT_NEAR(k(nm), 4, 1e-12) << nm;
}

TEST_F(PbrtTest, ImportsLeaveWhatHoldsBehindThem) {
  put("part.pbrt",
      "CoordinateSystem \"there\"\nTranslate 1 0 0\nReverseOrientation\nActiveTransform EndTime\n"
      "Attribute \"shape\" \"float radius\" 2\nMakeNamedMaterial \"tin\" \"string type\" \"conductor\"\n"
      "NamedMaterial \"tin\"\nAreaLightSource \"diffuse\"\nShape \"sphere\"\n");
  const std::string behind = "Translate 0 0 3\nShape \"sphere\"\n";
  const auto sphere = [](const spec::Scene& made, std::size_t i) {
    return std::get<SphereBody>(made.shapes.at(i).kind);
  };
  const spec::Scene imported =
      scene("Translate 0 4 0\nImport \"part.pbrt\"\n" + behind + "NamedMaterial \"tin\"");
  ASSERT_EQ(imported.shapes.size(), 2U);
  EXPECT_EQ(sphere(imported, 0).surface.center, Imath::V3d(1, 4, 0));
  EXPECT_EQ(sphere(imported, 0).surface.radius, 2);
  EXPECT_EQ(sphere(imported, 1).surface.center, Imath::V3d(0, 4, 3));
  EXPECT_EQ(sphere(imported, 1).surface.radius, 1);
  EXPECT_EQ(sphere(imported, 1).material.value, "diffuse");
  EXPECT_TRUE(sphere(imported, 0).emission);
  EXPECT_FALSE(sphere(imported, 1).emission);
  const spec::Scene included = scene("Translate 0 4 0\nInclude \"part.pbrt\"\n" + behind);
  EXPECT_EQ(sphere(included, 1).surface.center, Imath::V3d(1, 4, 0));
  EXPECT_EQ(sphere(included, 1).material.value, "tin");

  put("open.pbrt", "AttributeBegin\n");
  put("close.pbrt", "AttributeEnd\n");
  put("half.pbrt", "Shape \"sphere\" \"float radius\"\n");
  expect_refused({{"a block that goes on", kBegin + "Import \"open.pbrt\"\nAttributeEnd\n",
                   "open.pbrt:1:1: error: the block that begins here is not closed"},
                  {"a block of another file", kBegin + "AttributeBegin\nImport \"close.pbrt\"\n",
                   "close.pbrt:1:1: error: AttributeEnd without a matching begin directive"},
                  {"a directive that goes on", kBegin + "Import \"half.pbrt\"\n3\n",
                   "half.pbrt:2:1: error: expected a number of \"float radius\" (got \"\")"},
                  {"its coordinate systems", kBegin + "Import \"part.pbrt\"\nCoordSysTransform \"there\"\n",
                   "a.pbrt:6:1: error: unknown coordinate system \"there\""},
                  {"before the world", "Import \"part.pbrt\"\n" + kBegin,
                   "a.pbrt:1:1: error: an Import before WorldBegin"}});
}

TEST_F(PbrtTest, FilesThatAreReadTwiceTakeTheAttributesAroundThem) {
  put("ball.pbrt", "Material \"diffuse\"\nShape \"sphere\"\n");
  for (const char* word : {"Include", "Import"}) {
    const spec::Scene made =
        scene(fmt::format("AttributeBegin\nAttribute \"material\" \"rgb reflectance\" [.8 .8 .8]\n{0} "
                          "\"ball.pbrt\"\nAttributeEnd\n"
                          "AttributeBegin\nAttribute \"material\" \"rgb reflectance\" [.1 .1 .1]\n{0} "
                          "\"ball.pbrt\"\n{0} \"ball.pbrt\"\n"
                          "AttributeEnd\n",
                          word));
    ASSERT_EQ(made.shapes.size(), 3U);
    std::vector<std::string> names;
    for (const auto& shape : made.shapes) names.push_back(std::get<SphereBody>(shape.kind).material.value);
    EXPECT_EQ(names, (std::vector<std::string>{"diffuse", "diffuse 2", "diffuse 2"})) << word;
    ASSERT_EQ(made.materials.size(), 2U);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_EQ(number_of(std::get<spec::Diffuse>(made.materials[i].value.model).reflectance),
                i == 0 ? 0.8 : 0.1);
  }
}

TEST_F(PbrtTest, ImportsGoOnWithoutTheSystemsAroundThem) {
  for (const char* name : {"here", "camera", "world"}) {
    SCOPED_TRACE(name);
    put("part.pbrt", fmt::format("CoordSysTransform \"{}\"\nShape \"sphere\"\n", name));
    const auto sphere =
        shape<SphereBody>("CoordinateSystem \"here\"\nTranslate 0 4 0\nImport \"part.pbrt\"\n");
    EXPECT_EQ(sphere.surface.center, Imath::V3d(0, 4, 0));
    EXPECT_TRUE(
        tells(fmt::format("part.pbrt:1:1: warning: the coordinate system \"{}\" is not defined in the "
                          "imported file: the directive is ignored",
                          name)))
        << told_;
  }
  put("part.pbrt",
      "CoordinateSystem \"mine\"\nTranslate 1 0 0\nCoordSysTransform \"mine\"\nShape \"sphere\"\n");
  EXPECT_EQ(shape<SphereBody>("Import \"part.pbrt\"\n").surface.center, Imath::V3d(0));
  EXPECT_FALSE(tells("is not defined in the imported file")) << told_;
}

TEST_F(PbrtTest, BlocksOfTransformsAreThoseOfAttributes) {
  const spec::Scene made = scene(
      "TransformBegin\nTranslate 1 0 0\nMaterial \"conductor\"\nActiveTransform EndTime\nTransformEnd\n"
      "Translate 0 2 0\nShape \"sphere\"\n");
  const auto body = std::get<SphereBody>(made.shapes.at(0).kind);
  EXPECT_EQ(body.material.value, "diffuse");
  EXPECT_EQ(body.surface.center, Imath::V3d(0, 2, 0));
}

TEST_F(PbrtTest, AttributesAreOfAllThatTheyName) {
  put_image("photo.png", false);
  const spec::Scene made = scene(
      "Attribute \"texture\" \"float uscale\" 3\nAttribute \"material\" \"float roughness\" 0.25\n"
      "Attribute \"medium\" \"float g\" 0.5\n"
      "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"photo.png\" \"float vscale\" 2\n"
      "MakeNamedMaterial \"tin\" \"string type\" \"conductor\"\n"
      "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\"\n"
      "NamedMaterial \"tin\"\nShape \"sphere\"\n"
      "Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"\n"
      "MediumInterface \"fog\" \"\"\nMaterial \"interface\"\nShape \"sphere\"\n");
  ASSERT_EQ(made.materials.size(), 3U);
  const auto& tin = std::get<spec::Conductor>(made.materials[0].value.model);
  ASSERT_TRUE(tin.roughness);
  EXPECT_EQ(std::get<double>(tin.roughness->value), 0.5);
  const auto& paint = std::get<spec::Diffuse>(made.materials[1].value.model);
  EXPECT_EQ(std::get<spec::Texture>(paint.reflectance).file.mapping.scale, Imath::V2d(3, 2));
  const auto& fog = std::get<spec::Medium>(made.materials[2].value.model);
  ASSERT_TRUE(fog.scattering.phase);
  expect_refused({{"target", kBegin + "Attribute \"banana\" \"float g\" 1\n",
                   "a.pbrt:5:1: error: unknown target of attributes \"banana\""}});
}

TEST_F(PbrtTest, TexturesOfNumbersAndOfSpectraHaveNamesOfTheirOwn) {
  const std::string textures =
      "Texture \"k\" \"spectrum\" \"constant\" \"float value\" 0.2\n"
      "Texture \"k\" \"float\" \"constant\" \"float value\" 0.09\n"
      "Texture \"half\" \"spectrum\" \"scale\" \"texture tex\" \"k\" \"float scale\" 0.5\n";
  EXPECT_EQ(number_of(material<spec::Diffuse>(textures + "Material \"diffuse\" \"texture reflectance\" \"k\"")
                          .reflectance),
            0.2);
  EXPECT_EQ(
      number_of(material<spec::Diffuse>(textures + "Material \"diffuse\" \"texture reflectance\" \"half\"")
                    .reflectance),
      0.1);
  const auto metal =
      material<spec::Conductor>(textures + "Material \"conductor\" \"texture roughness\" \"k\"");
  ASSERT_TRUE(metal.roughness);
  EXPECT_EQ(std::get<double>(metal.roughness->value), 0.3);
  expect_refused(
      {{"no number",
        kBegin + textures + "Material \"conductor\" \"texture roughness\" \"half\"\nShape \"sphere\"\n",
        "error: unknown float texture \"half\""},
       {"kind", kBegin + "Texture \"t\" \"flaot\" \"constant\"\n",
        "a.pbrt:5:1: error: unknown type of texture \"flaot\"; did you mean \"float\"?"}});
}

TEST_F(PbrtTest, TimesOfTheShutterAreTold) {
  const auto told_of = [&](const std::string& times) {
    EXPECT_TRUE(convert("a.pbrt", "Camera \"perspective\" " + times + "\nWorldBegin\n")) << told_;
    return tells("warning: the shutter");
  };
  EXPECT_FALSE(told_of("")) << told_;
  EXPECT_FALSE(told_of("\"float shutteropen\" 0.5 \"float shutterclose\" 1.5")) << told_;
  EXPECT_TRUE(told_of("\"float shutterclose\" 0.5"));
  EXPECT_TRUE(
      tells("a.pbrt:1:1: warning: the shutter is open for 0.5, by which pbrt multiplies the brightness: its "
            "times are dropped"))
      << told_;
  expect_refused({{"never open", "Camera \"perspective\" \"float shutteropen\" 1\nWorldBegin\n",
                   "a.pbrt:1:1: error: the shutter does not open (got 1 and 1)"},
                  {"back in time", "Camera \"perspective\" \"float shutteropen\" 2\nWorldBegin\n",
                   "a.pbrt:1:1: error: the shutter closes before it opens (got 1 and 2)"}});
}

}  // namespace
}  // namespace abbe
