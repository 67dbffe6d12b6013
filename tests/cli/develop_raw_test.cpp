#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "calibration/chart/raw_scale.h"
#include "io/exr.h"
#include "io/picture.h"
#include "io/raw_picture.h"
#include "tests/cli/program.h"
#include "tests/cli/runs.h"
#include "tests/tier.h"

// Raw files read by other programs, and films developed with another exposure.

namespace abbe::test {
namespace {

constexpr const char* kMosaic =
    R"("model": "dslr_apsc_bayer_14bit", "pixel_pitch_um": 240, "exposure_s": 0.001,
       "readout": {"gain_e_per_dn": 10, "full_well_e": 1e6, "serial": 2})";
constexpr const char* kTwo =
    R"("response": "quantum", "channels": {"a": {"band": [600, 700]}, "b": {"band": [500, 600]}},
       "readout": {"gain_e_per_dn": 50, "bits": 12, "offset_dn": 50, "read_noise_e": 90})";

// A film of 48 x 32 pixels of a ball in front of a uniform environment.
std::string ball_film(const std::string& name, const std::string& sensor, const std::string& options = "") {
  const std::string scene =
      scratch()
          .write(
              name + ".json",
              R"({"abbe": 1, "camera": {"thin_lens":
      {"focal_length": 0.05, "f_number": 4}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]},
      "sensor": {)" +
                  std::string(sensor.find("resolution") == sensor.npos ? R"("resolution": [48, 32], )" : "") +
                  sensor + R"(},
      "materials": {"white": {"diffuse": {"reflectance": 0.5}}},
      "lights": [{"environment": {}, "emission": {"illuminant": "D65", "radiance": 0.1}}],
      "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 0.1}, "material": "white"}],
      "render": {"samples": 8}})")
          .string();
  return film_of(scene, name, options);
}

std::vector<int> codes_of(const std::string& path, std::size_t plane = 0) {
  const Image picture = read_picture(path);
  std::vector<int> codes;
  for (const float value : picture.channels.at(plane).values)
    codes.push_back(static_cast<int>(std::lround(value * 65535)));
  return codes;
}

bool has(const std::string& program) {
  return shell("command -v " + program).code == 0;
}

std::string python_list(const std::vector<int>& numbers) {
  return fmt::format("[{}]", fmt::join(numbers, ","));
}

TEST(DevelopRaw, LibRawReadsTheCodesOfADng) {
  if (!has("unprocessed_raw")) GTEST_SKIP() << "libraw-bin is not installed";
  const std::string path = ball_film("libraw", kMosaic);
  developed(path + " -o " + file("raw.dng") + " -o " + file("raw.tif"));
  const Outcome run = shell("unprocessed_raw -T " + file("raw.dng"));
  ASSERT_EQ(run.code, 0) << run.err;
  const std::vector<int> codes = codes_of(file("raw.tif"));
  EXPECT_EQ(codes_of(file("raw.dng.tiff")), codes);
  EXPECT_GT(*std::max_element(codes.begin(), codes.end()), 5000);
  const std::string told = shell("raw-identify -v " + file("raw.dng")).out;
  for (const char* line :
       {"DNG Version: 1.4", "Shutter: 1/1000.0", "Aperture: f/4.0", "Filter pattern: RGGBRGGBRGGBRGGB",
        "Camera: Abbe dslr_apsc_bayer_14bit", "Full size:     48 x 32"})
    EXPECT_NE(told.find(line), std::string::npos) << line << '\n' << told;
}

