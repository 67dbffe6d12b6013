// What scenes of Mitsuba mean where its models or defaults are others than here, and what of them is told.
#include <cmath>

#include "io/exr.h"
#include "materials/interface/hemispherical.h"
#include "mitsuba_scenes.h"

namespace abbe {
namespace {

using test::MitsubaTest;

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
  EXPECT_TRUE(tells("a colour has no spectrum")) << told_;
  EXPECT_FALSE(tells("under a clear coat")) << told_;
  write_exr(folder_ / "photo.exr", {1, 1, {{"R", {0.2F}}, {"G", {0.4F}}, {"B", {0.6F}}}, {}});
  const std::string image =
      R"(<texture name="diffuse_reflectance" type="bitmap"><string name="filename" value="photo.exr"/></texture>)";
  EXPECT_TRUE(std::holds_alternative<spec::Texture>(ground(image)));
  EXPECT_TRUE(tells("an image under a clear coat is darker here")) << told_;
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
    return 1 - std::cos(std::get<spec::SpotLamp>(made.lights.at(i).kind).source.half_angle_deg * M_PI / 180);
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

}  // namespace
}  // namespace abbe
