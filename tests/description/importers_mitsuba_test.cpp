// What scenes of Mitsuba mean where its models or defaults are others than here, and what of them is told.
#include <algorithm>
#include <cmath>

#include "io/exr.h"
#include "materials/interface/fresnel.h"
#include "mitsuba_scenes.h"

namespace abbe {
namespace {

using test::MitsubaTest;
using test::whole;

TEST_F(MitsubaTest, PlasticSendsOutWhatItDoesThere) {
  constexpr double kIndex = 1.5;
  const double r = diffuse_reflectance_inside(kIndex);
  // rho as their model has it: what leaves the coat is rho'/(1 - rho' r) here.
  const auto there = [r](double here) { return here * (1 - r) / (1 - here * r); };
  const auto ground = [&](const std::string& more) {
    return material<spec::CoatedDiffuse>(
               R"(<bsdf type="plastic"><float name="int_ior" value="1.5"/><float name="ext_ior" value="1"/>)" +
               more + "</bsdf>")
        .reflectance;
  };
  const auto number = [&](const std::string& more) {
    return std::get<double>(std::get<spec::Curve>(ground(more)).value);
  };
  EXPECT_NEAR(there(number("")), 0.5, 1e-12);
  EXPECT_NEAR(there(number(R"(<rgb name="diffuse_reflectance" value="0.2"/>)")), 0.2, 1e-12);
  EXPECT_EQ(
      number(R"(<rgb name="diffuse_reflectance" value="0.2"/><boolean name="nonlinear" value="true"/>)"),
      0.2);
  const auto table = [&](const std::string& spectrum) {
    const auto curve = std::get<spec::Curve>(ground(spectrum));
    const auto& said = std::get<spec::TableCurve>(std::get<spec::CurveFormula>(curve.value).of);
    return table_curve(said.wavelength_nm, said.values, said.outside);
  };
  const Curve slope = table(R"(<spectrum name="diffuse_reflectance" value="400:0.1, 700:0.9"/>)");
  for (const double nm : {400.0, 483.0, 550.0, 700.0})
    EXPECT_NEAR(there(slope(nm)), 0.1 + 0.8 * (nm - 400) / 300, 1e-3) << nm;
  EXPECT_EQ(slope(390), 0);
  const LinearRgb red{0.6, 0.1, 0.1};
  const Curve paint = table(R"(<rgb name="diffuse_reflectance" value="0.6, 0.1, 0.1"/>)");
  for (const double nm : {450.0, 600.0, 650.0})
    EXPECT_NEAR(there(paint(nm)), rgb_spectrum(red)(nm), 1e-5) << nm;
  EXPECT_TRUE(tells("a colour does not determine a spectrum")) << told_;
  EXPECT_FALSE(tells("under a clear coat")) << told_;
  write_exr(folder_ / "photo.exr", {1, 1, {{"R", {0.2F}}, {"G", {0.4F}}, {"B", {0.6F}}}, {}});
  const std::string image =
      R"(<texture name="diffuse_reflectance" type="bitmap"><string name="filename" value="photo.exr"/></texture>)";
  EXPECT_TRUE(std::holds_alternative<spec::Texture>(ground(image)));
  EXPECT_TRUE(tells("an image under a clear coat is darker and more saturated than in Mitsuba")) << told_;
  (void)ground(image + R"(<boolean name="nonlinear" value="true"/>)");
  EXPECT_FALSE(tells("under a clear coat")) << told_;
}

// The flux of an intensity that is 1 up to b and falls linearly with the angle to 0 at c, over 2 pi.
double flux_there(double b, double c) {
  constexpr int kSteps = 100000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double a = c * (i + 0.5) / kSteps;
    sum += (a < b ? 1 : (c - a) / (c - b)) * std::sin(a) * c / kSteps;
  }
  return sum;
}

TEST_F(MitsubaTest, SoftSpotsSendOutAsMuch) {
  const spec::Scene made = scene(
      R"(<emitter type="spot"><float name="cutoff_angle" value="60"/><float name="beam_width" value="0"/></emitter>
         <emitter type="spot"/>)");  // of 20 and 15 degrees
  const auto flux = [&](std::size_t i) {
    return 1 - std::cos(std::get<spec::SpotLightSource>(made.lights.at(i).kind).source.half_angle_deg * M_PI /
                        180);
  };
  EXPECT_NEAR(flux(0), flux_there(0, M_PI / 3), 1e-9);
  EXPECT_NEAR(flux(1), flux_there(M_PI / 12, M_PI / 9), 1e-9);
}

TEST_F(MitsubaTest, ViewsAreThoseOf50MillimetresUnlessTold) {
  const auto fov = [&](const std::string& sensor) {
    const auto made =
        convert("a.xml", R"(<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm">
        <integer name="width" value="32"/><integer name="height" value="32"/></film>)" +
                             sensor + "</sensor></scene>");
    if (!made) return 0.0;
    return std::get<spec::FieldOfView>(std::get<spec::PinholeCamera>(made->camera->kind).lens.view).value;
  };
  // The diagonal of 36 mm x 24 mm on a square.
  const double at_50 = 2 * std::atan(std::hypot(36, 24) / std::sqrt(2) / 2 / 50) * 180 / M_PI;
  EXPECT_NEAR(fov(""), at_50, 1e-9);
  EXPECT_NEAR(fov(R"(<string name="focal_length" value="50mm"/>)"), at_50, 1e-9);
  EXPECT_NEAR(fov(R"(<float name="fov" value="40"/>)"), 40, 1e-9);
  EXPECT_EQ(fov(R"(<float name="fov" value="40"/><string name="focal_length" value="50mm"/>)"), 0);
  EXPECT_TRUE(tells("a view takes \"fov\" or \"focal_length\", not both")) << told_;
  EXPECT_EQ(fov(R"(<float name="fov" value="40"/><string name="fov_axis" value="largr"/>)"), 0);
  EXPECT_TRUE(tells("unknown axis \"largr\"; did you mean \"larger\"?")) << told_;
}

