// Checks converted Mitsuba scenes.
#include <cmath>

#include "io/exr.h"
#include "mitsuba_scenes.h"
#include "scene/lights/infinite_light.h"

namespace abbe {
namespace {

using test::DoorFault;
using test::MitsubaTest;
using test::QuadBody;
using test::SphereBody;
using test::whole;

TEST_F(MitsubaTest, TransformsApplyTheFirstFirst) {
  const auto sphere =
      shape<SphereBody>(
          R"(<shape type="sphere"><transform name="to_world"><translate x="1"/><scale value="2"/><rotate z="1" angle="90"/>)"
          R"(<matrix value="1 0 0 5  0 1 0 0  0 0 1 0  0 0 0 1"/></transform></shape>)")
          .surface;
  EXPECT_LT((sphere.center - Imath::V3d(5, 2, 0)).length(), 1e-12);
  EXPECT_NEAR(sphere.radius, 2, 1e-12);
  const auto quad =
      shape<QuadBody>(
          R"(<shape type="rectangle"><transform name="to_world"><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/></transform></shape>)")
          .surface;
  EXPECT_LT((quad.edge_u.cross(quad.edge_v) - Imath::V3d(0, 0, -4)).length(), 1e-12);
}

TEST_F(MitsubaTest, CamerasLookAlongZWithXToTheLeft) {
  const spec::Scene made = scene("");
  const auto& camera = std::get<spec::PinholeCamera>(made.camera->kind);
  EXPECT_EQ(camera.view.to, Imath::V3d(0, 0, 1));
  EXPECT_FALSE(tells("x is negated")) << told_;
  // 40 degrees along 768 pixels, so a smaller angle along 576.
  EXPECT_NEAR(std::get<spec::FieldOfView>(camera.lens.view).value,
              2 * std::atan(std::tan(20 * M_PI / 180) * 576 / 768) * 180 / M_PI, 1e-9);
  const auto mirrored = convert(
      "a.xml",
      R"(<scene version="3.0.0"><sensor type="perspective"><transform name="to_world"><scale x="-1"/></transform></sensor>
      <shape type="sphere"><point name="center" x="1" y="0" z="5"/></shape></scene>)");
  ASSERT_TRUE(mirrored) << told_;
  EXPECT_TRUE(tells("x is negated")) << told_;
  EXPECT_EQ(std::get<SphereBody>(mirrored->shapes.at(0).kind).surface.center, Imath::V3d(-1, 0, 5));
}

TEST_F(MitsubaTest, ThinLensesAndFilms) {
  const auto made = convert(
      "a.xml",
      R"(<scene version="3.0.0"><default name="n" value="7"/><integrator type="path"><integer name="max_depth" value="4"/></integrator>
      <sensor type="thinlens"><float name="fov" value="30"/><string name="fov_axis" value="y"/><float name="aperture_radius" value="0.1"/><float name="focus_distance" value="4"/>
      <sampler type="independent"><integer name="sample_count" value="$n"/></sampler><film type="hdrfilm"><integer name="width" value="40"/><integer name="height" value="20"/><rfilter type="gaussian"/></film></sensor></scene>)");
  ASSERT_TRUE(made) << told_;
  EXPECT_EQ(made->render->samples, 7);
  EXPECT_EQ(made->render->max_depth, 3);  // Mitsuba counts the light as a vertex
  EXPECT_EQ(made->sensor->resolution->value, (std::array<std::int64_t, 2>{40, 20}));
  const auto& lens = std::get<spec::ThinLensCamera>(made->camera->kind).lens;
  EXPECT_NEAR(lens.focal_length / lens.aperture.f_number.value() / 2, 0.1, 1e-12);
  EXPECT_TRUE(tells("pixel filters are not supported")) << told_;
}

TEST_F(MitsubaTest, Shapes) {
  const auto box = std::get<spec::InlineMesh>(shape<spec::MeshBody>(R"(<shape type="cube"/>)").surface.value);
  EXPECT_EQ(box.triangles.size(), 12U);
  double volume = 0;  // positive if every triangle faces outwards
  for (const auto& t : box.triangles) {
    const auto at = [&](int i) {
      const auto& v = box.vertices[t[static_cast<std::size_t>(i)]];
      return Imath::V3d(v[0], v[1], v[2]);
    };
    volume += at(0).dot(at(1).cross(at(2))) / 6;
    EXPECT_GT(at(0).dot((at(1) - at(0)).cross(at(2) - at(0))), 0);
  }
  EXPECT_NEAR(volume, 8, 1e-12);
  const auto tube =
      shape<spec::SolidBody<spec::Cylinder>>(
          R"(<shape type="cylinder"><point name="p0" x="1"/><point name="p1" x="4"/><float name="radius" value="2"/></shape>)")
          .surface;
  EXPECT_EQ(tube.from, Imath::V3d(1, 0, 0));
  EXPECT_EQ(tube.to, Imath::V3d(4, 0, 0));
  EXPECT_EQ(tube.radius, 2);
  EXPECT_FALSE(tube.caps);
  const auto file =
      shape<spec::MeshBody>(R"(<shape type="ply"><string name="filename" value="square.ply"/></shape>)");
  EXPECT_EQ(std::get<std::string>(file.surface.value), "square.ply");
  const auto flipped =
      shape<QuadBody>(R"(<shape type="rectangle"><boolean name="flip_normals" value="true"/></shape>)")
          .surface;
  EXPECT_LT(flipped.edge_u.cross(flipped.edge_v).z, 0);
}

TEST_F(MitsubaTest, GroupsArePlacedByTheirInstances) {
  const spec::Scene made = scene(R"(<shape type="shapegroup" id="g"><shape type="sphere"/></shape>
         <shape type="instance"><ref id="g"/><transform name="to_world"><translate x="3"/></transform></shape>)");
  ASSERT_EQ(made.objects.size(), 1U);
  ASSERT_EQ(made.shapes.size(), 1U);
  EXPECT_EQ(std::get<spec::Instance>(made.shapes[0].kind).of.value, "g");
}

TEST_F(MitsubaTest, Materials) {
  EXPECT_EQ(
      std::get<std::string>(material<spec::Conductor>(
                                R"(<bsdf type="roughconductor"><string name="material" value="Au"/></bsdf>)")
                                .ior.value),
      "Au_Johnson");
  EXPECT_EQ(std::get<spec::MetalIor>(material<spec::Conductor>(R"(<bsdf type="conductor"/>)").ior.value).n,
            0);  // the perfect mirror
  const auto rough =
      material<spec::Conductor>(R"(<bsdf type="roughconductor"><float name="alpha" value="0.3"/></bsdf>)");
  const auto& facets = std::get<spec::Facets>(rough.roughness.value().value);
  EXPECT_EQ(std::get<double>(facets.alpha), 0.3);
  EXPECT_EQ(facets.distribution, FacetShape::beckmann);  // Mitsuba's default
  EXPECT_NEAR(
      std::get<double>(
          material<spec::Dielectric>(
              R"(<bsdf type="dielectric"><string name="int_ior" value="water"/><float name="ext_ior" value="1"/></bsdf>)")
              .ior.ior.value),
      1.333, 1e-12);
  EXPECT_NEAR(std::get<double>(material<spec::CoatedDiffuse>(
                                   R"(<bsdf type="plastic"><float name="ext_ior" value="1"/></bsdf>)")
                                   .ior.value),
              1.49, 1e-12);
  (void)material<spec::ThinGlass>(R"(<bsdf type="thindielectric"/>)");
  EXPECT_EQ(
      material<spec::Principled>(R"(<bsdf type="principled"><float name="metallic" value="0.7"/></bsdf>)")
          .metallic,
      0.7);
  (void)material<spec::Diffuse>(R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)");
  (void)material<spec::Diffuse>(
      R"(<bsdf type="mask"><float name="opacity" value="0.5"/><bsdf type="diffuse"/></bsdf>)");
  EXPECT_TRUE(tells("opacity is dropped")) << told_;
  const auto milk = material<spec::Dielectric>(
      R"(<bsdf type="dielectric"/><medium name="interior" type="homogeneous"><float name="albedo" value="0.75"/><float name="sigma_t" value="4"/><phase type="hg"><float name="g" value="0.2"/></phase></medium>)");
  EXPECT_EQ(std::get<double>(milk.ior.absorption_per_m.value().value), 1);
  EXPECT_EQ(std::get<double>(milk.scattering.per_m.value().value), 3);
  EXPECT_EQ(std::get<spec::HenyeyGreenstein>(milk.scattering.phase.value().value).g, 0.2);
  const spec::Scene blend = scene(
      R"(<shape type="sphere"><bsdf type="blendbsdf"><float name="weight" value="0.25"/><bsdf type="diffuse"/><bsdf type="conductor"/></bsdf></shape>)");
  EXPECT_EQ(
      std::get<double>(std::get<spec::Mixture>(blend.materials.back().value.model).value.at(1).weight.value),
      0.25);
}

TEST_F(MitsubaTest, Lights) {
  const spec::Scene made = scene(
      R"(<emitter type="point"><rgb name="intensity" value="2"/><point name="position" x="1" y="2" z="3"/></emitter>
         <emitter type="directional"><vector name="direction" x="0" y="-1" z="0"/><spectrum name="irradiance" value="400:1, 700:2"/></emitter>
         <emitter type="constant"><spectrum name="radiance" type="blackbody"><float name="temperature" value="4000"/></spectrum></emitter>
         <emitter type="spot"><float name="cutoff_angle" value="30"/><float name="beam_width" value="30"/></emitter>)");
  constexpr double kWhite = 683.002 * 106.856917101;  // for a colour (1, 1, 1): the integral of the CIE y
  ASSERT_EQ(made.lights.size(), 4U);
  const auto& point = std::get<spec::PointLightSource>(made.lights[0].kind);
  EXPECT_EQ(point.source.at, Imath::V3d(1, 2, 3));
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::luminous_intensity>>(point.emission.scale).value,
              2 * kWhite, 1e-3);
  const auto& beam = std::get<spec::DirectionalLightSource>(made.lights[1].kind);
  EXPECT_EQ(beam.source.towards, Imath::V3d(0, 1, 0));
  EXPECT_TRUE(std::holds_alternative<std::monostate>(beam.emission->scale));
  EXPECT_EQ(std::get<spec::TableCurve>(
                std::get<spec::CurveFormula>(std::get<spec::Spectrum>(beam.emission->spectrum).value).of)
                .values,
            (std::vector<double>{1, 2}));
  EXPECT_EQ(
      std::get<spec::Blackbody>(std::get<spec::EnvironmentLightSource>(made.lights[2].kind).emission.spectrum)
          .value,
      4000);
  EXPECT_EQ(std::get<spec::SpotLightSource>(made.lights[3].kind).source.half_angle_deg, 30);
}

TEST_F(MitsubaTest, ImagesLieAsTheyDo) {
  write_exr(folder_ / "photo.exr", {1, 1, {{"R", {0.2F}}, {"G", {0.4F}}, {"B", {0.6F}}}, {}});
  put("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  const auto mapping = [&](const std::string& shape) {
    const spec::Scene made = scene(
        "<shape " + shape +
        R"(<bsdf type="diffuse"><texture name="reflectance" type="bitmap"><string name="filename" value="photo.exr"/>
        <transform name="to_uv"><scale x="2" y="4"/><translate x="0.5" y="0.25"/></transform></texture></bsdf></shape>)");
    const auto& paint = std::get<spec::Diffuse>(made.materials.at(0).value.model);
    return std::get<spec::Texture>(paint.reflectance).file.mapping;
  };
  // Rows of the rectangle increase downwards with v, so the mapping is 1 - (4 v + 0.25).
  EXPECT_EQ(mapping(R"(type="rectangle">)").scale, Imath::V2d(2, -4));
  EXPECT_EQ(mapping(R"(type="rectangle">)").offset, Imath::V2d(0.5, 0.75));
  // Mitsuba reverses v of the file: 1 - (4 (1 - v) + 0.25).
  const std::string obj = R"(type="obj"><string name="filename" value="t.obj"/>)";
  EXPECT_EQ(mapping(obj).scale, Imath::V2d(2, 4));
  EXPECT_EQ(mapping(obj).offset, Imath::V2d(0.5, -3.25));
  EXPECT_EQ(mapping(R"(type="sphere">)").scale, Imath::V2d(2, 4));
}

TEST_F(MitsubaTest, SkiesHaveTheirMiddleAlongZ) {
  write_exr(folder_ / "sky.exr", {2, 1, {{"R", {1, 2}}, {"G", {1, 2}}, {"B", {1, 2}}}, {}});
  const auto frame = [&](const std::string& transform) {
    const spec::Scene made = scene(R"(<emitter type="envmap"><string name="filename" value="sky.exr"/>)" +
                                   transform + "</emitter>");
    const auto& image = std::get<spec::EnvironmentImage>(
        std::get<spec::EnvironmentLightSource>(made.lights.at(0).kind).source.image);
    return environment_frame(image.up.normalized(), image.rotate_deg);
  };
  EXPECT_LT((frame("").up - Imath::V3d(0, 1, 0)).length(), 1e-12);
  EXPECT_LT((frame("").forward - Imath::V3d(0, 0, 1)).length(), 1e-12);
  const auto turned =
      frame(R"(<transform name="to_world"><rotate x="1" angle="90"/><rotate z="1" angle="30"/></transform>)");
  EXPECT_LT((turned.up - Imath::V3d(0, 0, 1)).length(), 1e-12);
  EXPECT_LT((turned.forward - Imath::V3d(0.5, -std::sqrt(0.75), 0)).length(), 1e-12);
}

TEST_F(MitsubaTest, ReadsIncludedFiles) {
  put("more.xml", R"(<scene version="3.0.0"><bsdf type="diffuse" id="b"/></scene>)");
  EXPECT_EQ(scene(R"(<include filename="more.xml"/><shape type="sphere"><ref id="b"/></shape>)")
                .materials.at(0)
                .name,
            "b");
  put("loop.xml", R"(<scene version="3.0.0"><include filename="loop.xml"/></scene>)");
  EXPECT_FALSE(convert("a.xml", whole(R"(<include filename="loop.xml"/>)")));
  EXPECT_TRUE(tells("nested deeper than 64")) << told_;
}

TEST_F(MitsubaTest, FaultsHaveTheirPlace) {
  const std::vector<DoorFault> faults{
      {"truncated", "<scene>\n<sensor type=\"perspective\">\n", "a.xml:2:28: error: malformed XML"},
      {"no scene", "<sense/>", "a.xml:1:2: error: expected <scene> (got <sense>)"},
      {"sensor", "<scene/>", "a.xml:1:2: error: the scene has no sensor"},
      {"sensor's type", "<scene><sensor type=\"perspectiv\"/></scene>",
       "unknown sensor \"perspectiv\"; did you mean \"perspective\"?"},
      {"shape", whole("<shape type=\"spere\"/>"),
       "a.xml:3:2: error: unknown shape \"spere\"; did you mean \"sphere\"?"},
      {"material", whole("<shape type=\"sphere\">\n<bsdf type=\"difuse\"/></shape>"),
       "a.xml:4:2: error: unknown bsdf \"difuse\"; did you mean \"diffuse\"?"},
      {"emitter", whole("<emitter type=\"pont\"/>"),
       "a.xml:3:2: error: unknown emitter \"pont\"; did you mean \"point\"?"},
      {"reference", whole("<shape type=\"sphere\"><ref id=\"b\"/></shape><bsdf type=\"diffuse\" id=\"b\"/>"),
       "a.xml:3:23: error: unknown reference \"b\""},
      {"itself",
       whole("<bsdf type=\"twosided\" id=\"b\"><ref id=\"b\"/></bsdf><shape type=\"sphere\"><ref "
             "id=\"b\"/></shape>"),
       "a.xml:3:31: error: unknown reference \"b\""},
      {"number", whole("<shape type=\"sphere\"><float name=\"radius\" value=\"x\"/></shape>"),
       "a.xml:3:23: error: expected a number as \"value\" of <float> (got \"x\")"},
      {"empty number", whole("<shape type=\"sphere\"><float name=\"radius\" value=\"\"/></shape>"),
       "a.xml:3:23: error: expected a number as \"value\" of <float> (got \"\")"},
      {"coordinate", whole("<shape type=\"sphere\"><point name=\"center\" x=\"1\" y=\"\"/></shape>"),
       "a.xml:3:23: error: expected a number as \"y\" of <point> (got \"\")"},
      {"vector", whole("<shape type=\"sphere\"><point name=\"center\" value=\"\"/></shape>"),
       "a.xml:3:23: error: expected one number or three of <point> (got \"\")"},
      {"type", whole("<shape type=\"sphere\"><string name=\"radius\" value=\"1\"/></shape>"),
       "\"radius\" has a wrong type (got <string>, allowed float, integer)"},
      {"default", whole("<shape type=\"$what\"/>"),
       "a.xml:3:2: error: no <default> gives a value to \"$what\""},
      {"mesh", whole("<shape type=\"ply\"><string name=\"filename\" value=\"gone.ply\"/></shape>"),
       "a.xml:3:2: error: "},
      {"serialized", whole("<shape type=\"serialized\"/>"), "serialized meshes of Mitsuba are not supported"},
      {"include", whole("<include filename=\"gone.xml\"/>"), "a.xml:3:2: error: "},
      {"metal",
       whole("<shape type=\"sphere\"><bsdf type=\"conductor\"><string name=\"material\" "
             "value=\"Xx\"/></bsdf></shape>"),
       "unknown metal \"Xx\""},
      {"pairs",
       whole("<emitter type=\"constant\"><spectrum name=\"radiance\" value=\"400:1, 500\"/></emitter>"),
       "expected pairs wavelength:value"},
      {"step",
       whole("<shape type=\"sphere\"><transform name=\"to_world\"><rotat z=\"1\"/></transform></shape>"),
       "unknown step of a transform \"rotat\"; did you mean \"rotate\"?"},
      {"same id", whole("<bsdf type=\"diffuse\" id=\"b\"/><bsdf type=\"diffuse\" id=\"b\"/>"),
       "duplicate id \"b\""},
  };
  for (const DoorFault& fault : faults) {
    SCOPED_TRACE(fault.what);
    EXPECT_FALSE(convert("a.xml", fault.text));
    EXPECT_TRUE(tells(fault.message)) << told_ << "lacks " << fault.message;
  }
}

TEST_F(MitsubaTest, IncludesHaveALimitInAll) {
  put("x0.xml", "<scene/>");
  for (int i = 1; i <= 15; ++i) {
    const std::string before = "<include filename='x" + std::to_string(i - 1) + ".xml'/>";
    put("x" + std::to_string(i) + ".xml", "<scene>" + before + before + "</scene>");
  }
  EXPECT_FALSE(convert("a.xml", "<scene><include filename='x15.xml'/></scene>"));
  EXPECT_TRUE(tells("error: more than 10000 files are included")) << told_;
  EXPECT_EQ(code_, ErrorCode::resource);
}

TEST_F(MitsubaTest, PrefixesOfAFileCrashNothing) {
  expect_no_crash_at_any_prefix(
      "a.xml",
      whole(
          R"(<default name="r" value="2"/><bsdf type="diffuse" id="b"><rgb name="reflectance" value="0.2, 0.3, 0.4"/></bsdf>
<shape type="sphere"><float name="radius" value="$r"/><ref id="b"/></shape>
<emitter type="constant"><spectrum name="radiance" value="400:1, 500:2"/></emitter>)"));
}

TEST_F(MitsubaTest, ClipPlanesThatCutOffMoreThanUsualAreTold) {
  for (const auto& [planes, told] :
       {std::pair{"", ""},
        {R"(<float name="near_clip" value="0.01"/>)", ""},
        {R"(<float name="near_clip" value="4"/>)", "nearer than 4 or farther than 10000"},
        {R"(<float name="far_clip" value="8"/>)", "nearer than 0.01 or farther than 8"}}) {
    SCOPED_TRACE(planes);
    EXPECT_TRUE(convert(
        "a.xml", R"(<scene version="3.0.0"><sensor type="perspective"><float name="fov" value="40"/>)" +
                     std::string(planes) + "</sensor></scene>"))
        << told_;
    EXPECT_EQ(tells("clip planes are not supported"), *told != 0) << told_;
    EXPECT_TRUE(tells(told)) << told_;
  }
}

}  // namespace
}  // namespace abbe
