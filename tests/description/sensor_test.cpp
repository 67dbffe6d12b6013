#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"
#include "io/data_directory.h"
#include "io/table.h"
#include "spectral/library.h"
#include "spectral/sources.h"

namespace abbe {
namespace {

using test::Fault;
using test::Loaded;
namespace fs = std::filesystem;
using test::painted;
using test::sensed;
using test::write;
using SensorTest = test::DescriptionTest;

Channel only_channel(const Loaded& loaded) {
  EXPECT_TRUE(loaded.scene) << loaded.text();
  return loaded.scene ? loaded->channels.at(0) : energy_channel("none", Curve(1.0));
}

TEST_F(SensorTest, FilteredCcdsCountTheElectronsOfPlanckianSources) {
  const ReferenceTable counts("ccd_bandpass_counts");
  ASSERT_EQ(counts.rows(), 24U);
  for (std::size_t row = 0; row < counts.rows(); ++row) {
    const std::string& efficiency = counts.text(row, "ccd_qe");
    const Channel channel = only_channel(load(sensed(fmt::format(
        R"("resolution": [1, 1], "quantum_efficiency": {}, "channels": {{"band": {{"filters": ["{}"]}}}})",
        efficiency == "none" ? "1" : '"' + efficiency + '"', counts.text(row, "passband")))));
    EXPECT_EQ(channel.kind, ResponseKind::quantum);
    const double expected = counts.number(row, "N");
    EXPECT_NEAR(sum_product(planck(counts.number(row, "T_K")), channel.weight, {300, 1050}), expected,
                1e-6 * expected)
        << counts.text(row, "passband") << ' ' << efficiency;
  }
}

TEST_F(SensorTest, FiltersMultiplyOneBehindTheOther) {
  const std::string stack = R"("filters": [0.5, {"band": [500, 600]}], "lens_transmission": 0.8)";
  const Channel channel = only_channel(load(
      sensed(R"("resolution": [1, 1], "quantum_efficiency": 0.6, )" + stack +
             R"(, "channels": {"a": {"filters": [{"band": [400, 550], "value": 0.9}, "filter.csv:T"]}})")));
  EXPECT_NEAR(channel.weight(520) * photon_energy(520), 0.6 * 0.5 * 0.8 * 0.9 * 0.24, 1e-12);
  EXPECT_EQ(channel.weight(450), 0);
  EXPECT_EQ(channel.weight(560), 0);
  EXPECT_FALSE(channel.angular);

  const Channel camera = only_channel(
      load(sensed(R"("resolution": [1, 1], "camera": "Nikon_D5100", "response": "quantum", )" + stack)));
  Diagnostics diagnostics;
  const auto red = load_curve("camera", "Nikon_D5100:R", {}, diagnostics);
  EXPECT_NEAR(camera.weight(520) * photon_energy(520), 0.4 * red->curve(520), 1e-9);
  const Loaded observer = load(sensed(R"("resolution": [1, 1], "observer": "1931", )" + stack));
  EXPECT_NEAR(observer->channels.at(1).weight(555), 0.4 * 683.002, 0.01);

  const Channel clear =
      only_channel(load(sensed(R"("resolution": [1, 1], "channels": {"L": {"filters": []}})")));
  EXPECT_EQ(clear.weight(700), 1);
}

TEST_F(SensorTest, AFilterWheelExposesEveryFilterForItsOwnTime) {
  const Loaded wheel = load(sensed(
      R"("resolution": [1, 1], "exposure_s": 0.5, "channels": {"R": {"filters": ["W25"], "exposure_s": 2},
         "clear": {"filters": [0.5]}, "plain": 0.5})"));
  ASSERT_TRUE(wheel.scene) << wheel.text();
  EXPECT_EQ(wheel->exposure_s, 0.5);
  Diagnostics diagnostics;
  const auto red = load_curve("filter", "W25", {}, diagnostics);
  EXPECT_EQ(wheel->channels[0].exposure_ratio, 4);
  EXPECT_NEAR(wheel->channels[0].weight(650), 4 * red->curve(650), 1e-12);
  EXPECT_EQ(wheel->channels[1].exposure_ratio, 1);
  EXPECT_EQ(wheel->channels[1].weight(650), 0.5);
  EXPECT_EQ(wheel->channels[2].weight(650), 0.5);
}

TEST_F(SensorTest, AnInterferenceFilterReachesAsFarAsTheCameraLetsIt) {
  const auto line = [this](const std::string& camera) {
    return load(fmt::format(
        R"({{"camera": {}, "sensor": {{"resolution": [40, 30], "pixel_pitch_um": 100, "fill_factor": 0.25,
            "channels": {{"line": {{"filters": [{{"transmittance": {{"band": [645, 655]}}, "effective_index": 2}}]}}}}}}}})",
        camera));
  };
  const std::string at = R"("from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]})";
  const Loaded lens =
      line(R"({"thin_lens": {"focal_length": 0.01, "f_number": 2, "focus_distance": "infinity"}, )" + at);
  ASSERT_TRUE(lens.scene) << lens.text();
  EXPECT_EQ(lens->fill_factor, 0.25);
  EXPECT_TRUE(lens->features.angular_response);
  EXPECT_EQ(lens->features.reasons.at("angular_response"), "channel \"line\"");
  // The ray to the far corner, 2.5 mm from the axis, through the far edge of the aperture of 2.5 mm radius.
  // The ray through the center of the lens has the cosine c there and the sine c/4. A sharp image of infinity
  // adds c^3/4 [Born1999, sec. 4.5], of which 1/4 is an upper bound.
  const double c = std::cos(std::atan(0.25));
  const auto edge_at = [](double sine) { return 645 * blue_shift(std::sqrt(1 - sine * sine), 2.0); };
  const Curve& through_lens = envelope(lens->channels.at(0));
  EXPECT_EQ(through_lens(edge_at(c / 4 + c * c * c / 4)), 1);
  EXPECT_EQ(through_lens(edge_at(c / 4 + 0.25) - 0.01), 0);
  EXPECT_EQ(through_lens(654.9), 1);
  EXPECT_EQ(through_lens(655.1), 0);
  const auto ends_at = [](const Loaded& loaded, double nm) {
    const Curve& highest = envelope(loaded->channels.at(0));
    EXPECT_EQ(highest(nm - 0.01), 0) << nm;
    EXPECT_EQ(highest(nm + 0.01), 1) << nm;
    EXPECT_EQ(highest(654.9), 1);
    EXPECT_EQ(highest(655.1), 0);
  };
  ends_at(line(R"({"pinhole": {"focal_length": 0.01}, )" + at),
          645 * blue_shift(std::cos(std::atan(0.25)), 2.0));
  ends_at(line(R"({"irradiance_probe": {"at": [0, 0, 0], "normal": [0, 0, 1]}})"), 645 * std::sqrt(0.75));
  EXPECT_FALSE(load("{}")->features.angular_response);
}

