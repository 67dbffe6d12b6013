#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/exr.h"
#include "io/picture.h"
#include "io/raw_picture.h"
#include "sensor/film/crop.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"

// Sensors and lenses measured from images with known properties.

namespace abbe::test {
namespace {

constexpr int kEdge = 64;

// A frame in which alternate pixels lie above and below the mean by this number of codes.
std::string frame(const std::string& name, double mean, double apart, double exposure_s, int edge = kEdge) {
  Image image{edge, edge, {{"Y", {}}}, {}};
  for (int i = 0; i < edge * edge; ++i)
    image.channels[0].values.push_back(static_cast<float>(i % 2 == 0 ? mean + apart : mean - apart));
  image.metadata = {{"exposure_s", fmt::format("{}", exposure_s)},
                    {"sensor", R"({"readout":{"bits":12,"offset_dn":50}})"}};
  write_raw_picture(file(name), image);
  return file(name);
}

// Two frames that differ by +-2 `apart`. Their temporal variance is exactly 2 apart^2 n/(n - 1).
std::string pair(const std::string& name, double mean, double apart, double exposure_s) {
  return frame(name + "_a.tif", mean, apart, exposure_s) + " " +
         frame(name + "_b.tif", mean, -apart, exposure_s) + " ";
}

std::string dark_pairs() {
  return "--dark " + pair("short", 50, 1, 0.01) + pair("long", 53, 1, 1.01);
}

TEST(Transfer, FindsWhatTheFramesWereMadeOf) {
  // The variances are 18 and 50 above the 2 of the dark frames, at 160 and 480 codes: ten electrons per code.
  const Outcome run =
      abbe("transfer " + dark_pairs() + "--lit " + pair("weak", 210, 3, 0.01) + pair("half", 530, 5, 0.01) +
           pair("most", 1010, 7, 0.01) + pair("over", 4095, 0, 0.01) + "--json");
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json found = run.json();
  constexpr double kPixels = kEdge * kEdge;
  constexpr double kOfAll = kPixels / (kPixels - 1);
  const double gain = 10 / kOfAll;
  EXPECT_NEAR(found["gain_e_per_dn"][0], gain, 1e-9);
  EXPECT_NEAR(found["read_noise_e"][0], gain * std::sqrt(2 * kOfAll - 1.0 / 12), 1e-9);
  EXPECT_NEAR(found["dark_e_per_s"][0], 3 * gain, 1e-9);
  EXPECT_EQ(found["gain_standard_error"][0], 0) << "two values alone have a variance without error";
  EXPECT_EQ(found["read_noise_standard_error"][0], 0);
  EXPECT_EQ(found["prnu_percent"][0], 0);
  EXPECT_TRUE(found["full_well_e"][0].is_null()) << "the codes end first";
  const double most_e = (4095 - 50) * gain;
  EXPECT_NEAR(found["dynamic_range_db"][0], 20 * std::log10(most_e / found["read_noise_e"][0].get<double>()),
              0.01);
  EXPECT_EQ(run.err, "");
}

TEST(Transfer, LightThatSaturatesNothingTellsNoRange) {
  const Outcome run = abbe("transfer " + dark_pairs() + "--lit " + pair("weak", 210, 3, 0.01) +
                           pair("half", 530, 5, 0.01) + pair("most", 1010, 7, 0.01) + "--json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(run.json()["full_well_e"][0].is_null());
  EXPECT_TRUE(run.json()["dynamic_range_db"][0].is_null());
  EXPECT_NE(run.err.find("warning: no flat pair saturates Y, so that full well and dynamic range are "
                         "unknown: add a pair above saturation"),
            std::string::npos)
      << run.err;
}

// The signal after t seconds is 400 t - 4 t^2 codes, 1 % below a line for each second. A separate calculation
// gave the expected LE of four pairs and the bias of a gain from three.
constexpr double kBentLinearityError = 0.38448740;
constexpr double kBentBias = 0.08246962;
TEST(Transfer, AResponseThatIsNotLinearIsWarnedOf) {
  const auto run_with = [](double bend) {
    std::string lit;
    for (const int t : {1, 2, 3, 4, 5})
      lit += pair(fmt::format("bend{}", t), 50 + 400 * t - bend * t * t, 2 + t, t);
    return abbe("transfer --dark " + pair("short", 50, 1, 0.01) + pair("long", 50, 1, 1) + "--lit " + lit +
                pair("over", 4095, 0, 6) + "--json");
  };
  const Outcome straight = run_with(0);
  EXPECT_EQ(straight.err, "");
  EXPECT_NEAR(straight.json()["linearity_error_percent"][0], 0, 1e-9);
  const Outcome bent = run_with(4);
  EXPECT_NEAR(bent.json()["linearity_error_percent"][0], kBentLinearityError, 1e-6);
  const double gain = bent.json()["gain_e_per_dn"][0];
  EXPECT_NE(
      bent.err.find(fmt::format("warning: Y does not respond linearly, so that its gain and all its figures "
                                "in electrons are {:.2g} % too large (the gain in weak light is {:.5g} e/DN)",
                                100 * kBentBias, gain / (1 + kBentBias))),
      std::string::npos)
      << bent.err;
}

void expect_fault(const std::string& arguments, int code, const std::string& message) {
  const Outcome run = abbe(arguments);
  EXPECT_EQ(run.code, code) << arguments << '\n' << run.err;
  EXPECT_NE(run.err.find(message), std::string::npos) << arguments << '\n' << run.err;
}

TEST(Transfer, FaultsAreNamed) {
  const std::string lit = pair("lit", 530, 5, 0.01);
  expect_fault("transfer " + dark_pairs() + "--lit " + frame("lit_a.tif", 530, 5, 0.01) + " " +
                   frame("small.tif", 530, -5, 0.01, kEdge / 2),
               4, "small.tif: has other pixels or channels than the first frame");
  expect_fault("transfer " + dark_pairs() + "--lit " + pair("dim", 50, 1, 0.01), 4,
               "no illuminated pair lies between darkness and saturation");
  expect_fault("transfer --dark " + pair("short", 50, 1, 0.01) + "--lit " + lit, 4,
               "dark pairs have only one exposure time");
  expect_fault("transfer " + dark_pairs() + "--lit " + lit, 4,
               "no illuminated pair is below 0.7 of the saturation signal, taken as the 480 DN "
               "where the codes scatter most: add pairs at weaker light (1 illuminated pair given)");
  expect_fault("transfer " + dark_pairs(), 2, "--lit");
  expect_fault("transfer " + dark_pairs() + "--lit " + file("absent.tif"), 4, "absent.tif");
}

// A row of three patches with 12-bit codes in a 16-bit file, with noise of some codes. One patch has the
// highest code in all pixels, another in every second pixel.
TEST(Measure, PatchesAtAHighestCodeThatNoFileDeclaresAreClipped) {
  const std::string chart = scratch()
                                .write("clipped.csv",
                                       "# unit: reflectance factor\n# outside: clamp\n"
                                       "wavelength_nm,dark,bright,brighter\n380,.2,.5,.9\n780,.2,.5,.9\n")
                                .string();
  RawPicture raw;
  raw.width = 60;
  raw.height = 20;
  raw.planes = raw.channels = {"mono"};
  raw.black_level_dn = 256;
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 60; ++x) {
      const int noise = (7 * x + 3 * y) % 11;
      const int code = x < 20 ? 2000 + noise : x < 40 ? (noise < 5 ? 4090 + noise : 4095) : 4095;
      raw.codes.push_back(static_cast<std::uint16_t>(code));
    }
  const auto run_with = [&](double white) {
    raw.white_level_dn = white;
    write_fits(file("clipped.fits"), raw);
    return abbe("measure " + file("clipped.fits") + " --chart " + chart +
                " --columns 3 --corners 0,0,60,0,60,20,0,20 --json");
  };
  for (const double white : {65535.0, 4095.0}) {
    const Outcome run = run_with(white);
    ASSERT_EQ(run.code, 0) << run.err;
    const nlohmann::json patches = run.json()["patches"];
    EXPECT_EQ(patches[0]["saturated"][0], 0) << white;
    EXPECT_GT(patches[1]["saturated"][0], 0) << white;
    EXPECT_EQ(patches[2]["saturated"][0], patches[2]["pixels"][0]) << white;
    EXPECT_EQ(run.err.find("the picture clips at 3839 in mono, not at the 65279 that the file declares") !=
                  std::string::npos,
              white == 65535)
        << run.err;
    EXPECT_NE(run.err.find("saturated pixels make the means too low in bright, brighter"), std::string::npos)
        << run.err;
  }
  raw.codes.assign(raw.codes.size(), 0);
  for (std::size_t i = 0; i < raw.codes.size(); ++i)
    raw.codes[i] = static_cast<std::uint16_t>(1500 + 500 * (i % 60 / 20) + 7 * i % 11);
  const Outcome low = run_with(1400);
  EXPECT_NE(low.err.find("patches in mono differ at values up to 22"), std::string::npos) << low.err;
  EXPECT_NE(low.err.find("although the file declares saturation from 1144"), std::string::npos) << low.err;
}

// The centre of a patch whose cell has three by three pixels contains one pixel.
TEST(Measure, PatchesOfOnePixelHaveNoDeviation) {
  const std::vector<float> values(18 * 12, 0.5F);
  write_exr(file("fine.exr"), {18, 12, {{"R", values}, {"G", values}, {"B", values}}, {}});
  const std::string fine = "measure " + file("fine.exr") +
                           " --chart colorchecker24_babelcolor_average --corners 0,0,18,0,18,12,0,12";
  const Outcome told = abbe(fine + " --json");
  ASSERT_EQ(told.code, 0) << told.err;
  const nlohmann::json patch = told.json()["patches"][0];
  EXPECT_EQ(patch["pixels"], (std::vector<int>{1, 1, 1}));
  EXPECT_EQ(patch["deviation"], nlohmann::json::array({nullptr, nullptr, nullptr}));
  const Outcome run = abbe(fine + " -o " + file("fine.csv"));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_NE(run.out.find(fmt::format("0.5 {:>12} {:>7}", "-", 1)), std::string::npos) << run.out;
  const std::string table = read_file(file("fine.csv"));
  EXPECT_NE(table.find("\"dark skin\",0.5,0.5,0.5,,,,1,1,1,0,0,0\n"), std::string::npos) << table;
}

// An edge slanted by 5 degrees and blurred by a Gaussian. The values are sampled at the pixel centres, so
// that the Gaussian alone determines the MTF. A second plane has no edge.
std::string blurred_edge(double deviation, const std::string& areas = "") {
  const double angle = 5 * std::numbers::pi / 180;
  Image image{kEdge, 2 * kEdge, {{"G", {}}, {"flat", {}}}, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const double distance = (x + 0.5 - kEdge / 2.0) * std::cos(angle) - (y + 0.5 - kEdge) * std::sin(angle);
      image.channels[0].values.push_back(
          static_cast<float>(0.1 + 0.4 * std::erfc(-distance / deviation / std::sqrt(2.0))));
      image.channels[1].values.push_back(0.5F);
    }
  if (!areas.empty()) image.metadata[kAreasKey] = areas;
  write_exr(file("edge.exr"), image);
  return file("edge.exr");
}

TEST(Mtf, IsThatOfTheBlur) {
  constexpr double kDeviation = 0.7;
  const Outcome run = abbe("mtf " + blurred_edge(kDeviation) + " --plot " + file("mtf.svg") + " --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json found = run.json();
  EXPECT_NEAR(std::abs(found["angle_deg"].get<double>()), 5, 0.02);
  EXPECT_EQ(found["edge"], "vertical");
  const double half = std::sqrt(std::log(2.0) / 2) / std::numbers::pi / kDeviation;
  EXPECT_NEAR(found["mtf50"], half, 0.003);
  for (std::size_t i = 0; i < found["mtf"].size(); ++i) {
    const double frequency = found["frequency"][i];
    if (frequency > 0.5) break;
    const double blur = std::numbers::pi * frequency * kDeviation;
    EXPECT_NEAR(found["mtf"][i], std::exp(-2 * blur * blur), 0.01) << frequency;
  }
  EXPECT_NE(read_file(file("mtf.svg")).find("<svg"), std::string::npos);
  const nlohmann::json part = abbe("mtf " + file("edge.exr") + " --crop 8,16,56,112 --json").json();
  EXPECT_NEAR(part["mtf50"], half, 0.005);
}

// The ratio of code values with a tone curve is not that of light.
TEST(MeasureFlat, CodesThatNobodyCallsLinearAreWarnedOf) {
  Image image{96, 64, {}, {}};
  for (const char* name : {"R", "G", "B"})
    image.channels.push_back({name, std::vector<float>(96 * 64, 0.5F)});
  write_exr(file("even.exr"), image);
  write_picture(file("shown.png"), image);
  write_picture(file("shown_flat.png"), image);
  image.metadata = {{"oiio:ColorSpace", "Linear"}};
  write_picture(file("even.png"), image);
  const std::string chart = " --chart colorchecker24_babelcolor_average --corners 0,0,96,0,96,64,0,64";
  const auto warnings = [&](const std::string& name, const std::string& flat) {
    const Outcome run = abbe("measure " + file(name) + " --flat " + file(flat) + chart);
    EXPECT_EQ(run.code, 0) << run.err;
    return run.err;
  };
  const auto warning = [](const std::string& name) {
    return file(name) +
           ": warning: its values are code values of a picture and count as linear, but code values for "
           "displays are not linear: --flat divides light, so use raw files, or pictures that declare that "
           "they "
           "are linear\n";
  };
  EXPECT_EQ(warnings("shown.png", "shown_flat.png"), warning("shown_flat.png") + warning("shown.png"));
  EXPECT_EQ(warnings("even.png", "shown_flat.png"), warning("shown_flat.png"));
  EXPECT_EQ(warnings("even.png", "even.png"), "");
  EXPECT_EQ(warnings("even.exr", "even.exr"), "");
  EXPECT_EQ(abbe("measure " + file("shown.png") + chart).err, "") << "as values that a series makes linear";
}

TEST(Mtf, CodesThatNobodyCallsLinearAreWarnedOf) {
  Image image = read_exr(blurred_edge(0.7));
  image.channels.assign(1, *image.find("G"));
  write_picture(file("shown.png"), image);
  const std::string warning = file("shown.png") +
                              ": warning: its values are code values of a picture and count as linear, "
                              "but code values for displays are not linear: use a film";
  EXPECT_NE(abbe("mtf " + file("shown.png")).err.find(warning), std::string::npos);
  for (float& value : image.channels[0].values) value = std::round(4000 * value);
  image.metadata = {{"sensor", R"({"readout":{"bits":12}})"}, {"white_level_dn", "4095"}};
  write_raw_picture(file("codes.tif"), image);
  for (const std::string& linear : {file("edge.exr"), file("codes.tif")})
    EXPECT_EQ(abbe("mtf " + linear).err, "") << linear;
}

// The edge of clipped codes is not the edge of the light.
TEST(Mtf, ASaturatedEdgeIsWarnedOf) {
  const Image edge = read_exr(blurred_edge(0.7));
  const auto warning_of = [&](const std::string& name, const std::map<std::string, std::string>& told,
                              const std::function<double(double)>& code) {
    Image image{edge.width, edge.height, {*edge.find("G")}, told};
    for (float& value : image.channels[0].values)
      value = static_cast<float>(std::round(code(static_cast<double>(value))));
    write_raw_picture(file(name), image);
    return abbe("mtf " + file(name)).err;
  };
  const std::string warning =
      "abbe: warning: {}: the bright side of the edge {} saturated, which distorts the MTF (got ";
  const std::string told_level =
      " % of the pixels at the white level or above, allowed 1 %): use a shorter exposure\n";
  const auto cut_at = [](double highest, double scale = 6000) {
    return [=](double value) { return std::min(highest, scale * value); };
  };
  const std::map<std::string, std::string> told{{"sensor", R"({"readout":{"bits":12}})"},
                                                {"white_level_dn", "3500"}};
  for (const double well : {3500.0, 3510.0}) {
    const std::string full = warning_of("well.tif", told, cut_at(well));
    EXPECT_TRUE(full.starts_with(fmt::format(fmt::runtime(warning), file("well.tif"), "is"))) << full;
    EXPECT_TRUE(full.ends_with(told_level)) << full;
  }
  EXPECT_EQ(warning_of("below.tif", told, cut_at(3499)), "") << "the well is not full";
  EXPECT_EQ(warning_of("hot.tif", told,
                       [hot = 0](double value) mutable { return hot++ % 1000 == 0 ? 4095 : 3000 * value; }),
            "");
  const std::string shown = warning_of("shown.png", {}, cut_at(65535, 100000));
  EXPECT_TRUE(shown.starts_with(fmt::format(fmt::runtime(warning), file("shown.png"), "may be"))) << shown;
  EXPECT_NE(shown.find(" % of the pixels at the highest code, allowed 1 %)"), std::string::npos) << shown;
}

// Pixels that a film lacks are black, which would be another edge.
TEST(Mtf, LooksAtWhatAFilmHas) {
  const std::string within = " --crop 8,16,56,112 --json";
  const std::string whole = abbe("mtf " + blurred_edge(0.7) + within).out;
  EXPECT_EQ(abbe("mtf " + blurred_edge(0.7, "8,16,56,112=0:4") + " --json").out, whole);
  const std::string gaps = blurred_edge(0.7, "8,16,56,60=0:4 0,60,64,112=0:4 0,120,4,124=0:4");
  EXPECT_EQ(abbe("mtf " + gaps + within).out, whole);
  const std::string allowed = "allowed within 8,16,56,60 0,60,64,112 0,120,4,124";
  expect_fault("mtf " + gaps, 2, "--crop: got no rectangle for a film with gaps, " + allowed);
  expect_fault("mtf " + gaps + " --crop 8,15,56,112", 2, "--crop: got 8,15,56,112, " + allowed);
}

// Film of the edge of a lamp, slanted by 5 degrees, recorded by a sensor with three channels.
std::string film_of_edge(const std::string& name, const std::string& mosaic) {
  const std::string scene = R"({"abbe": 1,
      "camera": {"pinhole": {"fov_deg": 20}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
      "sensor": {"resolution": [64, 64], "pixel_pitch_um": 10, "quantum_efficiency": 0.5,
                 "channels": {"R": {"band": [600, 680]}, "G": {"band": [500, 590]},
                              "B": {"band": [400, 500]}},
                 "readout": {"gain_e_per_dn": 2, "bits": 14}, "exposure_s": 0.01)" +
                            mosaic + R"(},
      "lights": [{"quad": {"corner": [-0.1743, 0, -1.9924], "edge_u": [1.9924, 0, -0.1743],
                           "edge_v": [0.3486, 0, 3.9848]},
                  "emission": {"illuminant": "E", "luminance": 100}}],
      "render": {"samples": 64}})";
  return film_of(scratch().write(name + ".json", scene).string(), name);
}

TEST(Mtf, OfAMosaicTheAdviceHelps) {
  const std::string mosaic = film_of_edge("mosaic", R"(, "mosaic": [["R", "G"], ["G", "B"]])");
  developed(mosaic + " -o " + file("mosaic.dng") + " -o " + file("mosaic.tif"));
  const std::string advice =
      "is a mosaic, whose neighbouring pixels belong to different channels (allowed: a film of a sensor "
      "without a mosaic, or a linear picture from a raw converter)";
  for (const std::string& path : {mosaic, file("mosaic.dng"), file("mosaic.tif")})
    expect_fault("mtf " + path, 4, path + ": " + advice);
  const Outcome film = abbe("mtf " + film_of_edge("channels", "") + " --json");
  ASSERT_EQ(film.code, 0) << film.err;
  EXPECT_NEAR(std::abs(film.json()["angle_deg"].get<double>()), 5, 0.2);
  Image converted = read_exr(blurred_edge(0.7));
  for (ImageChannel& channel : converted.channels)
    for (float& value : channel.values) value = std::round(60000 * value);
  converted.channels.assign(3, *converted.find("G"));
  write_raw_picture(file("converted.tif"), converted);
  const Outcome picture = abbe("mtf " + file("converted.tif") + " --json");
  ASSERT_EQ(picture.code, 0) << picture.err;
  EXPECT_NEAR(std::abs(picture.json()["angle_deg"].get<double>()), 5, 0.02);
}

// Files sort channels alphabetically, with capitals first.
TEST(Mtf, LooksAtTheFirstPlaneAndNoVariance) {
  Image film = read_exr(blurred_edge(0.7));
  ImageChannel pan = *film.find("G");
  pan.name = "pan";
  film.channels = {{"Variance.pan", std::vector<float>(pan.values.size(), 1)}, pan};
  film.metadata["sensor_channels"] = "pan";
  write_exr(file("pan.exr"), film);
  EXPECT_EQ(abbe("mtf " + file("pan.exr") + " --json").out,
            abbe("mtf " + file("pan.exr") + " --channel pan --json").out);
}

TEST(Mtf, FaultsAreNamed) {
  const std::string edge = blurred_edge(0.7);
  expect_fault("mtf " + edge + " --channel flat", 4, "there is no edge in these pixels");
  expect_fault("mtf " + edge + " --channel R", 2, "--channel: got \"R\", allowed G, flat");
  expect_fault("mtf " + edge + " --crop 0,0,65,20", 2, "--crop: got 0,0,65,20, allowed within 0,0,64,128");
  expect_fault("mtf " + edge + " --crop 0,0,8,8", 4, "16");
  expect_fault("mtf " + file("absent.exr"), 4, "absent.exr");
}

}  // namespace
}  // namespace abbe::test
