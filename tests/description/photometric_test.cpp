#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"
#include "spectral/colorimetry.h"
#include "tests/angles.h"
#include "tests/source_tree.h"

// Files of luminous intensity: IES LM-63 and EULUMDAT.

namespace abbe {
namespace {

using test::Fault;
using test::Loaded;

using Intensity = std::function<double(double gamma_deg, double plane_deg)>;

constexpr double kGammaStep = 30;

class PhotometricFileTest : public test::DescriptionTest {
 protected:
  static std::string light(const std::string& file, const std::string& emission = R"({"illuminant": "E"})",
                           const std::string& more = "") {
    return fmt::format(
        R"({{"lights": [{{"photometric": {{"at": [0, 0, 2], "file": "{}"{}}}, "emission": {}}}]}})", file,
        more, emission);
  }
  Loaded loaded(const std::string& file, const std::string& emission = R"({"illuminant": "E"})") {
    return load(light(file, emission));
  }
  std::shared_ptr<const IntensityDistribution> distribution(const std::string& file) {
    const Loaded scene = loaded(file);
    EXPECT_TRUE(scene.scene) << scene.text();
    return scene.scene ? std::get<PhotometricLight>(scene->lights.at(0).kind).distribution : nullptr;
  }

  // Expects the intensity [cd] of a function that is linear between the angles of the file.
  void expect_intensity(const std::string& file, const Intensity& expected) {
    SCOPED_TRACE(file);
    const auto found = distribution(file);
    ASSERT_TRUE(found);
    const double unit = found->luminous_flux() / (4 * kPi);
    for (double gamma = 0; gamma <= 180; gamma += kGammaStep)
      for (double plane = 0; plane < 360; plane += 45) {
        const double g = std::clamp(gamma, 0.01, 179.99) * kPi / 180;
        const double c = plane * kPi / 180;
        const Imath::V3f w(Imath::V3d(std::sin(g) * std::cos(c), std::sin(g) * std::sin(c), std::cos(g)));
        EXPECT_NEAR(static_cast<double>(found->relative_intensity(w)) * unit, expected(gamma, plane),
                    0.01 * expected(gamma, plane) + 0.01)
            << gamma << ", " << plane;
      }
  }