TEST_F(MitsubaTest, IntegratorsSayHowDeepPathsGo) {
  const auto depth = [&](const std::string& integrator) {
    return scene(integrator + R"(<shape type="sphere"/>)").render->max_depth;
  };
  EXPECT_FALSE(depth(""));
  EXPECT_FALSE(depth(R"(<integrator type="path"/>)"));
  EXPECT_EQ(depth(R"(<integrator type="volpath"><integer name="max_depth" value="4"/></integrator>)"), 3);
  EXPECT_FALSE(tells("maximum depth")) << told_;
  EXPECT_EQ(depth(R"(<integrator type="direct"><integer name="bsdf_samples" value="2"/></integrator>)"), 1);
  EXPECT_FALSE(tells("integrator")) << told_;
  EXPECT_EQ(depth(R"(<integrator type="prb"/>)"), 5);
  EXPECT_EQ(depth(R"(<integrator type="path"><integer name="max_depth" value="1"/></integrator>)"), 1);
  EXPECT_TRUE(tells("a maximum depth below 1 is not supported")) << told_;
  EXPECT_EQ(depth(R"(<integrator type="aov"><integrator type="direct"/></integrator>)"), 1);
  EXPECT_TRUE(tells("the output of an integrator \"aov\" is not supported: radiance is rendered")) << told_;
  EXPECT_FALSE(convert("a.xml", whole(R"(<integrator type="pat"/>)")));
  EXPECT_TRUE(tells("a.xml:3:2: error: unknown integrator \"pat\"; did you mean \"path\"?")) << told_;
}

TEST_F(MitsubaTest, IntegratorsThatLeaveMediaOutAreTold) {
  const auto told_of = [&](const std::string& integrator) {
    (void)scene(
        integrator +
        R"(<shape type="sphere"><bsdf type="dielectric"/><medium name="interior" type="homogeneous"/></shape>)");
    return tells("ignores media");
  };
  EXPECT_FALSE(told_of("")) << told_;
  for (const std::string type : {"volpath", "volpathmis", "prbvolpath"})
    EXPECT_FALSE(told_of("<integrator type=\"" + type + "\"/>")) << told_;
  for (const std::string type : {"path", "direct", "prb", "ptracer"})
    EXPECT_TRUE(told_of("<integrator type=\"" + type + "\"/>")) << told_;
  EXPECT_FALSE(told_of(R"(<integrator type="moment"><integrator type="volpath"/></integrator>)")) << told_;
  EXPECT_TRUE(told_of(R"(<integrator type="aov"><integrator type="path"/></integrator>)")) << told_;
  (void)scene(R"(<integrator type="path"/><shape type="sphere"/>)");
  EXPECT_FALSE(tells("media")) << told_;
}

