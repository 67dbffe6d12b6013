#include <functional>
#include <limits>

#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "tests/cli/program.h"
#include "tests/cli/scenes.h"

// Films that cannot be developed, and outputs that cannot be written.

namespace abbe::test {
namespace {

namespace fs = std::filesystem;

// Film of a scene with a readout, as a render writes it.
Image film_of_four_pixels() {
  Image image{2, 2, {}, {}};
  image.channels = {{"V", {1e12F, 2e12F, 3e12F, 4e12F}}, {"Variance.V", {1e20F, 1e20F, 1e20F, 1e20F}}};
  image.metadata = {{"sensor_channels", "V"},
                    {"channel.V", "quantum, electrons per m^2"},
                    {"exposure_s", "0.01"},
                    {"gathering_area_m2", "1e-9"},
                    {"to_xyz_d65", "0.95 0 0 1 0 0 1.09 0 0"},
                    {"sensor", R"({"readout": {"gain_e_per_dn": 1, "bits": 12}})"}};
  return image;
}

Outcome develop(const Image& image, const std::string& options) {
  write_exr(file("fault.exr"), image);
  return abbe("develop " + file("fault.exr") + " " + options);
}

TEST(DevelopFaults, TheFilmItselfIsFine) {
  EXPECT_EQ(develop(film_of_four_pixels(), "-o " + file("fine.tif") + " --display " + file("fine.png")).code,
            0);
}

TEST(DevelopFaults, FilmsThatLackSomethingAreNamed) {
  struct Fault {
    std::function<void(Image&)> make;
    std::string says;
    int code = 4;
  };
  const auto without = [](const std::string& key) {
    return Fault{[key](Image& image) { image.metadata.erase(key); }, "no attribute \"" + key + "\""};
  };
  const auto with = [](const std::string& key, const std::string& value) {
    return Fault{[=](Image& image) { image.metadata[key] = value; },
                 "attribute \"" + key + "\" makes no sense (got \"" + value + "\")"};
  };
  const auto pixel = [](const char* channel, float value) {
    return [=](Image& image) {
      for (ImageChannel& c : image.channels)
        if (c.name == channel) c.values[1] = value;
    };
  };
  for (const Fault& fault : std::vector<Fault>{
           {[](Image& image) { image.channels.front().name = "W"; }, "has no channel \"V\""},
           {[](Image& image) { image.channels.pop_back(); }, "has no channel \"Variance.V\""},
           {pixel("V", std::numeric_limits<float>::quiet_NaN()),
            "channel \"V\" has a value that is not finite at pixel 1,0 (got nan)"},
           {pixel("V", std::numeric_limits<float>::infinity()),
            "channel \"V\" has a value that is not finite at pixel 1,0 (got inf)"},
           {pixel("Variance.V", -1), "channel \"Variance.V\" has a negative variance at pixel 1,0 (got -1)"},
           {pixel("V", 1e30F), "pixel 1 expects"},
           without("sensor_channels"),
           without("exposure_s"),
           without("gathering_area_m2"),
           without("sensor"),
           without("channel.V"),
           with("exposure_s", "-1"),
           with("exposure_s", "soon"),
           with("gathering_area_m2", "0"),
           with("to_xyz_d65", "1 2 3"),
           with("display_exposure", "bright"),
           with("exposure_s.V", "x"),
           {[](Image& image) {
              image.metadata["sensor_channels"] = "V,R,G";
              for (const char* name : {"R", "G"}) {
                image.metadata["channel." + std::string(name)] = "quantum, electrons per m^2";
                image.channels.push_back({name, image.channels[0].values});
                image.channels.push_back({"Variance." + std::string(name), image.channels[1].values});
              }
            },
            "fault.exr: attribute \"to_xyz_d65\" makes no sense"},
           {[](Image& image) {
              image.metadata["mosaic"] = "V,W";
              image.metadata["mosaic_channels"] = "V";
            },
            "attribute \"mosaic\" makes no sense"},
           {[](Image& image) { image.metadata["sensor"] = "{"; }, "fault.exr: sensor:1:2: error", 3},
           {[](Image& image) { image.metadata["sensor"] = R"({"readout": {"bits": 12}})"; },
            "fault.exr: sensor:1:13: /readout: error: missing key \"gain_e_per_dn\"", 3},
           {[](Image& image) { image.metadata["channel.V"] = "energy"; },
            "channel \"V\" counts no electrons"}}) {
    Image image = film_of_four_pixels();
    fault.make(image);
    fs::remove(file("none.tif"));
    const Outcome run = develop(image, "-o " + file("none.tif"));
    EXPECT_EQ(run.code, fault.code) << fault.says << '\n' << run.err;
    EXPECT_NE(run.err.find(fault.says), std::string::npos) << fault.says << '\n' << run.err;
    EXPECT_FALSE(fs::exists(file("none.tif"))) << fault.says;
  }
}

TEST(DevelopFaults, FilesThatAreNoFilmsAreInputErrors) {
  write_exr(file("whole.exr"), film_of_four_pixels());
  const std::string bytes = read_file(file("whole.exr"));
  (void)scratch().write("cut.exr", bytes.substr(0, bytes.size() - 10));
  (void)scratch().write("text.exr", "no film");
  (void)scratch().write("empty.exr", "");
  write_exr(file("others.exr"),
            std::vector<ExrPart>{{"left", film_of_four_pixels()}, {"right", film_of_four_pixels()}});
  fs::create_directories(file("folder.exr"));
  for (const char* name : {"cut.exr", "text.exr", "empty.exr", "others.exr", "folder.exr", "absent.exr"}) {
    const Outcome run = abbe("develop " + file(name) + " --display " + file("none.png"));
    EXPECT_EQ(run.code, 4) << name << run.err;
    EXPECT_NE(run.err.find(name), std::string::npos) << run.err;
    EXPECT_FALSE(fs::exists(file("none.png")));
  }
  EXPECT_NE(abbe("develop " + file("others.exr")).err.find("has no part \"exposure\""), std::string::npos);
}

// Files of a few hundred bytes that declare gigabytes.
TEST(DevelopFaults, BombsAreRefusedBeforeTheyGoOff) {
  Imf::Header header(65536, 4096);
  for (int i = 0; i < 9; ++i) header.channels().insert("C" + std::to_string(i), Imf::Channel(Imf::FLOAT));
  { const Imf::OutputFile bomb(file("bomb.exr").c_str(), header); }
  const Outcome run = shell("(ulimit -v 1048576; " ABBE_BINARY " develop " + file("bomb.exr") + ")");
  EXPECT_EQ(run.code, 6) << run.err;
  EXPECT_NE(run.err.find("image too large"), std::string::npos) << run.err;
}

TEST(DevelopFaults, OutputsAreCheckedFirst) {
  for (const auto& [options, code] :
       std::vector<std::pair<std::string, int>>{{"-o " + file("a.jpg"), 2},
                                                {"--display " + file("a.exr"), 2},
                                                {"-o " + file("a.tif") + " -o " + file("a.tif"), 2},
                                                {"-o " + file("a.tif") + " --display " + file("a.tif"), 2},
                                                {"-o " + file("fault.exr"), 2},
                                                {"-o /nonexistent/a.tif", 5},
                                                {"-o " + file("folder.exr"), 5},
                                                {"--scene " + file("fault.exr"), 2},
                                                {"--seed -1", 2}}) {
    fs::create_directories(file("folder.exr"));
    const Outcome run = develop(film_of_four_pixels(), options);
    EXPECT_EQ(run.code, code) << options << '\n' << run.err;
    EXPECT_FALSE(fs::exists(file("a.tif"))) << options;
  }
}

TEST(DevelopFaults, APngTakesOnePlaneOrThree) {
  Image image = film_of_four_pixels();
  image.metadata["sensor_channels"] = "V,W";
  image.metadata["channel.W"] = image.metadata["channel.V"];
  image.metadata.erase("to_xyz_d65");
  image.channels.push_back({"W", image.channels[0].values});
  image.channels.push_back({"Variance.W", image.channels[1].values});
  EXPECT_EQ(develop(image, "-o " + file("two.tif")).code, 0);
  const Outcome run = develop(image, "-o " + file("two.png"));
  EXPECT_EQ(run.code, 5);
  EXPECT_NE(run.err.find("one or three channels"), std::string::npos) << run.err;
  const Outcome shown = develop(image, "--display " + file("two.png"));
  EXPECT_EQ(shown.code, 2);
  EXPECT_NE(shown.err.find("a picture needs a sensor of one or three channels"), std::string::npos)
      << shown.err;
}

TEST(DevelopFaults, AFullDiskKeepsTheOldFiles) {
  (void)scratch().write("old.tif", "old");
  (void)scratch().write("old.exr", "old");
  write_exr(file("fault.exr"), film_of_four_pixels());
  const Outcome run = shell("(ulimit -f 0; " ABBE_BINARY " develop " + file("fault.exr") + " -o " +
                            file("old.tif") + " -o " + file("old.exr") + "; echo $?) 2>&1 | cat");
  EXPECT_TRUE(run.out.ends_with("\n5\n")) << run.out;
  EXPECT_EQ(read_file(file("old.tif")), "old");
  EXPECT_EQ(read_file(file("old.exr")), "old");
}

}  // namespace
}  // namespace abbe::test