TEST_F(SensorTest, MosaicsNameTheirChannels) {
  const Loaded bayer =
      load(sensed(R"("resolution": [5, 3], "camera": "Nikon_D5100", "mosaic": [["R", "G"], ["G", "B"]])"));
  ASSERT_TRUE(bayer.scene) << bayer.text();
  EXPECT_EQ(bayer->mosaic, (Mosaic{2, 2, {0, 1, 1, 2}}));
  EXPECT_EQ(bayer->film_planes(), std::vector<std::string>{"raw"});
  const Loaded stripes =
      load(sensed(R"("resolution": [5, 3], "channels": {"a": 1, "b": 2}, "mosaic": [["b", "a", "b"]])"));
  EXPECT_EQ(stripes->mosaic, (Mosaic{3, 1, {1, 0, 1}}));
  EXPECT_FALSE(load("{}")->mosaic);
  EXPECT_EQ(load("{}")->film_planes(), std::vector<std::string>{"all"});
}

TEST_F(SensorTest, ATStopExposesAsALensWithoutLosses) {
  const auto lens = [this](const std::string& members) {
    const Loaded loaded = load(fmt::format(
        R"({{"camera": {{{}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]}}}})", members));
    EXPECT_TRUE(loaded.scene) << loaded.text();
    return loaded->camera.kind;
  };
  const auto both =
      std::get<ThinLens>(lens(R"("thin_lens": {"focal_length": 0.05, "f_number": 2, "t_stop": 2.5})"));
  EXPECT_DOUBLE_EQ(both.aperture_radius, 0.0125);
  EXPECT_DOUBLE_EQ(both.transmittance, 0.64);
  const auto alone = std::get<ThinLens>(lens(R"("thin_lens": {"focal_length": 0.05, "t_stop": 2.5})"));
  EXPECT_DOUBLE_EQ(alone.aperture_radius, 0.01);
  EXPECT_EQ(alone.transmittance, 1);
  const auto pinhole = std::get<Pinhole>(lens(R"("pinhole": {"focal_length": 0.05, "t_stop": 2.5})"));
  EXPECT_DOUBLE_EQ(pinhole.aperture_radius, 0.01);
  EXPECT_EQ(std::get<Pinhole>(lens(R"("pinhole": {"focal_length": 0.05})")).aperture_radius, 0.05 / 8);
}