// LibRaw converts the file with its own white balance and matrix. The colours must be those of our picture.
TEST(DevelopRaw, LibRawFindsTheColoursOfADng) {
  if (!has("dcraw_emu")) GTEST_SKIP() << "libraw-bin is not installed";
  const std::string path = ball_film("colours", kMosaic, "--spp 64");
  developed(path + " -o " + file("colour.dng"));
  const Outcome run = shell("dcraw_emu -w -o 1 -4 -q 0 -W -T " + file("colour.dng"));
  ASSERT_EQ(run.code, 0) << run.err;
  const Image picture = read_picture(file("colour.dng.tiff"));
  ASSERT_EQ(picture.channels.size(), 3U);
  const auto mean = [&](std::size_t k) {
    const std::vector<float>& values = picture.channels[k].values;
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  EXPECT_GT(mean(1), 0.01);
  EXPECT_LT(mean(1), 0.95);
  EXPECT_NEAR(mean(0) / mean(1), 1, 0.02) << "the light is the white";
  EXPECT_NEAR(mean(2) / mean(1), 1, 0.02);
}

TEST(DevelopRaw, RawspeedReadsADng) {
  if (!has("darktable-rs-identify")) GTEST_SKIP() << "darktable is not installed";
  const std::string path = ball_film("rawspeed", kMosaic);
  developed(path + " -o " + file("rs.dng") + " -o " + file("rs.tif"));
  const Outcome run = shell("darktable-rs-identify " + file("rs.dng"));
  ASSERT_EQ(run.code, 0) << run.out << run.err;
  long sum = 0;
  long codes = 0;
  for (const int code : codes_of(file("rs.tif"))) {
    sum += (code & 255) + (code >> 8);
    codes += code;
  }
  for (const std::string& line :
       {std::string("dimUncropped: 48x32"), std::string("blackLevelSeparate: 600 600 600 600"),
        std::string("whitePoint: 16300"), fmt::format("Image byte sum: {}.", sum),
        fmt::format("Image uint16_t sum: {}.", codes)})
    EXPECT_NE(run.out.find(line), std::string::npos) << line << '\n' << run.out;
}

TEST(DevelopRaw, AstropyReadsTheCodesOfAFitsFile) {
  if (shell("/usr/bin/python3 -c 'import astropy'").code != 0)
    GTEST_SKIP() << "python3-astropy is not installed";
  const std::string path = ball_film("fits", kTwo);
  developed(path + " -o " + file("raw.fits") + " -o " + file("two.tif"));
  const std::string script = scratch()
                                 .write("fits.py", R"(
import sys
from astropy.io import fits
image = fits.open(sys.argv[1])[0]
print(image.data.shape, image.header['GAIN'], image.header['PEDESTAL'], image.header['SATURATE'], image.header['RDNOISE'])
print([int(x) for x in image.data[1].ravel()])
)")
                                 .string();
  const Outcome run = shell("/usr/bin/python3 " + script + " " + file("raw.fits"));
  ASSERT_EQ(run.code, 0) << run.err;
  std::string told = python_list(codes_of(file("two.tif"), 1));
  for (std::size_t at = 0; (at = told.find(',', at)) != std::string::npos; at += 2) told.replace(at, 1, ", ");
  EXPECT_EQ(run.out, "(2, 32, 48) 50.0 50.0 4095.0 90.0\n" + told + '\n');
}

TEST(DevelopRaw, FilesTellWhatTheirNumbersAre) {
  const std::string path = ball_film("scale", kMosaic);
  developed(path + " -o " + file("scale.png"));
  const auto told = read_picture(file("scale.png")).metadata;
  EXPECT_EQ(told.at("codes"), "digital numbers 0 to 16300, linear, not scaled to 16 bits");
  EXPECT_EQ(told.at("black_level_dn"), "600.00002") << "of a dark signal of 2e-4 electrons";
  EXPECT_EQ(told.at("white_level_dn"), "16300");
  EXPECT_EQ(told.at("gain_e_per_dn"), "10");
}

// The dark signal is 20 electrons, at 10 electrons per code.
TEST(DevelopRaw, AboveBlackIsLight) {
  const std::string path = ball_film("dark_signal", kMosaic);
  const std::string dark_current = " --set /readout/dark_e_per_s=20000";
  developed(path + dark_current + " --frame dark -o " + file("ds.dng") + " -o " + file("ds.fits"));
  for (const char* name : {"ds.dng", "ds.fits"}) {
    const RawPicture raw = read_raw_picture(file(name));
    EXPECT_EQ(raw.black_level_dn, 602) << name;
    EXPECT_NEAR(std::accumulate(raw.codes.begin(), raw.codes.end(), 0.0) / (48 * 32), 602, 0.1) << name;
    EXPECT_EQ(raw_scale(code_planes(raw)).value().offset_dn, 600) << "which transfer and series go by";
  }
}

TEST(DevelopRaw, ChannelsWithDarkSignalsOfTheirOwnAreWarnedOf) {
  const std::string path = ball_film("own_dark", R"("response": "quantum",
      "channels": {"a": {"band": [600, 700]}, "b": {"filters": [{"band": [500, 600]}], "exposure_s": 3}},
      "readout": {"gain_e_per_dn": 50, "bits": 12, "offset_dn": 50, "dark_e_per_s": 100})");
  const std::string warning =
      "have different dark signals (2 to 6 DN): the black level of raw files does not include them";
  EXPECT_NE(abbe("develop " + path + " -o " + file("own.fits")).err.find(warning), std::string::npos);
  EXPECT_EQ(read_raw_picture(file("own.fits")).black_level_dn, 50);
  EXPECT_EQ(abbe("develop " + path + " -o " + file("own.exr")).err, "");
  EXPECT_EQ(abbe("develop " + path + " --frame bias -o " + file("own.tif")).err, "");
}

TEST(DevelopAnew, TwiceTheTimeIsTwiceTheLight) {
  const std::string path = ball_film("time", kTwo);
  developed(path + " --exposure-s 2 -o " + file("twice.exr"));
  const Image before = read_exr(path);
  const std::vector<ExrPart> parts = read_exr_parts(file("twice.exr"));
  const Image& after = parts.front().image;
  const Image& variance = parts[1].image;
  for (std::size_t i = 0; i < before.pixels(); ++i) {
    ASSERT_EQ(after.find("a")->values[i], 2 * before.find("a")->values[i]);
    ASSERT_EQ(variance.find("Variance.a")->values[i], 4 * before.find("Variance.a")->values[i]);
  }
  EXPECT_EQ(after.metadata.at("exposure_s"), "2");
  EXPECT_EQ(after.metadata.at("expTime"), "2");
  const auto dark = developed(path + " --exposure-s 2 --set /readout/dark_e_per_s=50");
  EXPECT_DOUBLE_EQ(dark["dark_noise_e"][0], 10);
}

TEST(DevelopAnew, AShutterIsWarnedOfWhereItsSceneIsSeen) {
  const std::string path = ball_film("shutter", std::string(kTwo) + R"(, "shutter": {"rise_s": 0.2})");
  const std::string anew = "develop " + path + " --exposure-s 2 -o " + file("shutter.tif");
  EXPECT_NE(abbe(anew).err.find("--exposure-s: warning: motion blur remains that of the film's own exposure"),
            std::string::npos);
  EXPECT_EQ(abbe(anew + " --frame dark").err, "");
}

TEST(DevelopAnew, FramesHaveNoiseOfTheirOwn) {
  const std::string path = ball_film("frames", kTwo);
  developed(path + " --frames 3 -o " + file("f.tif"));
  developed(path + " -o " + file("one.tif"));
  EXPECT_EQ(codes_of(file("f_0001.tif")), codes_of(file("one.tif")));
  EXPECT_NE(codes_of(file("f_0002.tif")), codes_of(file("one.tif")));
  EXPECT_NE(codes_of(file("f_0002.tif")), codes_of(file("f_0003.tif")));
  developed(path + " --frame bias --frames 2 -o " + file("b.tif"));
  EXPECT_NE(codes_of(file("b_0002.tif")), codes_of(file("b_0001.tif"), 1)) << "nor that of another plane";
}

TEST(DevelopAnew, BiasDarkAndFlatFramesNeedNoScene) {
  const std::string path = ball_film("calibration", kTwo);
  const std::string dark_current = " --set /readout/dark_e_per_s=5000 --set /readout/read_noise_e=0";
  developed(path + dark_current + " --frame bias -o " + file("bias.tif"));
  developed(path + dark_current + " --frame dark -o " + file("dark.tif"));
  const auto flat = developed(path + dark_current + " --frame flat:0.25 -o " + file("flat.tif"));
  const auto mean = [](const std::vector<int>& codes) {
    return std::accumulate(codes.begin(), codes.end(), 0.0) / static_cast<double>(codes.size());
  };
  EXPECT_EQ(mean(codes_of(file("bias.tif"))), 50);
  EXPECT_NEAR(mean(codes_of(file("dark.tif"))), 50 + 100, 0.2);
  EXPECT_NEAR(mean(codes_of(file("flat.tif"))), 50 + 100 + 0.25 * 4045, 0.8);
  EXPECT_EQ(flat["render_error_e"][0], 0);
}

std::vector<double> fits_codes(const std::string& name) {
  const RawPicture raw = read_raw_picture(file(name));
  return {raw.codes.begin(), raw.codes.end()};
}
double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}
// The variance of one exposure is half that of the difference of two.
double temporal_variance(const std::vector<double>& a, const std::vector<double>& b) {
  const double shift = mean_of(a) - mean_of(b);
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i] - shift) * (a[i] - b[i] - shift);
  return squares / 2 / static_cast<double>(a.size() - 1);
}