TEST_F(MitsubaTest, RawImagesAreLinear) {
  put_image("photo.png", false);
  put_image("photo.exr", false);
  const auto paint = [&](const std::string& file, const std::string& raw) {
    return std::get<spec::Texture>(
        material<spec::Diffuse>(R"(<bsdf type="diffuse"><texture name="reflectance" type="bitmap">
          <string name="filename" value=")" +
                                file + R"("/><boolean name="raw" value=")" + raw + R"("/></texture></bsdf>)")
            .reflectance);
  };
  EXPECT_TRUE(std::get<spec::Rgb>(paint("photo.png", "false").of).value);
  EXPECT_TRUE(std::get<spec::Rgb>(paint("photo.exr", "true").of).value);
  EXPECT_FALSE(tells("a colour does not determine a spectrum")) << told_;
  const auto weights = std::get<spec::Weights>(paint("photo.png", "true").of).value;
  EXPECT_TRUE(tells("a colour does not determine a spectrum")) << told_;
  ASSERT_EQ(weights.size(), 3U);
  const RgbBasis& basis = rgb_basis();
  const auto spectrum = [&](std::size_t i, const std::string& name) {
    EXPECT_EQ(weights[i].name, name);
    const auto& table = std::get<spec::TableCurve>(std::get<spec::CurveFormula>(weights[i].value.value).of);
    return table_curve(table.wavelength_nm, table.values, table.outside);
  };
  for (const double nm : {300.0, 450.0, 550.0, 650.0}) {
    EXPECT_NEAR(spectrum(0, "R")(nm), basis.red(nm), 2e-6) << nm;
    EXPECT_NEAR(spectrum(1, "G")(nm), basis.green(nm), 2e-6) << nm;
    EXPECT_NEAR(spectrum(2, "B")(nm), basis.blue(nm), 2e-6) << nm;
    EXPECT_NEAR(spectrum(0, "R")(nm) + spectrum(1, "G")(nm) + spectrum(2, "B")(nm), 1, 1e-12) << nm;
  }
}

TEST_F(MitsubaTest, WhatImagesSayAndIsNotSoHereIsTold) {
  const auto read = [&](const std::string& wrapper, const std::string& file, const std::string& more = "") {
    return convert("a.xml", whole(R"(<shape type="sphere"><bsdf type=")" + wrapper +
                                  R"("><bsdf type="diffuse"/><texture type="bitmap" name="map">
        <string name="filename" value=")" +
                                  file + "\"/>" + more + "</texture></bsdf></shape>"))
        .has_value();
  };
  for (const std::string wrapper : {"bumpmap", "normalmap"}) {
    put_image("photo.png", wrapper == "bumpmap");
    put_image("photo.exr", wrapper == "bumpmap");
    EXPECT_TRUE(read(wrapper, "photo.png"));
    EXPECT_TRUE(tells("values of a height or normal map are taken as linear")) << told_;
    EXPECT_TRUE(read(wrapper, "photo.exr"));
    EXPECT_FALSE(tells("height or normal map")) << told_;
    EXPECT_TRUE(read(wrapper, "photo.png", R"(<boolean name="raw" value="true"/>)"));
    EXPECT_FALSE(tells("height or normal map")) << told_;
  }
  EXPECT_TRUE(read("normalmap", "photo.exr", R"(<string name="wrap_mode" value="mirror"/>)"));
  EXPECT_TRUE(tells("mirrored repetition of an image is not supported: it repeats")) << told_;
  EXPECT_TRUE(read("normalmap", "photo.exr", R"(<string name="wrap_mode" value="clamp"/>)"));
  EXPECT_FALSE(tells("mirrored repetition")) << told_;
  EXPECT_FALSE(read("normalmap", "photo.exr", R"(<string name="wrap_mode" value="miror"/>)"));
  EXPECT_TRUE(tells("unknown wrap mode \"miror\"; did you mean \"mirror\"?")) << told_;
}