// Blades do not change the f-number, which is that of the circle; T-stops include the light they block.
TEST_F(SensorTest, BladesLeaveTheFNumberAndCountInTheTStop) {
  const auto lens = [this](const std::string& members) {
    const Loaded loaded = load(R"({"camera": {"thin_lens": {"focal_length": 0.05, "blades": 5, )" + members +
                               R"(}, "from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]}})");
    EXPECT_TRUE(loaded.scene) << loaded.text();
    return std::get<ThinLens>(loaded->camera.kind);
  };
  const double share = 5 / (2 * std::numbers::pi) * std::sin(2 * std::numbers::pi / 5);
  const ThinLens plain = lens(R"("f_number": 2)");
  EXPECT_DOUBLE_EQ(plain.aperture_radius, 0.0125);
  EXPECT_EQ(plain.transmittance, 1);
  EXPECT_DOUBLE_EQ(plain.iris->area_fraction(), share);
  const ThinLens both = lens(R"("f_number": 2, "t_stop": 2.5)");
  EXPECT_DOUBLE_EQ(both.aperture_radius, 0.0125);
  EXPECT_DOUBLE_EQ(both.transmittance * share, 0.64);
  const ThinLens alone = lens(R"("t_stop": 2.5)");
  EXPECT_DOUBLE_EQ(alone.aperture_radius, 0.01 / std::sqrt(share));
  EXPECT_EQ(alone.transmittance, 1);
  EXPECT_TRUE(lens(R"("f_number": 2, "blade_rotation_deg": 90)").iris->contains({0.99, 0}));
  EXPECT_FALSE(plain.iris->contains({0.99, 0}));
}