  // An IES file with the horizontal angles `first` to `last` in steps of 45 degrees.
  void write_ies(const std::string& file, double first, double last, const Intensity& intensity,
                 const std::string& tilt = "TILT=NONE", const std::string& factors = "1 1",
                 const std::string& header = "IESNA:LM-63-2002") {
    std::string planes;
    std::string values;
    int count = 0;
    for (double plane = first; plane <= last; plane += 45, ++count) {
      planes += fmt::format("{} ", plane);
      for (double gamma = 0; gamma <= 180; gamma += kGammaStep)
        values += fmt::format("{},\n", intensity(gamma, plane));
    }
    test::write(folder_ / file, fmt::format("{}\n[TEST] analytic\n{}\n1 -1 1 7 {} 1 2 0 0 0 {} 0\n0 30 60 90 "
                                            "120 150 180\n{}\n{}",
                                            header, tilt, count, factors, planes, values));
  }
  // An EULUMDAT file with eight half-planes, of which those from `first` on are written.
  void write_ldt(const std::string& file, int symmetry, int first, int stored, const Intensity& intensity,
                 const std::string& lumens = "1000") {
    std::string text = fmt::format("maker\n1\n{}\n8\n45\n7\n30\n", symmetry);
    for (int i = 0; i < 16; ++i) text += "\n";
    text += fmt::format("1\n0\n1\n1\nlamp\n{}\n\n\n10\n", lumens);
    for (int i = 0; i < 10; ++i) text += "1\n";
    for (int i = 0; i < 8; ++i) text += fmt::format("{}\n", 45 * i);
    for (int i = 0; i < 7; ++i) text += fmt::format("{}\n", 30 * i);
    for (int i = 0; i < stored; ++i)
      for (int j = 0; j < 7; ++j) text += fmt::format("{}\n", intensity(30 * j, 45 * ((first + i) % 8)));
    test::write(folder_ / file, text);
  }
};

TEST_F(PhotometricFileTest, BothFormatsHoldTheAnalyticCosine) {
  const std::string folder = (test::source_tree() / "data" / "lights").string();
  const auto ies = distribution(folder + "/cosine.ies");
  const auto ldt = distribution(folder + "/cosine.ldt");
  ASSERT_TRUE(ies && ldt);
  EXPECT_NEAR(ies->luminous_flux(), 1000, 0.2);
  EXPECT_NEAR(ldt->luminous_flux(), ies->luminous_flux(), 1e-6);
  for (int gamma = 1; gamma < 180; gamma += 2) {
    const double cosine = std::cos(gamma * kPi / 180);
    const Imath::V3f w(
        Imath::V3d(0.6 * std::sqrt(1 - cosine * cosine), -0.8 * std::sqrt(1 - cosine * cosine), cosine));
    EXPECT_NEAR(static_cast<double>(ies->relative_intensity(w)), 4 * std::max(0.0, cosine), 2e-3) << gamma;
    EXPECT_NEAR(ies->relative_intensity(w), ldt->relative_intensity(w), 1e-6) << gamma;
  }
}

double about_axis(double gamma, double) {
  return 100 + gamma;
}
double about_0(double gamma, double plane) {  // the same at C and -C
  return (100 + gamma) * (2 + std::cos(plane * kPi / 180));
}
double about_90(double gamma, double plane) {  // the same at C and 180 - C
  return (100 + gamma) * (2 + std::sin(plane * kPi / 180));
}
double about_both(double gamma, double plane) {
  return (100 + gamma) * (2 + std::cos(2 * plane * kPi / 180));
}
double uneven(double gamma, double plane) {
  return (100 + gamma) * (2 + std::sin((plane + 20) * kPi / 180));
}

TEST_F(PhotometricFileTest, IesSymmetriesGiveAllHalfPlanes) {
  const auto check = [&](double first, double last, const Intensity& intensity) {
    // The intensity around the axis is ambiguous at the poles unless it depends on gamma alone.
    const Intensity shape = [intensity](double gamma, double plane) {
      return gamma == 0 || gamma == 180 ? 50.0 : intensity(gamma, plane);
    };
    write_ies("a.ies", first, last, shape);
    expect_intensity("a.ies", shape);
  };
  check(0, 0, about_axis);
  check(0, 90, about_both);
  check(0, 180, about_0);
  check(90, 270, about_90);
  check(0, 360, uneven);
}

TEST_F(PhotometricFileTest, EulumdatSymmetriesGiveAllHalfPlanes) {
  const auto check = [&](int symmetry, int first, int stored, const Intensity& intensity) {
    const Intensity shape = [intensity](double gamma, double plane) {
      return gamma == 0 || gamma == 180 ? 50.0 : intensity(gamma, plane);
    };
    write_ldt("a.ldt", symmetry, first, stored, shape);
    expect_intensity("a.ldt", shape);
  };
  check(0, 0, 8, uneven);
  check(1, 0, 1, about_axis);
  check(2, 0, 5, about_0);
  check(3, 6, 5, about_90);
  check(4, 0, 3, about_both);
}

TEST_F(PhotometricFileTest, AppliesTheFactorsOfTheFile) {
  const auto times = [](double factor) {
    return [factor](double gamma, double plane) { return factor * about_axis(gamma, plane); };
  };
  write_ies("a.ies", 0, 0, about_axis, "TILT=NONE", "0.9 0.5");
  expect_intensity("a.ies", times(0.9));
  write_ies("a.ies", 0, 0, about_axis, "TILT=NONE", "0.9 0.5", "IESNA91");
  expect_intensity("a.ies", times(0.45));
  write_ies("a.ies", 0, 0, about_axis, "TILT=INCLUDE\n1\n2\n0 90\n1 1");
  expect_intensity("a.ies", about_axis);
  EXPECT_EQ(loaded("a.ies").text(), "");
  write_ies("a.ies", 0, 0, about_axis, "TILT=INCLUDE\n1\n2\n0 90\n1 0.9");
  EXPECT_NE(loaded("a.ies").text().find("tilt factors of the file are not applied"), std::string::npos);
  write_ldt("a.ldt", 1, 0, 1, about_axis, "2500,0");
  expect_intensity("a.ldt", times(2.5));
}

TEST_F(PhotometricFileTest, EmissionHasTheFluxOfTheFileUnlessScaled) {
  write_ies("a.ies", 0, 0, about_axis);
  const double lumens = distribution("a.ies")->luminous_flux();
  const auto flux = [&](const std::string& emission) {
    const Loaded scene = loaded("a.ies", emission);
    EXPECT_TRUE(scene.scene) << scene.text();
    return photometric(power(scene->lights.at(0), 1));
  };
  EXPECT_NEAR(flux(R"({"illuminant": "E"})") / lumens, 1, 1e-6);
  EXPECT_NEAR(flux(R"({"spectrum": 7})") / lumens, 1, 1e-6) << "only its shape counts";
  EXPECT_NEAR(flux(R"({"blackbody_K": 3000, "luminous_flux_lm": 500})"), 500, 1e-3);
  EXPECT_NEAR(flux(R"({"illuminant": "A", "luminous_intensity": 200})") / lumens, 2, 1e-5)
      << "100 cd on axis";
  EXPECT_NEAR(flux(R"({"illuminant": "A", "illuminance": 50, "distance": 2})") / lumens, 2, 1e-5);
}

TEST_F(PhotometricFileTest, Faults) {
  const auto ies = [&](const std::string& name, const std::string& text) {
    test::write(folder_ / name, text);
    return light(name);
  };
  const std::string head = "IESNA:LM-63-2002\nTILT=NONE\n";
  const std::vector<Fault> faults{
      {"missing", light("none.ies"), ErrorCode::input, "no such file"},
      {"extension", ies("a.txt", ""), ErrorCode::input, "(got \".txt\", allowed .ies, .ldt)"},
      {"empty", ies("b.ies", ""), ErrorCode::input, "TILT=NONE"},
      {"tilt file", ies("c.ies", "TILT=lamp.tlt\n"), ErrorCode::input,
       "c.ies:1:1: error: TILT (got \"lamp.tlt\""},
      {"short", ies("d.ies", head + "1 -1 1 3 1 1 2 0 0 0\n1 1 0\n0 45 90\n0\n5 4\n"), ErrorCode::input,
       "d.ies:7:3: error: the file ends too early, at the candela value (got 2 values, expected 3)"},
      {"type B", ies("e.ies", head + "1 -1 1 3 1 2 2 0 0 0\n1 1 0\n0 45 90\n0\n5 4 3\n"), ErrorCode::input,
       "e.ies:3:12: error: photometric type (got \"2\", allowed 1, type C"},
      {"word", ies("f.ies", head + "1 -1 1 3 1 1 2 0 0 0\n1 1 0\n0 45 90\n0\n5 x 3\n"), ErrorCode::input,
       "f.ies:7:3: error: candela value (got \"x\", allowed a number in [0, 1e9])"},
      {"negative", ies("g.ies", head + "1 -1 1 3 1 1 2 0 0 0\n1 1 0\n0 45 90\n0\n5 -1 3\n"), ErrorCode::input,
       "candela value (got \"-1\""},
      {"descending", ies("h.ies", head + "1 -1 1 3 1 1 2 0 0 0\n1 1 0\n0 90 45\n0\n5 4 3\n"),
       ErrorCode::input,
       "h.ies:5:6: error: vertical angle (got \"45\", allowed more than the angle before it, 90)"},
      {"symmetry", ies("i.ies", head + "1 -1 1 2 2 1 2 0 0 0\n1 1 0\n0 90\n0 100\n5 4 3 2\n"),
       ErrorCode::input, "last horizontal angle (got \"100\""},
      {"too many", ies("j.ies", head + "1 -1 1 4000 1 1 2 0 0 0\n"), ErrorCode::input,
       "number of vertical angles (got \"4000\", allowed an integer in [2, 3601])"},
      {"dark", ies("k.ies", head + "1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 90\n0\n0 0\n"), ErrorCode::input,
       "all intensities are 0"},
      {"symmetry of ldt", ies("l.ldt", "maker\n1\n5\n"), ErrorCode::input,
       "l.ldt:3:1: error: symmetry indicator (got \"5\", allowed 0, 1, 2, 3, 4)"},
      {"planes of ldt", ies("m.ldt", "maker\n1\n4\n6\n"), ErrorCode::input,
       "a multiple of 4 with symmetry indicator 4"},
      {"short ldt", ies("n.ldt", "maker\n1\n1\n"), ErrorCode::input,
       "the file ends too early, at the number of C-planes"},
      {"c0", light("o.ies", R"({"illuminant": "E"})", R"(, "c0": [0, 0, 2])"), ErrorCode::scene,
       "c0 must not be parallel to the axis"},
  };
  write_ies("o.ies", 0, 0, about_axis);
  expect_refused(faults);
}

}  // namespace
}  // namespace abbe