// There a surface says what is on both sides; here what is around is the closed shape it lies in.
TEST_F(MitsubaTest, MatterWithinMatterHasItsOwnIndex) {
  constexpr double kAir = 1.000277;
  const auto index_of = [&](const std::string& type, const std::string& parts, const std::string& around) {
    const spec::Scene made =
        scene("<shape type=\"sphere\"><bsdf type=\"" + type + "\">" + parts + "</bsdf></shape>" + around);
    EXPECT_FALSE(made.materials.empty()) << told_;
    const auto& model = made.materials.at(0).value.model;
    if (const auto* glass = std::get_if<spec::Dielectric>(&model))
      return std::get<double>(glass->ior.ior.value);
    if (const auto* pane = std::get_if<spec::ThinGlass>(&model)) return std::get<double>(pane->ior.ior.value);
    return std::get<double>(std::get<spec::CoatedDiffuse>(model).ior.value);
  };
  const std::string in_water = R"(<string name="ext_ior" value="water"/>)";
  const std::string water =
      R"(<shape type="sphere"><float name="radius" value="2"/><bsdf type="roughdielectric"><float name="int_ior" value="1.33"/></bsdf></shape>)";
  const std::string enclosed = "Abbe takes the exterior medium from the closed shape around the surface";
  const std::string alone =
      "\"ext_ior\" is not the index of another dielectric of the scene: the relative index is kept";
  EXPECT_NEAR(index_of("dielectric", in_water, water), 1.5046 / kAir, 1e-12);
  EXPECT_TRUE(tells(enclosed)) << told_;
  EXPECT_FALSE(tells(alone)) << told_;
  EXPECT_NEAR(index_of("dielectric", R"(<string name="int_ior" value="air"/>)" + in_water, water), 1, 1e-12);
  EXPECT_NEAR(index_of("thindielectric", in_water, water), 1.5046 / kAir, 1e-12);
  EXPECT_NEAR(index_of("plastic", in_water, water), 1.49 / kAir, 1e-12);
  EXPECT_NEAR(index_of("dielectric", in_water, ""), 1.5046 / 1.333, 1e-12);
  EXPECT_TRUE(tells(alone)) << told_;
  EXPECT_FALSE(tells(enclosed)) << told_;
  EXPECT_NEAR(index_of("dielectric", R"(<string name="int_ior" value="water"/>)" + in_water, ""), 1, 1e-12);
  EXPECT_NEAR(index_of("dielectric", R"(<string name="ext_ior" value="vacuum"/>)", water), 1.5046, 1e-12);
  EXPECT_FALSE(tells("ext_ior")) << told_;
}

TEST_F(MitsubaTest, NamesOfDielectricsAreOfAnyCase) {
  const auto index_of = [&](const std::string& name) {
    const auto glass = material<spec::Dielectric>(
        R"(<bsdf type="dielectric"><float name="ext_ior" value="1"/><string name="int_ior" value=")" + name +
        R"("/></bsdf>)");
    return std::get<double>(glass.ior.ior.value);
  };
  EXPECT_EQ(index_of("pet"), 1.575);
  EXPECT_EQ(index_of("BK7"), 1.5046);
  EXPECT_EQ(index_of("Fused Quartz"), 1.458);
}

TEST_F(MitsubaTest, ThinLensesFocusAtTheFarEndUnlessTold) {
  const auto focus = [&](const std::string& parts) {
    const auto made = convert(
        "a.xml",
        R"(<scene version="3.0.0"><sensor type="thinlens"><float name="aperture_radius" value="0.1"/>)" +
            parts + "</sensor></scene>");
    EXPECT_TRUE(made) << told_;
    const auto& lens = std::get<spec::ThinLensCamera>(made->camera->kind).lens;
    return std::get<double>(*lens.focus_distance);
  };
  EXPECT_EQ(focus(""), 1e4);
  EXPECT_EQ(focus(R"(<float name="far_clip" value="50"/>)"), 50);
  EXPECT_EQ(focus(R"(<float name="far_clip" value="50"/><float name="focus_distance" value="3"/>)"), 3);
}

TEST_F(MitsubaTest, ReferencesThatNothingTakesAreTold) {
  const auto made = convert("a.xml", R"(<scene version="3.0.0"><medium type="homogeneous" id="fog"/>
<sensor type="perspective"><ref name="medium" id="fog"/></sensor>
<shape type="sphere"><bsdf type="dielectric"/><ref name="interior" id="fog"/></shape></scene>)");
  ASSERT_TRUE(made) << told_;
  EXPECT_TRUE(tells("a.xml:2:29: warning: \"medium\" of sensor \"perspective\" is not supported: dropped"))
      << told_;
  EXPECT_FALSE(tells("of shape")) << told_;
}

TEST_F(MitsubaTest, ReliefsNeedATexture) {
  for (const std::string wrapper : {"bumpmap", "normalmap"}) {
    EXPECT_FALSE(convert("a.xml", whole("<shape type=\"sphere\"><bsdf type=\"" + wrapper +
                                        "\"><bsdf type=\"diffuse\"/></bsdf></shape>")));
    EXPECT_TRUE(tells("a.xml:3:23: error: \"" + wrapper + "\" needs a nested texture")) << told_;
  }
}