TEST_F(SensorTest, RefusesAndExplainsWhatIsWrong) {
  const std::string pixel = R"("resolution": [1, 1], )";
  const auto behind = [&](const std::string& filter) {
    return sensed(pixel + R"("channels": {"a": {"filters": [)" + filter + "]}}");
  };
  const std::string at = R"("from": [0, -3, 0], "to": [0, 0, 0], "up": [0, 0, 1]})";
  const auto mosaic = [&](const std::string& pattern) {
    return sensed(pixel + R"("channels": {"a": 1, "b": 1}, "mosaic": )" + pattern);
  };
  const std::vector<Fault> faults{
      {"14 no camera", R"({"camera": {}})", ErrorCode::scene,
       "expected exactly one key (got none, allowed pinhole, thin_lens, lens_system, irradiance_probe)"},
      {"16 no pitch", sensed(pixel + R"("observer": 1931, "pixel_pitch_um": 0)"), ErrorCode::scene,
       "/sensor/pixel_pitch_um: error: expected a number (got 0, allowed (0, 1000000])"},
      {"16 no area", sensed(pixel + R"("observer": 1931, "fill_factor": 0)"), ErrorCode::scene,
       "/sensor/fill_factor: error: expected a number (got 0, allowed (0, 1])"},
      {"16 more than all", sensed(pixel + R"("observer": 1931, "fill_factor": 1.5)"), ErrorCode::scene,
       "(got 1.5, allowed (0, 1])"},
      {"17 no time", sensed(pixel + R"("channels": {"a": {"filters": [], "exposure_s": 0}})"),
       ErrorCode::scene,
       "/sensor/channels/a/exposure_s: error: expected a number (got 0, allowed (0, 1000000000])"},
      {"18 no stop", R"({"camera": {"pinhole": {"fov_deg": 9, "t_stop": 0}, )" + at + "}", ErrorCode::scene,
       "/camera/pinhole/t_stop: error: expected a number (got 0, allowed [0.5, 1000000])"},
      {"18 a lens that amplifies",
       R"({"camera": {"thin_lens": {"focal_length": 0.1, "f_number": 4, "t_stop": 3.9}, )" + at + "}",
       ErrorCode::scene, "a T-stop must not be faster than its f-number (got 3.9, allowed [4, inf))"},
      {"18 no stop at all", R"({"camera": {"thin_lens": {"focal_length": 0.1}, )" + at + "}",
       ErrorCode::scene, "missing key \"f_number\""},
      {"27 empty band", behind(R"({"band": [600, 600]})"), ErrorCode::scene,
       "/sensor/channels/a/filters/0/band: error: an empty band"},
      {"27 opaque", behind("0"), ErrorCode::scene,
       "/sensor/channels/a: error: channel \"a\" responds to no wavelength in [300, 1100] nm"},
      {"27 nothing in common", behind(R"({"band": [400, 500]}, {"band": [600, 700]})"), ErrorCode::scene,
       "responds to no wavelength"},
      {"27 nothing in common at any angle",
       behind(R"({"transmittance": {"band": [400, 500]}, "effective_index": 2}, {"band": [600, 700]})"),
       ErrorCode::scene, "responds to no wavelength"},
      {"27 nothing passes the sensor's filter",
       sensed(pixel + R"("filters": [0], "camera": "Nikon_D5100:R")"), ErrorCode::scene,
       "/sensor/camera: error: channel \"R\" responds to no wavelength"},
      {"27 nothing passes the lens",
       sensed(pixel + R"("lens_transmission": {"band": [900, 950]}, "camera": "Nikon_D5100:R")"),
       ErrorCode::scene, "/sensor/camera: error: channel \"R\" responds to no wavelength"},
      {"percent", behind("92"), ErrorCode::scene, "(got 92, allowed [0, 1.05])"},
      {"negative", behind(R"({"transmittance": -0.1, "effective_index": 2})"), ErrorCode::scene,
       "/sensor/channels/a/filters/0/transmittance: error: curve out of range at 300 nm (got -0.1"},
      {"percent of the lens", sensed(pixel + R"("observer": 1931, "lens_transmission": 80)"),
       ErrorCode::scene, "/sensor/lens_transmission: error: curve out of range"},
      {"an index below air's", behind(R"({"transmittance": 1, "effective_index": 0.9})"), ErrorCode::scene,
       "/sensor/channels/a/filters/0/effective_index: error: expected a number (got 0.9, allowed [1, 10])"},
      {"no transmittance", behind(R"({"effective_index": 2})"), ErrorCode::scene,
       "missing key \"transmittance\""},
      {"no index", behind(R"({"transmittance": 1})"), ErrorCode::scene, "missing key \"effective_index\""},
      {"unknown filter", behind(R"("bessel_V")"), ErrorCode::scene, "did you mean \"bessell_V\"?"},
      {"not a list", sensed(pixel + R"("channels": {"a": {"filters": "bessell_V"}})"), ErrorCode::scene,
       "expected an array of filters (got a string)"},
      {"unknown key", sensed(pixel + R"("channels": {"a": {"filters": [], "exposure": 1}})"),
       ErrorCode::scene, "did you mean \"exposure_s\"?"},
      {"an efficiency for a camera", sensed(pixel + R"("camera": "Nikon_D5100", "quantum_efficiency": 0.5)"),
       ErrorCode::scene, "quantum_efficiency is used with channels only (got camera)"},
      {"a response for an observer", sensed(pixel + R"("observer": 1931, "response": "quantum")"),
       ErrorCode::scene, "response is used with channels only (got observer)"},
      {"an empty mosaic", mosaic("[]"), ErrorCode::scene,
       "expected an array of rows (got 0 of them, allowed [1, inf))"},
      {"an empty row", mosaic("[[]]"), ErrorCode::scene, "/sensor/mosaic/0: error: expected an array"},
      {"a ragged mosaic", mosaic(R"([["a", "b"], ["a"]])"), ErrorCode::scene,
       "/sensor/mosaic/1: error: rows of a mosaic must have the same length (got 1, allowed 2)"},
      {"an unknown channel", mosaic(R"([["a", "c"]])"), ErrorCode::scene,
       "/sensor/mosaic/0/1: error: unknown channel \"c\""},
      {"a channel without pixels", mosaic(R"([["b"]])"), ErrorCode::scene,
       "/sensor/mosaic: error: does not contain channel \"a\""},
      {"no names", mosaic("[[1]]"), ErrorCode::scene, "expected a string (got 1"},
  };
  expect_refused(faults);
}