// A million pixels determine the gain to 0.14 % and the read noise to 0.1 % (one standard deviation).
TEST(DevelopAnew, PairsOfFramesTellGainAndReadNoiseAtEverySpeed) {
  const int edge = nightly() ? 1000 : 300;
  const double bound = nightly() ? 0.005 : 5 * std::sqrt(2.0) / edge;  // five standard errors of a variance
  const std::string path = ball_film(
      "transfer",
      fmt::format(R"("model": "dslr_apsc_bayer_14bit", "resolution": [{0}, {0}], "exposure_s": 0.01)", edge),
      "--spp 1");
  for (const int iso : {100, 6400}) {
    const std::string speed = fmt::format(" --iso {} --frames 2 --seed 3", iso);
    developed(path + speed + " --frame flat:0.5 -o " + file("flat.fits"));
    developed(path + speed + " --frame bias -o " + file("bias.fits"));
    const std::vector<double> flat = fits_codes("flat_0001.fits");
    const std::vector<double> bias = fits_codes("bias_0001.fits");
    const double dark_variance = temporal_variance(bias, fits_codes("bias_0002.fits"));
    const double gain = (mean_of(flat) - mean_of(bias)) /
                        (temporal_variance(flat, fits_codes("flat_0002.fits")) - dark_variance);
    const double planted = read_raw_picture(file("flat_0001.fits")).gain_e_per_dn;
    EXPECT_NEAR(gain / planted, 1, bound) << iso;
    EXPECT_NEAR(planted * std::sqrt(dark_variance - 1.0 / 12), 3, bound * 3) << iso;
  }
}

