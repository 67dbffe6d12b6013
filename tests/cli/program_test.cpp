#include <cmath>
#include <filesystem>
#include <fstream>
#include <regex>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "calibration/chart/measured_patches.h"
#include "io/exr.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"
#include "tests/tier.h"

namespace abbe::test {
namespace {

TEST(Program, HelpAndVersionGoToStdout) {
  const std::string version = abbe("--version").out;
  EXPECT_TRUE(std::regex_match(
      version,
      std::regex("abbe " ABBE_VERSION "\ndata /.*/data\ndata_sha256 [0-9a-f]{64}\ncompiler .* [0-9.]+.*\n"
                 "Embree 3[0-9.]+\nOpenEXR 3[0-9.]+\nOpenImageIO 2[0-9.]+\nOpenColorIO 2[0-9.]+\n"
                 "Ceres 2[0-9.]+\n")))
      << version;
  for (const char* text : {"--help", "help", "help render", "query prism --help"}) {
    const Outcome run = abbe(text);
    EXPECT_EQ(run.code, 0) << text;
    EXPECT_NE(run.out.find("Usage"), std::string::npos) << text;
    EXPECT_TRUE(run.err.empty()) << text;
  }
  const Outcome no_arguments = abbe("");
  EXPECT_EQ(no_arguments.code, 0);
  EXPECT_EQ(no_arguments.out, abbe("help").out);
  EXPECT_TRUE(no_arguments.err.empty()) << no_arguments.err;
  for (const char* command : {"render", "info", "trace", "query", "compare", "calibrate"})
    EXPECT_NE(abbe("help").out.find(command), std::string::npos) << command;
}

TEST(Program, HelpTellsTheKeysOfScenes) {
  const auto lines = [](const std::string& arguments) {
    const Outcome run = abbe("help scene " + arguments);
    EXPECT_EQ(run.code, 0) << run.err;
    return '\n' + run.out;
  };
  for (const auto& [arguments, expected] :
       {std::pair{"",
                  "\n  units\n      Unit of length.\n      \"m\", \"cm\", \"mm\", \"um\" or \"in\", default "
                  "\"m\"\n"},
        {"sensor/spectral",
         "\n  from_nm\n      Lower end of the first bin.\n      number in [300, 1100] nm, required\n"},
        {"camera/pinhole", "\n  one of\n    focal_length\n"},
        {"camera/pinhole/fov_deg",
         "\ncamera/pinhole/fov_deg\n  Field of view along the shorter image axis.\n"},
        {"lights/sun/angular_diameter_deg", "\n  number in [0.01, 60] degrees, default 0.533\n"},
        {"camera/thin_lens", "\n      number in [0.5, 1e+06], required without t_stop\n"},
        {"lights/two_sided", "\n  With `quad`, `sphere`, `disc`: True to emit from both sides.\n"},
        {"resolution", "\nsensor/resolution\n"},
        {"scale", "\nshapes/instance/transform/scale\n"},
        {"scale", "\nshapes/transform/scale\n"}})
    EXPECT_NE(lines(arguments).find(expected), std::string::npos) << lines(arguments) << "lacks" << expected;
  EXPECT_EQ(lines("/lights/0/sun/towards"), lines("lights/sun/towards"));
  EXPECT_EQ(lines("materials/glass/dielectric/ior"), lines("materials/dielectric/ior"));
  EXPECT_EQ(abbe("help render resolution").code, 2);
  EXPECT_EQ(abbe("help query prism").out, abbe("query prism --help").out);
  EXPECT_NE(abbe("help query prizm").err.find("did you mean \"prism\""), std::string::npos);
}

TEST(Program, UsageErrorsExitWith2) {
  for (const char* text : {"rendr",
                           "render",
                           "--frobnicate",
                           "help rendr",
                           "info",
                           "compare one.exr",
                           "render x.json --spp 0",
                           "render x.json --spp 1.5",
                           "render x.json --spp 4 --time 3s",
                           "render x.json --integrator photon",
                           "render x.json --seed -1",
                           "render x.json --threads 5000",
                           "render x.json --integrator 1",
                           "help --list",
                           "query --json ior N-BK7 --at 550",
                           "render x.json --set samples=3",
                           "render x.json --crop 3,3,2,2",
                           "render x.json --error 0",
                           "render x.json -o ''",
                           "render x.json --checkpoint ''",
                           "render x.json --checkpoint= --resume",
                           "render ''",
                           "query --list ''",
                           "validate -o ''"}) {
    const Outcome run = abbe(text);
    EXPECT_EQ(run.code, 2) << text << '\n' << run.err;
    EXPECT_TRUE(run.err.starts_with("abbe: ")) << text << '\n' << run.err;
    EXPECT_TRUE(run.out.empty()) << text;
  }
}

TEST(Program, UnknownNamesComeWithTheNearest) {
  for (const auto& [text, nearest] :
       {std::pair{"rendr", "command \"rendr\"; did you mean \"render\""},
        {"help rendr", "command \"rendr\"; did you mean \"render\""},
        {"help scene sensr", "key \"sensr\"; did you mean \"sensor\""},
        {"help scene sensor/readot", "key \"readot\"; did you mean \"readout\""},
        {"help scene lights/sunn", "key \"sunn\"; did you mean \"sun\""},
        {"query brewstr N-BK7 --at 550", "command \"brewstr\"; did you mean \"brewster\""},
        {"render x.json --sppp=4", "option \"--sppp\"; did you mean \"--spp\""},
        {"--versoin", "option \"--versoin\"; did you mean \"--version\""}}) {
    const Outcome run = abbe(text);
    EXPECT_EQ(run.code, 2) << text;
    EXPECT_NE(run.err.find(nearest), std::string::npos) << text << '\n' << run.err;
  }
}

TEST(Program, SceneErrorsExitWith3AndSayWhere) {
  const auto path = scratch().write("bad.json", "{\n  \"abbe\": 1,\n  \"camra\": {}\n}\n");
  for (const std::string command : {"info ", "render "}) {
    const Outcome run = abbe(command + path.string());
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_NE(run.err.find(fmt::format("\n{}:3:3: ", path.string())), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("camera"), std::string::npos) << run.err;
  }
}

TEST(Program, MissingInputsExitWith4) {
  EXPECT_EQ(abbe("render /nowhere/scene.json").code, 4);
  EXPECT_EQ(abbe("info /nowhere/scene.json").code, 4);
  EXPECT_EQ(abbe("compare /nowhere/a.exr /nowhere/b.exr").code, 4);
}

TEST(Program, OutputsAreCheckedBeforeRendering) {
  const auto path = scratch().write("ball.json", ball_scene()).string();
  // A render with this number of samples would not end during the test.
  const std::string render = "render " + path + " --spp 10000000 --quiet ";
  EXPECT_EQ(abbe(render + "-o /nowhere/out.exr").code, 5);
  EXPECT_EQ(abbe(render + "-o " + (scratch() / "a.exr").string() + " --display /nowhere/a.png").code, 5);
  EXPECT_EQ(abbe(render + "-o " + (scratch() / "a.exr").string() + " --stats /nowhere/a.json").code, 5);
  EXPECT_EQ(abbe(render + "-o " + (scratch() / "a.tiff").string()).code, 2);
  EXPECT_EQ(abbe(render + "-o " + (scratch() / "a.exr").string() + " --crop 0,0,25,16").code, 2);
}

TEST(Program, TooLargeAFilmExitsWith6) {
  const auto path = scratch().write("ball.json", ball_scene()).string();
  EXPECT_EQ(abbe("render " + path + " --set /sensor/resolution=[1000000,1000000]").code, 6);
}

TEST(Program, AnswersThatCannotBeWrittenExitWith5) {
  for (const char* text : {"query ior N-BK7 --at 550", "query --list"}) {
    const Outcome run = abbe(std::string(text) + " >/dev/full");
    EXPECT_EQ(run.code, 5) << text;
    EXPECT_EQ(run.err, "abbe: cannot write to standard output\n") << text;
  }
}

TEST(Query, EveryQuestionFromTheCommandLine) {
  const auto grey =
      scratch()
          .write("grey.csv",
                 "# unit: reflectance factor\n# outside: clamp\nwavelength_nm,g\n400,0.5\n700,0.5\n")
          .string();
  const auto json = [](const std::string& question) {
    const Outcome run = abbe("query " + question + " --json");
    EXPECT_EQ(run.code, 0) << question << '\n' << run.err;
    return run.code == 0 ? run.json() : nlohmann::json();
  };
  EXPECT_EQ(json("ior N-BK7 --at 486.1327,587.5618")["n"].size(), 2U);
  EXPECT_EQ(json("reflectance Au_Johnson --at 550 --angle 0,60")["R"].size(), 2U);
  EXPECT_NEAR(json("prism N-BK7 --apex 60 --at 587.5618")["deviation_deg"].get<double>(), 38.64670, 1e-5);
  EXPECT_NEAR(json("prism N-BK7 --apex 60 --at 587.5618 --incidence 50")["deviation_deg"].get<double>(),
              38.65364, 1e-5);
  EXPECT_NEAR(json("critical N-BK7 --at 587.5618")["angle_deg"].get<double>(), 41.245189, 1e-6);
  EXPECT_NEAR(json("brewster N-BK7 --at 587.5618")["angle_deg"].get<double>(), 56.603827, 1e-6);
  EXPECT_NEAR(json("color --illuminant D65 --observer 1964")["xy"][0].get<double>(), 0.31381, 1e-4);
  EXPECT_NEAR(json("color --illuminant D50 --reflectance " + grey + ":g")["XYZ"][1].get<double>(), 50, 1e-12);
  EXPECT_NEAR(json("delta-e 50,2.6772,-79.7751 50,0,-82.7485")["dE00"].get<double>(), 2.0425, 5e-5);
  EXPECT_NEAR(json("camera Nikon_D5100 --illuminant A")["raw"]["R"].get<double>(), 1.0604997, 1e-7);
  EXPECT_TRUE(json("--list").contains("material"));
  EXPECT_NE(abbe("query --list illuminant").out.find("FL7\n"), std::string::npos);
  EXPECT_NE(abbe("query --list camera").out.find("Nikon_D5100\n"), std::string::npos);
  EXPECT_EQ(json("--list reflectance").size(), 1U);
}

TEST(Query, FaultyQuestions) {
  for (const char* text : {"", "ior N-BK7", "ior N-BK7 --at abc", "ior N-BK7 --at 250",
                           "reflectance N-BK7 --at 550 --angle 91", "prism N-BK7 --at 550 --apex 180",
                           "delta-e 1,2 1,2,3", "color --illuminant D65 --observer 2", "--list iluminant"})
    EXPECT_EQ(abbe(std::string("query ") + text).code, 2) << text;
  const Outcome glass = abbe("query ior N-BK8 --at 550");
  EXPECT_EQ(glass.code, 4);
  EXPECT_NE(glass.err.find("N-BK7"), std::string::npos) << glass.err;
  EXPECT_TRUE(glass.out.empty());
}

TEST(Calibrate, FromTheCommandLine) {
  const Outcome run = abbe("calibrate --camera Nikon_D5100 --bits 10 --objective XYZ --json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.json()["bits"], 10);
  EXPECT_LT(run.json()["dE00_mean"], 1.5);
  const Outcome ideal = abbe("calibrate --camera box:600-700,500-600,400-500 --json");
  ASSERT_EQ(ideal.code, 0) << ideal.err;
  EXPECT_EQ(ideal.json()["correction"]["usable_starts"], 16);
  for (const char* wrong : {"calibrate --camera box:400-500", "calibrate"}) EXPECT_EQ(abbe(wrong).code, 2);
  const Outcome cubic = abbe("calibrate --camera Nikon_D5100 --correction root-polynomial-3");
  EXPECT_EQ(cubic.code, 2);
  EXPECT_NE(cubic.err.find("13 terms on 24 patches"), std::string::npos) << cubic.err;
  const Outcome unknown = abbe("calibrate --camera Nikon_D510 --illuminant D66 --chart none");
  EXPECT_EQ(unknown.code, 4);
  for (const char* name : {"\"Nikon_D5100\"?\n", "\"D66\"", "\"none\"\n"})
    EXPECT_NE(unknown.err.find(name), std::string::npos) << unknown.err;
  EXPECT_FALSE(unknown.err.ends_with("\n\n"));
}

TEST(Calibrate, WritesConfigurationAndReportForEachLight) {
  const std::filesystem::path folder = scratch() / "nikon";
  const Outcome run = abbe(
      "calibrate --camera Nikon_D5100 --illuminant D65,A --response linear --correction root-polynomial-2 "
      "--test colorchecker24_ohta1997 -o " +
      folder.string() + (nightly() ? "" : " --objective XYZ"));  // whose resampling is quick
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* name : {"config.ocio", "camera_D65.clf", "camera_A.clf", "camera_A.cube", "camera_A.spi1d",
                           "camera_A_to_aces.clf"})
    EXPECT_GT(std::filesystem::file_size(folder / name), 1000U) << name;
  const auto report = nlohmann::json::parse(read_file(folder / "report.json"));
  EXPECT_NEAR(report["bake_dE00_max"].get<double>(), 0.25, 0.05);  // includes dark values
  ASSERT_EQ(report["calibrations"].size(), 2U);
  const auto& tungsten = report["calibrations"][1];
  EXPECT_EQ(tungsten["illuminant"], "A");
  EXPECT_EQ(tungsten["patches"].size(), 24U);
  EXPECT_EQ(tungsten["responses"].size(), 3U);
  EXPECT_EQ(tungsten["correction"]["columns_95"].size(), 6U);
  EXPECT_GT(tungsten["unseen_dE00_mean"], tungsten["dE00_mean"]);
  EXPECT_GT(tungsten["test_dE00_mean"], 0);
  EXPECT_NE(run.out.find("on the test chart: mean"), std::string::npos);
}

TEST(Calibrate, RealCameraFromPhotographsToConfiguration) {
  // Grey steps that a camera with gamma 2 photographed with eight exposures.
  std::string exposures;
  for (int stop = -6; stop <= 1; ++stop) {
    Image image{48, 1, {}, {}};
    for (const char* name : {"R", "G", "B"}) {
      ImageChannel channel{name, {}};
      for (int x = 0; x < 48; ++x)
        channel.values.push_back(
            static_cast<float>(std::min(1.0, std::sqrt((x + 1) / 48.0 * std::exp2(stop)))));
      image.channels.push_back(std::move(channel));
    }
    write_exr(scratch() / fmt::format("s{}.exr", stop), image);
    exposures += fmt::format("{{\"file\": \"s{}.exr\", \"exposure_s\": {}}},", stop, std::exp2(stop));
  }
  const std::string series = scratch().write("series.json", "{\"exposures\": [" + exposures + "]}").string();
  const std::string folder = (scratch() / "real").string();
  const Outcome alone = abbe("calibrate --series " + series + " -o " + folder);
  ASSERT_EQ(alone.code, 0) << alone.err;
  EXPECT_NE(alone.out.find("uncertainty [%]"), std::string::npos);
  EXPECT_NE(read_file(folder + "/response.csv").find("code,R,R_low,R_high,G"), std::string::npos);

  // The XYZ values of the chart, recorded by that camera.
  std::string rows = "# unit: code values\npatch,R,G,B\n";
  Diagnostics diagnostics;
  const auto targets = load_chart_targets("colorchecker24_after_nov2014", Curve(1.0), {}, diagnostics);
  ASSERT_TRUE(targets);
  const auto add = [&](const std::string& name, const XYZ& xyz) {
    rows += fmt::format("{},{},{},{}\n", name, std::sqrt(xyz[0]), std::sqrt(xyz[1]), std::sqrt(xyz[2]));
  };
  for (std::size_t i = 0; i < 24; ++i) add(targets->names[i], targets->xyz[i]);
  add("perfect diffuser", targets->white);
  const std::string measured = scratch().write("codes.csv", rows).string();
  const Outcome both = abbe("calibrate --chart colorchecker24_after_nov2014 --illuminant D50 --measured " +
                            measured + " --series " + series + " --json -o " + folder);
  ASSERT_EQ(both.code, 0) << both.err;
  EXPECT_LT(both.json()["dE00_max"], 0.5);
  EXPECT_EQ(both.json()["responses"].size(), 3U);
  EXPECT_GT(std::filesystem::file_size(folder + "/camera_D50.spi1d"), 1000U);
  EXPECT_GT(abbe("calibrate --chart colorchecker24_after_nov2014 --illuminant D50 --measured " + measured +
                 " --json")
                .json()["dE00_max"],
            3);
}

TEST(Calibrate, MeasuredCamera) {
  const auto file =
      scratch().write("measured.csv", "# unit: linear camera values\npatch,R,G,B\ndark skin,0.1,0.1,0.1\n");
  const Outcome few = abbe("calibrate --illuminant D50 --measured " + file.string() +
                           " --chart colorchecker24_after_nov2014");
  EXPECT_EQ(few.code, 4);
  EXPECT_NE(few.err.find("missing: light skin"), std::string::npos) << few.err;
  EXPECT_EQ(abbe("calibrate --camera Nikon_D5100 --measured " + file.string()).code, 2);
}

// Options that apply to a simulated camera only.
TEST(Calibrate, OptionsWithoutEffectAreRefused) {
  for (const char* real : {"--measured x.csv", "--series x.json", "--all-cameras"})
    for (const char* option :
         {"--test colorchecker24_ohta1997", "--response linear", "--bits 10", "--illuminant D65,A"}) {
      const Outcome run = abbe(fmt::format("calibrate {} {}", real, option));
      EXPECT_EQ(run.code, 2) << real << ' ' << option;
      const std::string name(option, std::string_view(option).find(' '));
      EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
      EXPECT_TRUE(run.out.empty()) << real << ' ' << option;
    }
}

TEST(Trace, FromTheCommandLine) {
  const std::string trace =
      "trace " + scratch().write("prism.json", prism_scene()).string() + " --origin -100,0,-20 ";
  const Outcome run = abbe(trace + "--dir 1,0,.25 --lambda 550 --json");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.json()["events"][0]["kind"], "refract");
  EXPECT_NE(abbe(trace + "--dir 1,0,.25 --lambda 550").out.find("refract"), std::string::npos);
  EXPECT_EQ(abbe(trace + "--dir 1,0,.25 --lambda 200").code, 2);
  EXPECT_EQ(abbe(trace + "--dir -1,0 --lambda 550").code, 2);
  EXPECT_EQ(abbe(trace + "--lambda 550").code, 2);
  const auto lit = [&](const std::string& stokes) {
    return abbe(trace + "--dir 1,0,.25 --lambda 550 --stokes=" + stokes);
  };
  EXPECT_EQ(lit("2,1.2,0,-1.6").code, 0);
  EXPECT_NE(lit("1,1,1,0").err.find("--stokes: got \"1,1,1,0\", allowed I > 0"), std::string::npos);
  for (const char* wrong : {"1,1,1,0", "0,0,0,0", "1,0,0"}) EXPECT_EQ(lit(wrong).code, 2) << wrong;
}

TEST(Info, KeysOfTheContract) {
  const auto path = scratch().write("prism.json", prism_scene()).string();
  const Outcome run = abbe("info " + path + " --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json found = run.json();
  EXPECT_EQ(found["shapes"], 1);
  EXPECT_EQ(found["triangles"], 8);
  EXPECT_EQ(found["lights"], 1);
  EXPECT_EQ(found["materials"], 1);
  EXPECT_EQ(found["needs"]["dispersion"], true);
  EXPECT_EQ(found["needs"]["delta_lights"], false);
  EXPECT_EQ(found["needs"].size(), 14U);
  EXPECT_EQ(found["because"]["dispersion"], "shape \"prism\"");
  EXPECT_EQ(found["techniques"], nlohmann::json::parse(R"(["path"])"));
  EXPECT_EQ(found["owned"], nlohmann::json::parse(R"({"path": "E (S|D)* L"})"));
  EXPECT_TRUE(found["shares"].is_null());
  EXPECT_TRUE(found["unreached"].is_array());
  EXPECT_TRUE(found["bias"].is_null());
  EXPECT_GE(found["wavelength_range_nm"][0], 300);
  EXPECT_LE(found["wavelength_range_nm"][1], 1100);
  EXPECT_GT(found["memory_bytes"], 24 * 16 * 3 * 16);
  EXPECT_EQ(run.err.find("polarisation"), std::string::npos) << run.err;
  const Outcome readable = abbe("info " + path);
  EXPECT_NE(readable.out.find("dispersion"), std::string::npos);
  EXPECT_EQ(abbe("info " + scratch().write("ball.json", ball_scene()).string()).err, "");
}

TEST(Info, TellsTheSharesOfTechniquesThatARenderHas) {
  std::string scene =
      scene_text(R"("glass": {"dielectric": {"ior": 1.5}}, "card": {"diffuse": {"reflectance": 0.5}})",
                 R"({"sphere": {"center": [0, 0, 0], "radius": 30}, "material": "glass"},
         {"quad": {"corner": [-200, 100, -200], "edge_u": [400, 0, 0], "edge_v": [0, 0, 400]}, "material": "card"})");
  const std::string sky = R"({"environment": {}, "emission": {"illuminant": "D65", "radiance": 1}})";
  scene.replace(
      scene.find(sky), sky.size(),
      R"({"point": {"at": [0, -100, 80]}, "emission": {"illuminant": "D65", "radiant_flux_W": 1}})");
  const std::string path = scratch().write("lens.json", scene).string();
  const nlohmann::json found = abbe("info " + path + " --json").json();
  EXPECT_EQ(found["owned"]["path"], "E (S|D)* L, except paths owned by light");
  EXPECT_EQ(found["owned"]["light"], "E D (S|D)* S L of traced lights");
  const nlohmann::json& shares = found["shares"];
  ASSERT_TRUE(shares.is_object());
  ASSERT_EQ(
      abbe("render " + path + " --quiet -o " + file("lens.exr") + " --stats " + file("lens.json.stats")).code,
      0);
  const auto stats = nlohmann::json::parse(std::ifstream(file("lens.json.stats")));
  EXPECT_EQ(shares["photons_per_sample"], stats["photons_per_sample"]);
  EXPECT_EQ(shares["path_interval"], stats["path_interval"]);
  for (const char* technique : {"camera_paths", "photons"}) {
    EXPECT_GT(shares[technique]["relative_variance"], 0) << technique;
    EXPECT_GT(shares[technique]["rays"], 1) << technique;
  }
  EXPECT_NE(abbe("info " + path).out.find("balance      "), std::string::npos);
}

TEST(Info, TellsTheMosaicAndHoldsOnePlaneForIt) {
  const auto told = [](const std::string& members) {
    const std::string scene = ball_scene();
    const std::string observer = R"("observer": "1931")";
    const std::size_t at = scene.find(observer);
    const auto path =
        scratch().write("mosaic.json", scene.substr(0, at) + members + scene.substr(at + observer.size()));
    return abbe("info " + path.string() + " --json").json();
  };
  const std::string channels = R"("channels": {"a": {"band": [400, 500]}, "b": 1})";
  const nlohmann::json plain = told(channels);
  const nlohmann::json raw = told(channels + R"(, "mosaic": [["a", "b", "b"]])");
  EXPECT_FALSE(plain.contains("mosaic"));
  EXPECT_EQ(raw["mosaic"], "a,b,b");
  EXPECT_EQ(plain["memory_bytes"].get<int>() - raw["memory_bytes"].get<int>(), 24 * 16 * 2 * 16);
}

// A triangle of glass is not a closed surface. All commands that load it warn; only --strict rejects it.
TEST(Program, StrictRefusesMatterThatIsNotClosed) {
  const std::string scene =
      scratch()
          .write(
              "open.json",
              scene_text(
                  R"("glass": {"dielectric": {"ior": 1.5}})",
                  R"({"mesh": {"vertices": [[0, 0, 0], [1, 0, 0], [0, 1, 0]], "triangles": [[0, 1, 2]]}, "material": "glass"})"))
          .string();
  const std::string render = "render " + scene + " --quiet --crop 0,0,1,1 -o " + file("open.exr");
  for (const std::string& command : {"info " + scene, render}) {
    const Outcome run = abbe(command);
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_NE(run.err.find("/shapes/0/mesh: warning: the mesh around medium \"glass\" is not a closed "
                           "surface: 3 open edges"),
              std::string::npos)
        << run.err;
  }
  std::filesystem::remove(file("open.exr"));
  const Outcome strict = abbe(render + " --strict");
  EXPECT_EQ(strict.code, 3) << strict.err;
  EXPECT_NE(strict.err.find("error: the mesh around medium"), std::string::npos) << strict.err;
  EXPECT_FALSE(std::filesystem::exists(file("open.exr")));
}

}  // namespace
}  // namespace abbe::test