TEST_F(SensorTest, APeakMakesQuantumEfficienciesOfAMeasuredCamera) {
  const Loaded camera = load(sensed(
      R"("resolution": [1, 1], "camera": "Nikon_D5100", "peak_quantum_efficiency": 0.5, "lens_transmission": 0.9)"));
  ASSERT_TRUE(camera.scene) << camera.text();
  Diagnostics diagnostics;
  double greatest = 0;
  for (const Channel& channel : camera->channels) {
    EXPECT_EQ(channel.kind, ResponseKind::quantum);
    for (int nm = 380; nm <= 780; ++nm)
      greatest = std::max(greatest, channel.weight(nm) * photon_energy(nm) / 0.9);
  }
  EXPECT_NEAR(greatest, 0.5, 1e-6);
  const auto red = load_curve("camera", "Nikon_D5100:R", {}, diagnostics)->curve;
  const auto blue = load_curve("camera", "Nikon_D5100:B", {}, diagnostics)->curve;
  // An efficiency S/lambda for photons records the same as the response S to energy.
  EXPECT_NEAR(camera->channels[0].weight(600) / camera->channels[2].weight(460), red(600) / blue(460), 1e-9);

  const Loaded own = load(sensed(
      R"("resolution": [1, 1], "channels": {"R": "Nikon_D5100:R", "G": "Nikon_D5100:G", "B": "Nikon_D5100:B"},
         "peak_quantum_efficiency": 0.5, "lens_transmission": 0.9)"));
  ASSERT_TRUE(own.scene) << own.text();
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_EQ(own->channels[k].weight(520), camera->channels[k].weight(520))
        << "one camera, said in two ways";
}

// Flat responses to energy S become efficiencies proportional to S/lambda, with the maximum at 420 nm.
TEST_F(SensorTest, APeakScalesChannelsNamedAsTheObserversToo) {
  const Loaded own = load(sensed(R"("resolution": [1, 1], "peak_quantum_efficiency": 0.5,
         "channels": {"X": {"band": [580, 650]}, "Y": {"band": [500, 600]}, "Z": {"band": [420, 490]}})"));
  ASSERT_TRUE(own.scene) << own.text();
  for (const Channel& channel : own->channels) EXPECT_EQ(channel.kind, ResponseKind::quantum);
  EXPECT_NEAR(own->channels[0].weight(600) * photon_energy(600), 0.5 * 420 / 600, 1e-9);
}

// A G pixel counts the requested electrons in an exposure of 1 lx s of daylight through filter and lens.
TEST_F(SensorTest, ElectronsInDaylightScaleAMeasuredCamera) {
  const std::string camera =
      R"("resolution": [1, 1], "pixel_pitch_um": 5, "fill_factor": 0.8, "camera": "Nikon_D5100",
      "lens_transmission": 0.7, "filters": [{"band": [400, 700]}], )";
  const Loaded counted = load(sensed(camera + R"("electrons_per_lx_s": 9000)"));
  const Loaded peaked = load(sensed(camera + R"("peak_quantum_efficiency": 0.5)"));
  ASSERT_TRUE(counted.scene && peaked.scene) << counted.text() << peaked.text();
  Diagnostics diagnostics;
  const Curve daylight = load_illuminant("D55", {}, diagnostics)->curve;
  const double lux = photometric(daylight);
  const Channel& green = counted->channels[1];
  EXPECT_EQ(green.kind, ResponseKind::quantum);
  EXPECT_NEAR(integral_of_product(daylight, green.weight) / lux * 0.8 * 25e-12, 9000, 1e-6);
  const double ratio = green.weight(540) / peaked->channels[1].weight(540);
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(counted->channels[k].weight(560) / peaked->channels[k].weight(560), ratio, 1e-9 * ratio);
  expect_refused(
      {{"both", sensed(camera + R"("electrons_per_lx_s": 9000, "peak_quantum_efficiency": 0.5)"),
        ErrorCode::scene, "sets the same scale as peak_quantum_efficiency: give only one of them"},
       {"an efficiency", sensed(R"("resolution": [1, 1], "channels": {"a": 1}, "quantum_efficiency": 1,
                             "electrons_per_lx_s": 9000)"),
        ErrorCode::scene, "electrons_per_lx_s cannot be combined with quantum_efficiency"},
       {"more than photons", sensed(camera + R"("electrons_per_lx_s": 1e12)"), ErrorCode::scene,
        "electrons per photon (allowed up to 10)"},
       {"nothing", sensed(camera + R"("electrons_per_lx_s": 0)"), ErrorCode::scene,
        "/sensor/electrons_per_lx_s"},
       {"an observer", sensed(R"("resolution": [1, 1], "observer": "1931", "electrons_per_lx_s": 1)"),
        ErrorCode::scene, "electrons_per_lx_s is used with channels only"}});
}

TEST_F(SensorTest, AColumnOfAnyFolderIsACurve) {
  const Curve red = curve(R"("Nikon_D5100:R")");
  EXPECT_NEAR(red(600),
              load_curve("camera", "Nikon_D5100:R", {}, *std::make_unique<Diagnostics>())->curve(600), 1e-12);
  EXPECT_NE(load(painted(R"("Nikon_D5100:Q")")).text().find("unknown reflectance \"Nikon_D5100:Q\""),
            std::string::npos);
}

TEST_F(SensorTest, EveryShippedModelIsASensor) {
  std::size_t models = 0;
  for (const auto& entry : fs::directory_iterator(data_directory() / "sensor")) {
    const Loaded loaded =
        load(sensed(fmt::format(R"("model": "{}", "resolution": [4, 2])", entry.path().stem().string())));
    ASSERT_TRUE(loaded.scene) << loaded.text();
    EXPECT_EQ(loaded->camera.width, 4) << "keys of the scene replace those of the file";
    ASSERT_TRUE(loaded->readout) << entry.path();
    EXPECT_LT(loaded->readout->full_well_e, 1e6);
    ++models;
  }
  EXPECT_EQ(models, 6U);
}

TEST_F(SensorTest, TheSceneReplacesWhatAModelSays) {
  write(folder_ / "mine.json", R"({"title": "t", "source": "s", "status": "example", "sensor": {
        "resolution": [4, 3], "exposure_s": 2, "camera": "Nikon_D5100", "peak_quantum_efficiency": 0.5,
        "mosaic": [["R", "G"], ["G", "B"]], "readout": {"gain_e_per_dn": 2, "bits": 12, "dsnu_e": 3}}})");
  const Loaded plain = load(sensed(R"("model": "mine.json")"));
  ASSERT_TRUE(plain.scene) << plain.text();
  EXPECT_EQ(plain->camera.height, 3);
  EXPECT_TRUE(plain->mosaic);
  const Loaded other = load(sensed(
      R"("model": "mine.json", "response": "quantum", "channels": {"L": 0.5}, "readout": {"iso": 100, "bits": 14})"));
  ASSERT_TRUE(other.scene) << other.text();
  EXPECT_EQ(other->channels.size(), 1U) << "not the camera's, nor its mosaic";
  EXPECT_FALSE(other->mosaic);
  EXPECT_EQ(other->exposure_s, 2);
  EXPECT_EQ(other->readout->bits, 14);
  EXPECT_EQ(other->readout->dsnu_e, 3);
  EXPECT_NE(other->readout->gain_e_per_dn, 2);
  EXPECT_NE(plain->sha256, other->sha256);
}

