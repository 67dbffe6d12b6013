#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/picture.h"
#include "spectral/colorimetry.h"
#include "tests/cli/lit_dome.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"
#include "transport/render/part.h"

// White of pictures.

namespace abbe::test {
namespace {

// All sensors: by default white is the dominant light, in the picture of the render and in that of its film.
// The name of a light or of an illuminant, or coordinates, request another white.
class AnySensor : public testing::TestWithParam<const char*> {};

TEST_P(AnySensor, ShowsTheMainLightAsWhiteOrWhatIsAskedFor) {
  const std::string film = file("film.exr");
  const std::string picture = file("film.png");
  ASSERT_EQ(run_render(lit_dome("w.json", GetParam()), film, "--display " + picture).code, 0);
  EXPECT_LT(std::abs(warmth(picture)), 0.02) << "the dome of A";
  const Image rendered = read_exr(film);
  EXPECT_EQ(rendered.metadata.at("white"), "dome");
  const auto develop = [&](const std::string& white) {
    const Outcome run = abbe("develop " + film + " --display " + file("developed.png") +
                             (white.empty() ? "" : " --set '/output/white=" + white + "'"));
    EXPECT_EQ(run.code, 0) << run.err;
    return warmth(file("developed.png"));
  };
  EXPECT_EQ(develop(""), warmth(picture));
  EXPECT_LT(std::abs(develop("A")), 0.02);
  for (const char* white : {"faint", "D65", "[0.31272, 0.32903]"}) {
    EXPECT_GT(develop(white), 0.3) << white;
    const bool list = *white == '[';
    const std::string text = list ? std::string(white) : fmt::format("\"{}\"", white);
    ASSERT_EQ(
        run_render(lit_dome("d.json", GetParam(), text), file("d.exr"), "--display " + file("d.png")).code,
        0);
    EXPECT_NEAR(warmth(file("d.png")), develop(white), 0.06) << white;
    EXPECT_EQ(read_exr(file("d.exr")).metadata.at("white"), list ? "0.31272,0.32903" : white);
    const Outcome same = abbe("compare " + file("d.exr") + " " + film + " --json");
    const bool other_profile = GetParam() == kNikon && std::string(white) == "faint";
    EXPECT_LT(same.json()["dE00_mean"].get<double>(), other_profile ? 15 : 1e-3)
        << "a white is no difference: " << white;
  }
}

// A developed film and its picture record the requested white, which the film shows when it is developed
// again.
TEST(White, IsToldByWhatIsDevelopedForIt) {
  const std::string film = film_of(lit_dome("t.json", kNikon), "t");
  developed(film + " --white D65 --exposure 0.002 -o " + file("t_d65.exr") + " --display " +
            file("t_d65.png"));
  const auto of_film = read_exr_parts(file("t_d65.exr")).front().image.metadata;
  const auto of_picture = read_picture(file("t_d65.png")).metadata;
  for (const auto* told : {&of_film, &of_picture}) {
    EXPECT_EQ(told->at("white"), "D65");
    EXPECT_TRUE(told->at("white_xy").starts_with("0.312")) << told->at("white_xy");
    EXPECT_NE(told->at("to_xyz_d65"), read_exr(film).metadata.at("to_xyz_d65"));
    EXPECT_DOUBLE_EQ(std::stod(told->at("display_exposure")), 0.002);
  }
  developed(file("t_d65.exr") + " --display " + file("t_again.png"));
  EXPECT_EQ(read_picture(file("t_again.png")).channels[0].values,
            read_picture(file("t_d65.png")).channels[0].values);
}

TEST(White, IsToldAsAskedForWhereTheSceneAsksForIt) {
  const std::string film = film_of(lit_dome("asks.json", kNikon, "\"D65\""), "asks");
  const auto told = [](const std::string& of) { return read_exr_parts(of).front().image.metadata; };
  EXPECT_EQ(told(film).at("white_asked"), "yes");
  for (const auto& [white, asked] : {std::pair("", true), {" --white D65", true}, {" --white A", false}}) {
    developed(film + white + " -o " + file("asks_seen.exr"));
    EXPECT_EQ(told(file("asks_seen.exr")).contains("white_asked"), asked) << white;
  }
}

INSTANTIATE_TEST_SUITE_P(White, AnySensor, testing::Values(kObserver, kWideObserver, kNikon, kSpectral));

// White points of A, D65 and FL11 for the CIE 1964 observer, as published.
TEST(White, IsThatOfTheObserverWhoseFilmItIs) {
  const Chromaticity a{0.45117, 0.40594};
  const Chromaticity fl11{0.38541, 0.37123};
  const std::string film = film_of(lit_dome("wide.json", kWideObserver, "", "FL11"), "wide");
  const auto told = read_exr(film).metadata;
  expect_xy(told, fl11, 2e-5);
  const auto lights = nlohmann::json::parse(told.at("lights_xy"));
  EXPECT_NEAR(lights["faint"][0].get<double>(), 0.31382, 2e-5);
  EXPECT_NEAR(lights["faint"][1].get<double>(), 0.33100, 2e-5);
  const auto white = [](const std::string& of) { return read_exr_parts(of).front().image.metadata; };
  developed(film + " --white A -o " + file("wide_a.exr"));
  expect_xy(white(file("wide_a.exr")), a, 2e-5);
  expect_xy(read_exr(film_of(lit_dome("wide_a.json", kWideObserver, "\"A\"", "FL11"), "wide_asked")).metadata,
            a, 2e-5);
  const Outcome compared =
      abbe("compare " + film + " " + film_of(lit_dome("eye.json", kObserver, "", "FL11"), "eye"));
  EXPECT_EQ(compared.code, 4);
  EXPECT_NE(compared.err.find("photometric of CIE 1964"), std::string::npos) << compared.err;
}

TEST(White, AFilmTellsItsWhiteToTheSensorThatLooksAtIt) {
  const std::string film = file("spectral.exr");
  ASSERT_EQ(run_render(lit_dome("s.json", kSpectral), film).code, 0);
  const auto seen = [&](const std::string& sensor, const std::string& options) {
    const Outcome run =
        abbe("develop " + film + " --scene " + sensor + " --display " + file("seen.png") + options);
    EXPECT_EQ(run.code, 0) << run.err;
    return warmth(file("seen.png"));
  };
  EXPECT_LT(std::abs(seen(lit_dome("n.json", kNikon), "")), 0.02);
  EXPECT_LT(std::abs(seen(lit_dome("n.json", kNikon, "", "D65"), "")), 0.1)
      << "not what the sensor's scene has";
  EXPECT_GT(seen(lit_dome("n.json", kNikon, "\"D65\""), ""), 0.3);
  EXPECT_GT(seen(lit_dome("n.json", kNikon), " --set /output/white=D65"), 0.3);
}

// Colour of lights that are constant between whole nanometres, from their power there.
Chromaticity color_of_bands(const std::map<std::pair<int, int>, double>& power) {
  const ColorMatching& eye = color_matching(Observer::cie1931);
  XYZ seen{};
  for (const auto& [nm, watts] : power)
    for (int at = nm.first; at < nm.second; ++at) {
      const double share = watts / 2 / (nm.second - nm.first);
      seen[0] += share * (eye.x(at) + eye.x(at + 1));
      seen[1] += share * (eye.y(at) + eye.y(at + 1));
      seen[2] += share * (eye.z(at) + eye.z(at + 1));
    }
  return chromaticity(seen);
}

// A film of spectral lines in wide bins, with the exact power of the lamp in each.
TEST(White, OfASpectralFilmIsWhatItsBinsShow) {
  const auto lit_lines = [](const std::string& name, const std::string& sensor) {
    std::string text = read_file(lit_dome(name, sensor));
    const std::string light = R"("illuminant": "A", "luminance": 100)";
    text.replace(
        text.find(light), light.size(),
        R"("lines": [{"nm": 462, "width_nm": 0.1, "power": 1}, {"nm": 525, "width_nm": 0.1, "power": 1.2},
                    {"nm": 638, "width_nm": 0.1, "power": 1.5}, {"nm": 850, "width_nm": 0.1, "power": 2}],
                    "luminance": 100)");
    return scratch().write(name, text).string();
  };
  const std::string path =
      film_of(lit_lines("bins.json", R"("spectral": {"from_nm": 380, "to_nm": 900, "step_nm": 20})"), "bins");
  Image film = read_exr(path);
  expect_xy(film.metadata, color_of_bands({{{460, 480}, 1}, {{520, 540}, 1.2}, {{620, 640}, 1.5}}), 1e-6);
  const std::map<std::string, float> held{{"S0.470,000000nm", 1.0F},
                                          {"S0.530,000000nm", 1.2F},
                                          {"S0.630,000000nm", 1.5F},
                                          {"S0.850,000000nm", 2.0F}};
  for (ImageChannel& channel : film.channels)
    if (channel.name.starts_with("S0.")) {
      const auto found = held.find(channel.name);
      channel.values.assign(film.pixels(), found == held.end() ? 0.0F : found->second);
    }
  write_exr(path, film);
  const auto expect_neutral = [](const std::string& arguments) {
    developed(arguments + " --display " + file("bins.png"));
    const auto [r, g, b] = means(read_picture(file("bins.png")));
    EXPECT_NEAR(r, g, 1.5 / 255) << arguments;
    EXPECT_NEAR(b, g, 1.5 / 255) << arguments;
  };
  expect_neutral(path);
  // Half of the bin of the red line is inside the red channel.
  constexpr const char* kInfrared =
      R"("channels": {"R": {"band": [630, 680]}, "G": {"band": [500, 590]}, "N": {"band": [790, 900]}})";
  for (const char* sensor : {kNikon, kWideObserver, kInfrared}) {
    expect_neutral(path + " --scene " + lit_lines("looker.json", sensor));
    expect_neutral(path + " --white dome --scene " + lit_lines("looker.json", sensor));
  }
}

// Films of bands that contain little of the light, or no visible light.
TEST(White, OfBandsThatNoEyeAdaptsToIsWhatIsAskedForOrNone) {
  struct Bands {
    const char* sensor;
    Chromaticity a;
    Chromaticity d65;
  };
  const Chromaticity d65{0.31273, 0.32902};  // from 360 to 830 nm
  for (const auto& [sensor, of_a, of_d65] :
       {Bands{R"("spectral": {"from_nm": 500, "to_nm": 600, "step_nm": 10})",
              {0.39379, 0.58297},
              {0.34846, 0.61574}},
        Bands{R"("spectral": {"from_nm": 650, "to_nm": 700, "step_nm": 10})", {0.73020, 0.26980}, d65},
        Bands{R"("spectral": {"from_nm": 800, "to_nm": 1000, "step_nm": 50})", {0.44756, 0.40743}, d65}}) {
    SCOPED_TRACE(sensor);
    const std::string film = film_of(lit_dome("few.json", sensor), "few");
    expect_xy(read_exr(film).metadata, of_a, 2e-5);
    expect_xy(read_exr(film_of(lit_dome("named.json", sensor, "\"D65\""), "named")).metadata, of_d65, 2e-5);
    developed(film + " --white D65 --display " + file("few.png"));
    if (of_a[0] < 0.45 && of_a[1] < 0.45) continue;  // invisible to the cameras
    const std::string looker = lit_dome("looker.json", kNikon);
    for (const std::string& scene : {looker, lit_dome("other.json", kNikon, "", "FL11")}) {
      developed(film + " -o " + file("seen.exr") + " --display " + file("few.png") + " --scene " + scene);
      expect_xy(read_exr_parts(file("seen.exr")).front().image.metadata, of_a, 2e-5);
    }
    const auto expect_asked = [&](const std::string& how) {
      developed(film + " -o " + file("asked.exr") + how);
      expect_xy(read_exr_parts(file("asked.exr")).front().image.metadata, of_d65, 2e-5);
    };
    expect_asked(" --white D65 --scene " + looker);
    expect_asked(" --scene " + lit_dome("asks.json", kNikon, "\"D65\""));
  }
}

// Chromatic adaptation to the colour of this light in the bands of the film is impossible. If it is requested
// as white, sensors use its own colour.
TEST(White, OfALightThatAFilmOfBandsAsksForIsThatLightToWhoLooks) {
  constexpr const char* kRed = R"("spectral": {"from_nm": 650, "to_nm": 700, "step_nm": 10})";
  const std::string film = film_of(lit_dome("red.json", kRed, "\"faint\""), "red");
  const auto lit = read_exr(film_of(lit_dome("lit.json", kNikon, "\"faint\""), "lit")).metadata;
  developed(film + " -o " + file("red_seen.exr") + " --scene " + lit_dome("looker.json", kNikon));
  const auto seen = read_exr_parts(file("red_seen.exr")).front().image.metadata;
  for (const char* key : {"white", "white_xy", "to_xyz_d65"}) EXPECT_EQ(seen.at(key), lit.at(key)) << key;
}

TEST(White, OfAFilmOfBandsIsFoundByTheNameThatTheFilmHasForIt) {
  constexpr const char* kRed = R"("spectral": {"from_nm": 650, "to_nm": 700, "step_nm": 10})";
  const std::string film = film_of(lit_dome("red.json", kRed, "\"dome\""), "red");
  expect_xy(read_exr(film).metadata, {0.44758, 0.40745}, 2e-5);
  developed(film + " --display " + file("red.png"));
  developed(film + " --white dome --display " + file("red_dome.png"));
  EXPECT_EQ(means(read_picture(file("red_dome.png"))), means(read_picture(file("red.png"))));
  EXPECT_EQ(abbe("compare " + film + " " + film + " --white dome").code, 0);
  EXPECT_EQ(abbe("develop " + film + " --white faint --display " + file("red.png")).code, 2);
}

// The scene of the sensor or an option may name the light.
TEST(White, OfAnIlluminantIsWhatTheBinsOfAFilmShowOfIt) {
  const std::string film =
      film_of(lit_dome("bins.json", R"("spectral": {"from_nm": 380, "to_nm": 780, "step_nm": 20})"), "bins");
  const auto white_xy = [&](const std::string& how) {
    developed(film + how + " -o " + file("bins_seen.exr"));
    return read_exr_parts(file("bins_seen.exr")).front().image.metadata.at("white_xy");
  };
  const std::string said = white_xy(" --scene " + lit_dome("asks.json", kNikon, "\"FL11\""));
  EXPECT_EQ(said, white_xy(" --white FL11 --scene " + lit_dome("looker.json", kNikon)));
  EXPECT_GT(std::abs(std::stod(said) - 0.38052), 0.002) << "FL11 itself";
}

TEST(White, InfoSaysWhichAndWhy) {
  const auto white = [](const std::string& path) { return abbe("info --json " + path).json()["white"]; };
  const auto chosen = white(lit_dome("i.json", kNikon));
  EXPECT_EQ(chosen["name"], "dome");
  EXPECT_EQ(chosen["because"], "gives the film 100 % of its light");
  EXPECT_NEAR(chosen["xy"][0].get<double>(), 0.4476, 1e-3);
  EXPECT_EQ(white(lit_dome("i.json", kNikon, "\"FL11\""))["because"], "asked for");
  EXPECT_TRUE(white(lit_dome("i.json", R"("channels": {"L": {"band": [400, 700]}})")).is_null());
  EXPECT_NE(abbe("info " + lit_dome("i.json", kNikon)).out.find("white        dome (x 0.44"),
            std::string::npos);
}

TEST(White, PartsOfOtherWhitesMerge) {
  const std::string path = lit_dome("p.json", kObserver);
  ASSERT_EQ(run_render(path, file("a.abbepart"), "--sample-range 0:32").code, 0);
  ASSERT_EQ(run_render(path, file("b.abbepart"), "--sample-range 32:64").code, 0);
  ASSERT_EQ(run_render(path, file("whole.exr")).code, 0);
  // The pilot of another machine may have this value.
  RenderPart b = read_part(file("b.abbepart"));
  b.identity["white"] = "faint";
  b.identity["white_xy"] = "0.3 0.3";
  b.identity["lights_xy"] = "{}";
  b.identity["to_xyz_d65"] = "1 0 0 0 1 0 0 0 1";
  write_part(file("b.abbepart"), b.identity, b.result);
  ASSERT_EQ(abbe("merge " + file("a.abbepart") + " " + file("b.abbepart") + " -o " + file("ab.exr")).code, 0);
  const Image merged = read_exr(file("ab.exr"));
  const Image whole = read_exr(file("whole.exr"));
  EXPECT_EQ(merged.find("Y")->values, whole.find("Y")->values);
  EXPECT_EQ(merged.metadata.at("white_xy"), whole.metadata.at("white_xy"));
}

// An output that cannot be written, or is locked, is rejected before the pilot that determines the white.
TEST(White, IsSettledAfterTheOutputs) {
  const std::string path = lit_dome("first.json", kObserver, "[0.7, 0.29]");  // itself an error
  EXPECT_EQ(run_render(path, "/nonexistent/a.exr").code, 5);
  EXPECT_EQ(run_render(path, file("a.exr")).code, 3);
  const Outcome piped = shell("cat " + path + " | " ABBE_BINARY " render - --quiet -o " + file("a.exr"));
  EXPECT_NE(piped.err.find("<stdin>: /output/white: chromatic adaptation to this white is impossible"),
            std::string::npos)
      << piped.err;
}

TEST(White, ALightOfAnAmbiguousNameIsNone) {
  std::string text = read_file(lit_dome("twins.json", kObserver));
  for (const char* name : {"faint", "dome"})
    text.replace(text.find(fmt::format("\"name\": \"{}\"", name)), 8 + std::string(name).size() + 2,
                 R"("name": "lamp")");
  const std::string path = scratch().write("twins.json", text).string();
  const std::string words = "several lights are called \"lamp\"";
  const Outcome rendered = run_render(path, file("twins.exr"), R"(--set '/output/white="lamp"')");
  EXPECT_EQ(rendered.code, 3);
  EXPECT_NE(rendered.err.find(words), std::string::npos) << rendered.err;
  ASSERT_EQ(run_render(path, file("twins.exr")).code, 0);
  const Outcome developed =
      abbe("develop " + file("twins.exr") + " --set /output/white=lamp --display " + file("x.png"));
  EXPECT_EQ(developed.code, 2);
  EXPECT_NE(developed.err.find(words), std::string::npos) << developed.err;
}

TEST(White, OfASensorWithoutColoursIsWarnedOf) {
  const std::string path = lit_dome("one.json", R"("channels": {"L": {"band": [400, 700]}})", "\"A\"");
  const Outcome info = abbe("info --json " + path);
  EXPECT_EQ(info.code, 0);
  EXPECT_TRUE(info.json()["white"].is_null());
  EXPECT_NE(info.err.find("/output/white: warning: white has no effect"), std::string::npos) << info.err;
  EXPECT_EQ(run_render(path, file("one.exr"), "--strict").code, 0);
}

TEST(White, WhatCannotBeIsAnErrorAtItsPlace) {
  const auto refused = [](const std::string& white, const std::string& words, const std::string& sensor) {
    const Outcome run = run_render(lit_dome("bad.json", sensor, white), file("bad.exr"));
    EXPECT_EQ(run.code, 3) << white;
    EXPECT_NE(run.err.find(words), std::string::npos) << run.err;
  };
  refused(R"("dom")", "unknown light or illuminant \"dom\"", kObserver);
  refused(R"("dom")", "dome", kObserver);
  refused("[0.5, 0.6]", "x + y is above 1", kObserver);
  refused("[0.5, 1]", "allowed (0, 1)", kObserver);
  refused("[0.7, 0.29]", "chromatic adaptation to this white is impossible", kNikon);
  ASSERT_EQ(run_render(lit_dome("ok.json", kObserver), file("ok.exr")).code, 0);
  const Outcome run =
      abbe("develop " + file("ok.exr") + " --set /output/white=dom --display " + file("x.png"));
  EXPECT_NE(run.code, 0);
  EXPECT_NE(run.err.find("dome"), std::string::npos) << run.err;
}

// An overexposed sensor in warm light: all its channels have the same value, which is not a neutral colour.
TEST(White, WhatSaturatesIsNotCyan) {
  const std::string film = file("hot.exr");
  const std::string sensor =
      R"("response": "quantum", "pixel_pitch_um": 10, "exposure_s": 1, "channels": {"R": {"band": [600, 700]}, "G": {"band": [500, 600]}, "B": {"band": [400, 500]}},
         "readout": {"gain_e_per_dn": 1, "bits": 10, "full_well_e": 900})";
  ASSERT_EQ(run_render(lit_dome("hot.json", sensor), film).code, 0);
  ASSERT_EQ(abbe("develop " + film + " --display " + file("hot.png")).code, 0);
  const auto [r, g, b] = means(read_picture(file("hot.png")));
  EXPECT_NEAR(r, 1, 0.02);
  EXPECT_NEAR(g, 1, 0.02);
  EXPECT_NEAR(b, 1, 0.02);
}

TEST(White, SpectralFilmsSayTheUnitOfTheirBins) {
  const std::string film = file("units.exr");
  ASSERT_EQ(run_render(lit_dome("u.json", kSpectral), film).code, 0);
  const auto& metadata = read_exr(film).metadata;
  EXPECT_EQ(metadata.at("emissiveUnits"), "W.m^-2.sr^-1");
  EXPECT_EQ(metadata.at("channel.S0.552,500000nm"), "radiance, W per m^2 and sr of the band");
  EXPECT_EQ(
      std::count_if(metadata.begin(), metadata.end(),
                    [](const auto& entry) { return entry.second.find("J per m^2") != std::string::npos; }),
      0);
}

}  // namespace
}  // namespace abbe::test