TEST(DevelopAnew, CapitalsNameTheSameKindsOfFiles) {
  const std::string path = ball_film("capitals", kMosaic);
  std::string outputs;
  for (const char* name : {"small.dng", "small.fits", "small.tif", "small.exr", "CAPITALS.DNG",
                           "CAPITALS.FITS", "CAPITALS.TIF", "CAPITALS.EXR"})
    outputs += " -o " + file(name);
  developed(path + outputs);
  EXPECT_EQ(read_file(file("CAPITALS.DNG")), read_file(file("small.dng")));
  EXPECT_EQ(read_file(file("CAPITALS.FITS")), read_file(file("small.fits")));
  EXPECT_EQ(codes_of(file("CAPITALS.TIF")), codes_of(file("small.tif")));
  EXPECT_EQ(read_file(file("CAPITALS.EXR")).substr(0, 4), read_file(file("small.exr")).substr(0, 4));
}

TEST(DevelopAnew, AFileThatFailsLosesNoOther) {
  const std::string path = ball_film("failing", kTwo);
  const Outcome run = abbe("develop " + path + " -o " + file("no.png") + " -o " + file("no.dng") + " -o " +
                           file("yes.tif") + " -o " + file("yes.fits"));
  EXPECT_EQ(run.code, 5) << run.err;
  EXPECT_NE(run.err.find("no.png: this format stores one or three channels"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("no.dng: a DNG stores one plane, three planes or a mosaic"), std::string::npos)
      << run.err;
  EXPECT_EQ(read_picture(file("yes.tif")).channels.size(), 2U);
  EXPECT_TRUE(std::filesystem::exists(file("yes.fits")));
  EXPECT_FALSE(std::filesystem::exists(file("no.dng")));
}

TEST(DevelopAnew, FiguresAreOfThePixelsThatWereRendered) {
  const std::string path = ball_film("whole", kTwo);
  const std::string part = ball_film("part", kTwo, "--crop 10,4,20,12");
  const double mean = developed(part)["mean_e"][0];
  double sum = 0;
  const Image whole = read_exr(path);
  for (std::size_t y = 4; y < 12; ++y)
    for (std::size_t x = 10; x < 20; ++x) sum += whole.find("a")->values[48 * y + x];
  EXPECT_NEAR(mean, sum / 80 * 4.5e-6 * 4.5e-6, 1e-5 * mean);
}

TEST(DevelopAnew, FilesTellTheSensorThatMadeTheirCodes) {
  const std::string path = ball_film("anew", R"("model": "dslr_apsc_bayer_14bit", "exposure_s": 0.001)");
  std::string outputs;
  for (const char* end : {"png", "tif", "dng", "parts.exr"})
    outputs += " -o " + file(std::string("anew.") + end);
  for (const auto& [options, speed, bits] : {std::tuple{" --iso 400 --set /readout/bits=15", 400, 15},
                                             std::tuple{" --set /readout/gain_e_per_dn=1", 0, 14}}) {
    const double iso = developed(path + options + outputs)["iso_speed"];
    if (speed > 0) {
      EXPECT_NEAR(iso, speed, 1e-9 * speed);
    }
    const auto told = read_picture(file("anew.png")).metadata;
    EXPECT_NEAR(std::stod(told.at("isoSpeed")), iso, 1e-6 * iso) << options;
    const std::string line = "isoSpeed: " + told.at("isoSpeed") + '\n';
    EXPECT_NE(read_picture(file("anew.tif")).metadata.at("ImageDescription").find(line), std::string::npos);
    EXPECT_NE(read_raw_picture(file("anew.dng")).metadata.at("ImageDescription").find(line),
              std::string::npos);
    for (const ExrPart& part : read_exr_parts(file("anew.parts.exr")))
      if (part.name != "preview") {
        EXPECT_EQ(part.image.metadata.at("isoSpeed"), told.at("isoSpeed")) << part.name;
      }
    EXPECT_EQ(raw_scale(read_picture(file("anew.tif")))->bits, bits) << options;
  }
}

TEST(DevelopAnew, AnOutputThatCannotBeWrittenKeepsNoOtherFromIt) {
  const std::string path = ball_film("places", kTwo);
  std::filesystem::create_directories(scratch() / "folder.tif");
  std::filesystem::create_symlink("/dev/full", scratch() / "device.tif");
  for (const std::string& bad : {std::string("/nonexistent/x.tif"), file("folder.tif"), file("device.tif")})
    for (const std::string& outputs :
         {" -o " + bad + " -o " + file("good.tif"), " -o " + file("good.tif") + " -o " + bad}) {
      std::filesystem::remove(file("good.tif"));
      const Outcome run = abbe("develop " + path + outputs);
      EXPECT_EQ(run.code, 5) << outputs;
      EXPECT_TRUE(std::filesystem::exists(file("good.tif"))) << outputs << '\n' << run.err;
    }
  EXPECT_EQ(abbe("develop " + path + " -o /nonexistent/x.tif").code, 5);
}

TEST(DevelopAnew, OptionsWithoutEffectAreRefused) {
  const std::string path = ball_film("idle", kTwo);
  for (const auto& [options, message] :
       {std::pair{"--frame bias --exposure-s 10", "--exposure-s: has no effect on a bias frame"},
        std::pair{"--frame dark --light key=5", "--light: has no effect on a calibration frame"},
        std::pair{"--frame flat --light key=5", "--light: has no effect on a calibration frame"},
        std::pair{"--iso 400 --set /readout/iso=300",
                  "--iso: sets the same value as --set /readout/iso: give only one of them"},
        std::pair{"--white A --set /output/white=D50",
                  "--white: sets the same value as --set /output/white: give only one of them"},
        std::pair{"--exposure 5",
                  "--exposure: has no effect without an output (allowed with --display or -o)"},
        std::pair{"--white A", "--white: has no effect without an output"},
        std::pair{"--set /output/white=A", "/output/white: has no effect without an output"}}) {
    const Outcome run = abbe("develop " + path + " " + options);
    EXPECT_EQ(run.code, 2) << options;
    EXPECT_NE(run.err.find(message), std::string::npos) << options << '\n' << run.err;
  }
}

TEST(DevelopAnew, FaultsAreNamed) {
  const std::string path = ball_film("faults", kTwo);
  const std::string bare = ball_film("bare", R"("observer": "1931")");
  for (const auto& [arguments, message] :
       {std::pair{path + " --frame grey", "--frame: got \"grey\", allowed bias, dark, flat or flat:FRACTION"},
        std::pair{path + " --frame flat:x", "--frame: "},
        std::pair{path + " --exposure-s 0", "--exposure-s: "}, std::pair{path + " --frames 0", "--frames: "},
        std::pair{bare + " --frame dark", "--frame: the film has no readout"},
        std::pair{bare + " --frames 3", "--frames: needs a film with a readout, which has the noise"},
        std::pair{bare + " --seed 3", "--seed: needs a film with a readout, which has the noise"},
        std::pair{path + " --view film", "--view: applies to pictures only (allowed with --display)"},
        std::pair{path + " --screen paper", "--screen: applies to pictures only"},
        std::pair{path + " --ocio /nowhere.ocio", "--ocio: applies to pictures only"},
        std::pair{bare + " --iso 100", "channel \"X\" counts no electrons"},
        std::pair{path + " --iso 400 --set /readout/gain_e_per_dn=8",
                  "/readout/iso: sets the gain, which /readout/gain_e_per_dn sets too"},
        std::pair{path + " --iso 0", "--iso: "}}) {
    const Outcome run = abbe("develop " + arguments);
    EXPECT_NE(run.code, 0) << arguments;
    EXPECT_NE(run.err.find(message), std::string::npos) << arguments << '\n' << run.err;
  }
}

}  // namespace
}  // namespace abbe::test