TEST_F(MitsubaTest, WidthsOfFacetsBeyond1AreCut) {
  const auto width = [&](const std::string& said) {
    const auto metal = material<spec::Conductor>(
        R"(<bsdf type="roughconductor"><float name="alpha" value=")" + said + R"("/></bsdf>)");
    return std::get<double>(std::get<spec::Facets>(metal.roughness.value().value).alpha);
  };
  EXPECT_EQ(width("1.5"), 1);
  EXPECT_TRUE(tells("warning: a facet width outside [0, 1] is clamped")) << told_;
  EXPECT_EQ(width("1"), 1);
  EXPECT_FALSE(tells("outside [0, 1]")) << told_;
}

TEST_F(MitsubaTest, FacetsAreOfAKnownDistribution) {
  const auto rough = [](const std::string& distribution) {
    return R"(<bsdf type="roughconductor"><string name="distribution" value=")" + distribution +
           "\"/></bsdf>";
  };
  const auto shape = [&](const std::string& distribution) {
    const auto metal = material<spec::Conductor>(rough(distribution));
    const auto* facets = std::get_if<spec::Facets>(&metal.roughness.value().value);
    return facets ? facets->distribution : FacetShape::ggx;
  };
  EXPECT_EQ(shape("Beckmann"), FacetShape::beckmann);  // in any case there
  EXPECT_EQ(shape("ggx"), FacetShape::ggx);
  EXPECT_FALSE(convert("a.xml", whole("<shape type=\"sphere\">" + rough("phong") + "</shape>")));
  EXPECT_TRUE(tells("error: unknown distribution \"phong\"")) << told_;
}

TEST_F(MitsubaTest, WhatSpectraSayIsUsedOrTold) {
  const spec::Scene made = scene(R"(<emitter type="constant"><spectrum name="radiance" type="uniform">
      <float name="value" value="2"/><float name="wavelength_min" value="500"/></spectrum></emitter>)");
  const auto& emission = std::get<spec::EnvironmentLightSource>(made.lights.at(0).kind).emission;
  EXPECT_EQ(std::get<spec::Illuminant>(emission.spectrum).value, "E");
  EXPECT_NEAR(std::get<spec::Amount<spec::Quantity::luminance>>(emission.scale).value,
              2 * 683.002 * 106.856917101, 1e-3);
  EXPECT_TRUE(tells("\"wavelength_min\" of spectrum \"uniform\" is not supported: dropped")) << told_;
}

// Gold's n and k as colours. By the shares of the three spectra at 450, 550 and 700 nm, worked out from their
// quadratics: (0.01677, 0.00301, 0.98022), (0.00748, 0.97581, 0.01671) and (1, 0, 0).
TEST_F(MitsubaTest, IndicesThatAreColoursHaveTheirSpectra) {
  const auto metal = [&](const std::string& parts) {
    return material<spec::Conductor>(R"(<bsdf type="conductor">)" + parts + "</bsdf>").ior.value;
  };
  const std::string n = R"(<rgb name="eta" value="0.143, 0.375, 1.442"/>)";
  const auto gold = std::get<spec::TableIor>(metal(n + R"(<rgb name="k" value="3.983, 2.386, 1.603"/>)"));
  EXPECT_TRUE(
      tells("a colour does not determine a spectrum: a smooth one with that colour under D65 is used"))
      << told_;
  const Curve gold_n = table_curve(gold.wavelength_nm, gold.n, Outside::clamp);
  const Curve gold_k = table_curve(gold.wavelength_nm, gold.k.value(), Outside::clamp);
  EXPECT_NEAR(gold_n(450), 1.41700, 1e-4);
  EXPECT_NEAR(gold_k(450), 1.64527, 1e-4);
  EXPECT_NEAR(gold_n(550), 0.39109, 1e-4);
  EXPECT_NEAR(gold_k(550), 2.38487, 1e-4);
  EXPECT_NEAR(gold_n(700), 0.143, 1e-5);
  EXPECT_NEAR(gold_k(700), 3.983, 1e-5);
  const auto grey =
      std::get<spec::MetalIor>(metal(R"(<rgb name="eta" value="0.1"/><rgb name="k" value="3, 3, 3"/>)"));
  EXPECT_EQ(grey.n, 0.1);
  EXPECT_EQ(grey.k, 3);
  EXPECT_FALSE(tells("a colour does not determine a spectrum")) << told_;
  const auto least = std::get<spec::TableIor>(metal(R"(<rgb name="eta" value="0, 0.4, 1.4"/>)")).n;
  EXPECT_EQ(*std::ranges::min_element(least), 1e-6) << "an index in a table is above 0";
  EXPECT_EQ(std::get<spec::MetalIor>(metal(R"(<rgb name="k" value="3, 2, 1"/>)")).n, 0) << "as without eta";
}

