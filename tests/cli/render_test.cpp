#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "io/data_directory.h"
#include "io/exr.h"
#include "io/picture.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"

namespace abbe::test {
namespace {

TEST(Render, WritesImagePictureAndStats) {
  const Outcome run = abbe("render " + ball() + " -o " + file("a.exr") + " --display " + file("a.png") +
                           " --stats " + file("a.stats") + " --seed 7 --threads 2 --explain");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(run.out.empty());
  EXPECT_NE(run.err.find("100 %"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("techniques"), std::string::npos) << run.err;

  const Image image = read_exr(file("a.exr"));
  EXPECT_EQ(image.width, 24);
  EXPECT_EQ(image.height, 16);
  for (const char* name : {"X", "Y", "Z", "Variance.Y"}) EXPECT_NE(image.find(name), nullptr) << name;
  EXPECT_EQ(image.metadata.at("samples_per_pixel"), "8");
  EXPECT_EQ(image.metadata.at("seed"), "7");
  EXPECT_EQ(image.metadata.at("channel.Y"), "photometric, lx s");
  EXPECT_EQ(image.metadata.at("version"), ABBE_VERSION);
  EXPECT_EQ(read_picture(file("a.png")).width, 24);

  const nlohmann::json stats = nlohmann::json::parse(read_file(file("a.stats")));
  EXPECT_EQ(stats.size(), 28U);
  EXPECT_EQ(stats["threads"], 2);
  EXPECT_EQ(stats["samples_per_pixel"], 8);
  EXPECT_EQ(stats["samples_before"], 0);
  EXPECT_EQ(stats["seed"], 7);
  EXPECT_EQ(stats["nonfinite_samples"], 0);
  EXPECT_EQ(stats["cut_paths"], 0);
  EXPECT_EQ(stats["cut_throughput"], 0);
  EXPECT_EQ(stats["scene_sha256"], image.metadata.at("scene_sha256"));
  EXPECT_EQ(stats["data_sha256"], data_sha256());
  EXPECT_EQ(image.metadata.at("data_sha256"), data_sha256());
  EXPECT_GE(stats["paths"], 24 * 16 * 8);
  EXPECT_GT(stats["rays"], 0);
  EXPECT_GT(stats["wall_s"], 0);
  EXPECT_GT(stats["cpu_s"], 0);
  EXPECT_TRUE(stats["embree_replay_share"].is_null());
  EXPECT_EQ(stats["photons_per_sample"], 0);
  EXPECT_EQ(stats["path_interval"], 1);
  EXPECT_EQ(stats["path_splitting"], 1);
  for (const char* part : {"load", "plan", "display", "write"}) {
    EXPECT_GT(stats["overhead"][part]["wall_s"], 0) << part;
    EXPECT_GT(stats["overhead"][part]["cpu_s"], 0) << part;
    EXPECT_LT(stats["overhead"][part]["wall_s"], stats["command"]["wall_s"]) << part;
  }
  EXPECT_GT(stats["relative_error"], 0);
  double sum = 0;
  for (const float y : image.find("Y")->values) sum += static_cast<double>(y);
  EXPECT_EQ(stats["film"].size(), 3U);
  EXPECT_NEAR(stats["film"]["Y"]["mean"], sum / (24 * 16), 1e-6 * sum);
  EXPECT_GT(stats["film"]["Y"]["standard_error"], 0);
  EXPECT_GT(stats["film"]["Y"]["half_interval_95"].get<double>(),
            1.95 * stats["film"]["Y"]["standard_error"].get<double>());
  EXPECT_GT(stats["display_exposure"], 0);
  EXPECT_TRUE(stats["half_noise_samples"].is_null()) << "a lit ball has many samples of its noise";
  EXPECT_TRUE(stats["hidden_noise"].is_null());
}

TEST(Render, ExpTimeIsTheExposure) {
  const auto exposed = [](const std::string& sensor) {
    const Outcome run = abbe("render " + ball() + " --quiet --set '/sensor={\"resolution\": [5, 4], " +
                             sensor + "}' -o " + file("exposed.exr"));
    EXPECT_EQ(run.code, 0) << run.err;
    const Image image = read_exr(file("exposed.exr"));
    const auto found = image.metadata.find("expTime");
    return found == image.metadata.end() ? "none" : found->second;
  };
  EXPECT_EQ(exposed(R"("observer": "1931", "exposure_s": 0.02)"), "0.02");
  const std::string filters = R"("channels": {"a": {"filters": [{"band": [400, 500]}], "exposure_s": 0.25},
      "b": {"filters": [{"band": [500, 600]}], "exposure_s": )";
  EXPECT_EQ(exposed(filters + "0.25}}"), "0.25");
  EXPECT_EQ(exposed(filters + "0.5}}"), "none");
}

TEST(Render, AMosaicHasOnePlaneThatTellsItsPattern) {
  const std::string sensor =
      R"( --set '/sensor={"resolution": [5, 4], "camera": "Nikon_D5100", "mosaic": [["R", "G"], ["G", "B"]]}')";
  const std::string render = "render " + ball() + sensor + " --quiet -o ";
  ASSERT_EQ(abbe(render + file("raw.exr")).code, 0);
  const Image image = read_exr(file("raw.exr"));
  ASSERT_EQ(image.channels.size(), 2U);
  EXPECT_NE(image.find("raw"), nullptr);
  EXPECT_NE(image.find("Variance.raw"), nullptr);
  EXPECT_EQ(image.metadata.at("mosaic"), "R,G/G,B");
  EXPECT_EQ(image.metadata.at("mosaic_channels"), "R,G,B");

  ASSERT_EQ(abbe(render + file("a.abbepart") + " --sample-range 0:3").code, 0);
  ASSERT_EQ(abbe(render + file("b.abbepart") + " --sample-range 3:8").code, 0);
  ASSERT_EQ(abbe("merge " + file("b.abbepart") + " " + file("a.abbepart") + " -o " + file("sum.exr")).code,
            0);
  EXPECT_EQ(read_exr(file("sum.exr")).find("raw")->values, image.find("raw")->values);
  EXPECT_EQ(read_exr(file("sum.exr")).metadata, image.metadata);
  const std::string other =
      "render " + ball() + sensor + " --set '/sensor/mosaic=[[\"G\", \"R\"], [\"B\", \"G\"]]'";
  ASSERT_EQ(abbe(other + " --quiet --sample-range 3:8 -o " + file("c.abbepart")).code, 0);
  EXPECT_EQ(abbe("merge " + file("a.abbepart") + " " + file("c.abbepart") + " -o " + file("sum.exr")).code,
            4);

  const Outcome shown = abbe(render + file("raw.exr") + " --display " + file("raw.png"));
  EXPECT_EQ(shown.code, 0) << shown.err;
  EXPECT_EQ(read_picture(file("raw.png")).channels.size(), 3U);
}

TEST(Render, ShowsThroughViewsAndUsersConfigurations) {
  const std::string render = "render " + ball() + " --quiet --seed 7 -o " + file("film.exr") + " --display ";
  const auto picture = [&](const std::string& name, const std::string& options,
                           const std::string& before = "") {
    const Outcome run = shell(before + ABBE_BINARY + " " + render + file(name) + options);
    EXPECT_EQ(run.code, 0) << run.err;
    return read_file(file(name));
  };
  const std::string plain = picture("plain.png", " --gamut " + file("gamut.png"));
  EXPECT_EQ(read_picture(file("gamut.png")).channels.size(), 1U);
  EXPECT_EQ(picture("same.png", " --screen 'sRGB - Display' --view Un-tone-mapped"), plain);
  const std::string aces = picture("aces.png", " --view 'ACES 1.0 - SDR Video'");
  EXPECT_NE(aces, plain);
  ASSERT_EQ(abbe("calibrate --camera observer:1931 -o " + file("users")).code, 0);
  const std::string config = file("users") + "/config.ocio";
  // The codes are the same, since a configuration of the user does not define how to read them.
  const auto expect_aces = [&](const std::string& name, const std::string& options,
                               const std::string& before = "") {
    EXPECT_EQ(picture(name, options, before).find("sRGB"), std::string::npos);
    const Image codes = read_picture(file(name));
    const Image own = read_picture(file("aces.png"));
    ASSERT_EQ(codes.channels.size(), 3U);
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(codes.channels[i].values, own.channels.at(i).values) << name;
  };
  expect_aces("option.png", " --view 'ACES 1.0 - SDR Video' --ocio " + config);
  expect_aces("variable.png", " --view 'ACES 1.0 - SDR Video'", "OCIO=" + config + " ");
  EXPECT_EQ(abbe(render + file("a.png") + " --view other").code, 2);
  EXPECT_EQ(abbe(render + file("a.png") + " --ocio /nowhere.ocio").code, 4);
  EXPECT_EQ(shell("OCIO=/nowhere.ocio " + (ABBE_BINARY " " + render) + file("a.png")).code, 4);
}

TEST(Render, AViewOfNoPictureIsRefused) {
  for (const char* option : {"--view", "--screen", "--ocio"}) {
    const Outcome run =
        abbe("render " + ball() + " --quiet -o " + file("film.exr") + " " + option + " nonsense");
    EXPECT_EQ(run.code, 2) << option;
    EXPECT_NE(run.err.find(std::string(option) +
                           ": applies to pictures only (allowed with --display, --gamut or --preview)"),
              std::string::npos)
        << run.err;
  }
}

TEST(Render, SameBitsAndOptionsThatChangeThem) {
  const std::string render = "render " + ball() + " --quiet -o ";
  ASSERT_EQ(abbe(render + file("one.exr") + " --threads 1").code, 0);
  ASSERT_EQ(abbe(render + file("two.exr") + " --threads 3").code, 0);
  ASSERT_EQ(abbe(render + file("seed.exr") + " --seed 1").code, 0);
  ASSERT_EQ(abbe(render + file("set.exr") + " --set /render/samples=16").code, 0);
  ASSERT_EQ(abbe(render + file("spp.exr") + " --spp 16").code, 0);
  EXPECT_EQ(read_exr(file("one.exr")).find("Y")->values, read_exr(file("two.exr")).find("Y")->values);
  EXPECT_NE(read_exr(file("one.exr")).find("Y")->values, read_exr(file("seed.exr")).find("Y")->values);
  EXPECT_EQ(read_exr(file("set.exr")).metadata.at("samples_per_pixel"), "16");
  EXPECT_EQ(read_exr(file("set.exr")).find("Y")->values, read_exr(file("spp.exr")).find("Y")->values);
  const Outcome same = abbe("compare " + file("one.exr") + " " + file("two.exr") + " --json");
  EXPECT_EQ(same.json()["relMSE"], 0);
  EXPECT_EQ(same.json()["mean_ratio"], 1);
  EXPECT_EQ(same.json()["dE00_max"], 0);
  const Outcome other = abbe("compare " + file("seed.exr") + " " + file("two.exr") + " --json");
  EXPECT_GT(other.json()["relMSE"], 0);
  EXPECT_GT(other.json()["dE00_mean"], 0);
  EXPECT_GE(other.json()["dE00_max"], other.json()["dE00_p95"]);
}

TEST(Render, CropLeavesTheRestBlack) {
  ASSERT_EQ(abbe("render " + ball() + " --quiet --crop 4,2,20,14 -o " + file("crop.exr")).code, 0);
  const Image image = read_exr(file("crop.exr"));
  EXPECT_EQ(image.find("Y")->values[0], 0);
  EXPECT_GT(image.find("Y")->values[24 * 8 + 12], 0);
  EXPECT_EQ(image.metadata.at("crop"), "4,2,20,14");
}

TEST(Render, StatsAreOfWhatWasRendered) {
  const auto figures = [](const std::string& options) {
    const std::string stats = file("figures.json");
    EXPECT_EQ(abbe("render " + ball() + " --quiet -o " + file("f.exr") + " --stats " + stats + options).code,
              0);
    return nlohmann::json::parse(std::ifstream(stats))["film"]["Y"];
  };
  const nlohmann::json found = figures(" --crop 4,2,20,14");
  const Image image = read_exr(file("f.exr"));
  double sum = 0;
  for (const float y : image.find("Y")->values) sum += static_cast<double>(y);
  EXPECT_NEAR(found["mean"].get<double>(), sum / (16 * 12), 1e-6 * sum);
  EXPECT_GT(found["standard_error"], 0);
  EXPECT_TRUE(figures(" --spp 1")["standard_error"].is_null());
}

TEST(Render, TimeAndErrorStopTheRender) {
  const std::string measured =
      "render " + ball() + " --quiet --stats " + file("error.json") + " -o " + file("error.exr");
  const auto stats = [] { return nlohmann::json::parse(read_file(file("error.json"))); };
  ASSERT_EQ(abbe(measured + " --error 5%").code, 0);
  EXPECT_LE(stats()["relative_error"], 0.05);
  EXPECT_GE(stats()["relative_error_p95"], stats()["relative_error"]);
  EXPECT_LT(stats()["frame_mean_error"], stats()["relative_error"]);
  EXPECT_EQ(std::stod(read_exr(file("error.exr")).metadata.at("frame_mean_error")),
            stats()["frame_mean_error"]);
  const int enough = stats()["samples_per_pixel"];
  ASSERT_EQ(abbe(measured + " --error 5% --time 1000s").code, 0) << "whichever comes first";
  EXPECT_EQ(stats()["samples_per_pixel"], enough);
  ASSERT_EQ(abbe(measured + " --error 0.0001% --time 0.3s").code, 0);
  EXPECT_GT(stats()["relative_error"], 1e-6);
  ASSERT_EQ(abbe("render " + ball() + " --quiet --time 0.3s -o " + file("time.exr")).code, 0);
  EXPECT_GT(std::stoi(read_exr(file("time.exr")).metadata.at("samples_per_pixel")), 8);
}

TEST(Render, AnErrorIsNotWaitedForWhereThereIsNoLight) {
  const auto dark = scratch().write("dark.json", R"({"abbe": 1,
    "camera": {"pinhole": {"fov_deg": 40}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
    "sensor": {"resolution": [8, 8], "observer": "1931"},
    "materials": {"white": {"diffuse": {"reflectance": 0.8}}},
    "lights": [{"point": {"at": [0, 0, -9]}, "emission": {"illuminant": "D65", "intensity": 1}}],
    "shapes": [{"quad": {"corner": [-20, -20, -1], "edge_u": [40, 0, 0], "edge_v": [0, 40, 0]}, "material": "white"}]})");
  const Outcome run = abbe("render " + dark.string() + " --quiet --error 1% -o " + file("dark.exr"));
  EXPECT_EQ(run.code, 0);
  EXPECT_NE(run.err.find("no light on the film"), std::string::npos) << run.err;
}

// `timeout` sends the signal. A signal before the render watches for it would kill the program, so the render
// has a second.
TEST(Render, SignalsLeaveAValidImageWithItsTrueSampleCount) {
  for (const auto& [name, code] : {std::pair{"INT", 130}, std::pair{"TERM", 143}}) {
    const std::string film = file(std::string(name) + ".exr");
    const Outcome run = shell(ABBE_BINARY " render " + ball() + " --quiet --spp 10000000 -o " + film +
                              " & pid=$!; sleep 1.5; kill -" + name + " $pid; wait $pid");
    EXPECT_EQ(run.code, code) << run.err;
    const Image image = read_exr(film);
    const int samples = std::stoi(image.metadata.at("samples_per_pixel"));
    EXPECT_GT(samples, 0);
    EXPECT_LT(samples, 10000000);
    EXPECT_GT(image.find("Y")->values[24 * 8 + 12], 0);
  }
}

TEST(Render, InfoTellsIntoHowManyCameraPathsGoOn) {
  const std::string box = (data_directory() / "scenes" / "cornell.json").string();
  EXPECT_EQ(abbe("info " + box + " --json").json()["path_splitting"], 8);
  EXPECT_NE(abbe("info " + box).out.find("splitting    camera paths continue in 8 directions "),
            std::string::npos);
  const Outcome rendered = abbe("render " + box + " --spp 1 --quiet --display " + file("box.png") + " -o " +
                                file("box.exr") + " --stats -");
  EXPECT_EQ(rendered.json()["path_splitting"], 8);
}

}  // namespace
}  // namespace abbe::test