// Each of the two scales replaces the other.
TEST_F(SensorTest, TheSceneReplacesTheScaleOfAModel) {
  constexpr const char* kFile = R"({{"title": "t", "source": "s", "status": "example", "sensor": {{
        "resolution": [1, 1], "camera": "Nikon_D5100", {},
        "readout": {{"gain_e_per_dn": 2, "bits": 12}}}}}})";
  constexpr const char* kPeak = R"("peak_quantum_efficiency": 0.5)";
  constexpr const char* kCounted = R"("electrons_per_lx_s": 9000)";
  for (const auto& [of_file, of_scene] : {std::pair{kPeak, kCounted}, {kCounted, kPeak}}) {
    write(folder_ / "scaled.json", fmt::format(kFile, of_file));
    const Loaded model = load(sensed(fmt::format(R"("model": "scaled.json", {})", of_scene)));
    const Loaded plain =
        load(sensed(fmt::format(R"("resolution": [1, 1], "camera": "Nikon_D5100", {})", of_scene)));
    ASSERT_TRUE(model.scene && plain.scene) << model.text() << plain.text();
    EXPECT_EQ(model->channels[1].weight(540), plain->channels[1].weight(540)) << of_scene;
    EXPECT_TRUE(model->readout);
  }
}

TEST_F(SensorTest, FaultsOfModelsAreNamed) {
  write(folder_ / "bare.json",
        R"({"sensor": {"resolution": [4, 3], "observer": "1931"}, "title": "t", "status": "s"})");
  write(
      folder_ / "wrong.json",
      R"({"sensor": {"resolution": [4, 3], "observer": "1931", "pich": 2}, "title": "t", "status": "s", "source": ""})");
  expect_refused(
      {{"unknown", sensed(R"("resolution": [1, 1], "model": "dslr_apsc_bayer", "observer": "1931")"),
        ErrorCode::scene, "unknown sensor \"dslr_apsc_bayer\"; known: ccd"},
       {"no file", sensed(R"("resolution": [1, 1], "model": "none.json", "observer": "1931")"),
        ErrorCode::input, "none.json"},
       {"no source", sensed(R"("resolution": [1, 1], "model": "bare.json", "observer": "1931")"),
        ErrorCode::input, "missing key \"source\""},
       {"a key of the file", sensed(R"("model": "wrong.json")"), ErrorCode::scene,
        "wrong.json:1:55: /sensor/pich: error: unknown key"},
       {"two efficiencies", sensed(R"("resolution": [1, 1], "channels": {"a": 1}, "quantum_efficiency": 1,
                             "peak_quantum_efficiency": 0.5)"),
        ErrorCode::scene, "cannot be combined with quantum_efficiency"},
       {"an observer", sensed(R"("resolution": [1, 1], "observer": "1931", "peak_quantum_efficiency": 1)"),
        ErrorCode::scene, "peak_quantum_efficiency is used with channels only"}});
}

}  // namespace
}  // namespace abbe