TEST_F(MitsubaTest, IndicesAreNoLamps) {
  const auto refused = [&](const std::string& eta) {
    return !convert("a.xml",
                    whole(R"(<shape type="sphere"><bsdf type="conductor">)" + eta + "</bsdf></shape>"));
  };
  const std::string told = "n and k are numbers, colours or samples (got the spectrum of a light)";
  for (const char* type : {"d65", "blackbody"}) {
    EXPECT_TRUE(refused(fmt::format(R"(<spectrum name="eta" type="{}"/>)", type)));
    EXPECT_TRUE(tells(told)) << told_;
  }
  EXPECT_TRUE(refused(R"(<rgb name="eta" value="0.1, -0.4, 1.4"/>)"));
  EXPECT_TRUE(tells("n and k must not be negative (got 0.1, -0.4, 1.4)")) << told_;
}

// Where a table of the albedo ends all that is lost is absorbed.
TEST_F(MitsubaTest, BeyondItsTableAnAlbedoIsZero) {
  const auto matter = material<spec::Medium>(R"(<bsdf type="null"/><medium name="interior" type="homogeneous">
      <spectrum name="albedo" value="450:0.5, 650:0.7"/><float name="sigma_t" value="3"/></medium>)");
  const auto curve = [](const spec::Curve& said) {
    const auto& table = std::get<spec::TableCurve>(std::get<spec::CurveFormula>(said.value).of);
    return table_curve(table.wavelength_nm, table.values, table.outside);
  };
  const Curve absorbs = curve(matter.absorption_per_m.value());
  const Curve scatters = curve(matter.scattering.per_m.value());
  for (const double nm : {300.0, 449.99, 450.0, 500.0, 650.0, 650.01, 1100.0})
    EXPECT_NEAR(absorbs(nm) + scatters(nm), 3, 1e-12) << nm;
  EXPECT_NEAR(absorbs(449.99), 3, 1e-12);
  EXPECT_NEAR(absorbs(450), 1.5, 1e-12);
  EXPECT_NEAR(absorbs(550), 1.2, 1e-12);
  EXPECT_NEAR(absorbs(650), 0.9, 1e-12);
  EXPECT_NEAR(absorbs(650.01), 3, 1e-12);
}

TEST_F(MitsubaTest, ASecondSideIsTold) {
  const std::string front = R"(<bsdf type="twosided"><bsdf type="diffuse"/>)";
  (void)material<spec::Diffuse>(front + "</bsdf>");
  EXPECT_FALSE(tells("both sides")) << told_;
  (void)material<spec::Diffuse>(front + R"(<bsdf type="conductor"/></bsdf>)");
  EXPECT_TRUE(tells("different materials on both sides are not supported: that of the back is dropped"))
      << told_;
}

TEST_F(MitsubaTest, MeshesThatAreSmoothedThereAreTold) {
  const std::string flat = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
  const std::string bent = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 1\nf 1 2 3\nf 1 3 4\n";
  const std::string smooth = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
  const auto read = [&](const std::string& mesh, const std::string& more = "") {
    put("m.obj", mesh);
    (void)scene(R"(<shape type="obj"><string name="filename" value="m.obj"/>)" + more + "</shape>");
  };
  const std::string faces = R"(<boolean name="face_normals" value="true"/>)";
  read(bent);
  EXPECT_TRUE(tells("vertex normals are not computed for a mesh file without them")) << told_;
  read(bent, faces);
  EXPECT_FALSE(tells("normals")) << told_;
  read(flat);
  EXPECT_FALSE(tells("normals")) << told_;
  read(smooth);
  EXPECT_FALSE(tells("normals")) << told_;
  read(smooth, faces);
  EXPECT_TRUE(tells("vertex normals of the mesh file are used")) << told_;
}

}  // namespace
}  // namespace abbe
