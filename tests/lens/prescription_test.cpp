#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "lens/beam.h"
#include "lens/paraxial.h"
#include "lenses.h"

namespace abbe::lens {
namespace {

using test::lens_of;
using test::sound_lens_of;

// A singlet in which something replaces or accompanies the surfaces.
std::string singlet(const std::string& surfaces, const std::string& beside = R"("entrance_pupil": 5)") {
  return "{" + beside + ",\n \"surfaces\": [" + surfaces + "]}";
}

const std::string kFront =
    R"({"radius": 50, "thickness": 4, "glass": "N-BK7", "stop": true, "aperture": 10})";

void expect_json_fault(const std::string& text, const std::string& place, const std::string& message) {
  test::unsound_lens_of(text, ".json", place, message);
}

TEST(LensPrescription, ShippedLensesAreWhatTheyAreCalled) {
  EXPECT_EQ(description::shipped_names("lens").size(), 6U);
  for (const std::string& name : description::shipped_names("lens")) {
    const auto loaded = test::load_said(name);
    ASSERT_TRUE(loaded.system) << loaded.text();
    EXPECT_TRUE(loaded.diagnostics.all().empty()) << loaded.text();
    EXPECT_FALSE(loaded.system->source.empty()) << name;
  }
  const auto focal_length = [](const char* name) {
    const System system = test::lens_named(name);
    return first_order(SystemAt(system, system.primary_nm())).focal_length_mm;
  };
  EXPECT_NEAR(focal_length("fisheye"), 10.5647, 5e-5);
  EXPECT_NEAR(focal_length("tessar"), 100, 0.5);
  EXPECT_NEAR(focal_length("landscape"), 10, 0.5);
}

TEST(LensPrescription, ShortFormSaysTheSame) {
  const System brief = sound_lens_of(singlet(kFront + ", [-40, 60, null, 9]"));
  const System full = sound_lens_of(singlet(kFront + R"(, {"radius": -40, "thickness": 60, "aperture": 9})"));
  EXPECT_EQ(brief.surfaces[1].profile.curvature, -1.0 / 40);
  EXPECT_EQ(brief.surfaces[1].profile.curvature, full.surfaces[1].profile.curvature);
  EXPECT_EQ(brief.surfaces[1].thickness_mm, 60);
  EXPECT_EQ(brief.surfaces[1].semi_aperture_mm, full.surfaces[1].semi_aperture_mm);
  EXPECT_FALSE(brief.surfaces[1].behind);
}

TEST(LensPrescription, GlassesComeFromCataloguesAndNumbers) {
  const System system = sound_lens_of(
      R"({"entrance_pupil": 1, "wavelengths_nm": [587.5618], "surfaces": [{"thickness": 1, "glass": "N-BK7", "stop": true},
      [0, 1, {"nd": 1.7, "vd": 40}], [0, 1, 1.9], [0, 1, "schott/F5"], [0, 1], [0, 1, {"n": 1.4, "k": 1e-9}], [0, 1]]})");
  const SystemAt d(system, 587.5618);
  EXPECT_NEAR(d.n[1], 1.516800, 5e-7);
  EXPECT_NEAR(d.n[2], 1.7, 1e-12);
  EXPECT_EQ(d.n[3], 1.9);
  EXPECT_EQ(d.n[5], 1);
  EXPECT_EQ(d.n[6], 1.4) << "n is no slip of nd";
  const double spread = SystemAt(system, 486.1327).n[2] - SystemAt(system, 656.2725).n[2];
  EXPECT_NEAR((1.7 - 1) / spread, 40, 1e-9);
}

TEST(LensPrescription, UnknownGlassIsToldWithTheNearest) {
  expect_json_fault(singlet(kFront + R"(, [-50, 3, "N-SF66x"], [0, 1])"), "2:", "did you mean \"N-SF66\"?");
}

TEST(LensPrescription, WavelengthsBeyondAGlassAreTold) {
  const auto warning = [](double nm) {
    return fmt::format("warning: schott/SF5 has no data at {} nm: its index at 350 nm is used", nm);
  };
  Diagnostics diagnostics;
  const auto system = load_lens("achromat", diagnostics, nullptr, {}, {310, 330, 350});
  ASSERT_TRUE(system);
  EXPECT_EQ(system->wavelengths_nm, (std::vector<double>{310, 330, 350}));
  EXPECT_EQ(system->primary, 1U);
  for (const double nm : {310, 330})
    EXPECT_NE(diagnostics.text().find(warning(nm)), std::string::npos) << diagnostics.text();
  EXPECT_EQ(diagnostics.all().size(), 2U) << diagnostics.text();
}

// The lens does not change.
TEST(LensPrescription, OtherWavelengthsKeepStopAndFocus) {
  Diagnostics diagnostics;
  const auto other = load_lens("fisheye", diagnostics, nullptr, {}, {450});
  ASSERT_TRUE(other) << diagnostics.text();
  const System own = test::lens_named("fisheye");
  EXPECT_EQ(other->primary_nm(), 450);
  EXPECT_EQ(other->set_at_nm.value(), own.primary_nm());
  EXPECT_EQ(stop_radius(*other), stop_radius(own));
  EXPECT_EQ(other->surfaces.back().thickness_mm, own.surfaces.back().thickness_mm);
  EXPECT_FALSE(own.set_at_nm);
}

TEST(LensPrescription, LensHasOneStop) {
  expect_json_fault(singlet("[50, 4, 1.5], [-50, 40]"), "1:1", "no surface is marked as the stop");
  expect_json_fault(singlet(kFront + R"(, {"radius": -50, "thickness": 9, "stop": true})"),
                    "2:", "a lens has one stop: surface 1");
}

TEST(LensPrescription, AperturesEndWhereTheirSurfaceDoes) {
  expect_json_fault(singlet(kFront + ", [8, 40, null, 8.5]"), "2:", "got 8.5 mm, allowed less than 8 mm");
  EXPECT_TRUE(
      lens_of(singlet(kFront + R"(, {"radius": 8, "thickness": 40, "aperture": 8.5, "conic": -1})")).system);
}

// A plano-convex lens of 100 mm, 5 mm before its stop.
std::string stopped_lens(const std::string& opening, double stop_aperture, double front_aperture) {
  return singlet(fmt::format(R"([51.68, 4, 1.5168, {}], [0, 5],
    {{"stop": true, "thickness": 90, "aperture": {}}})",
                             front_aperture, stop_aperture),
                 opening);
}

TEST(LensPrescription, StopOpensAsFarAsItsAperture) {
  expect_json_fault(
      stopped_lens(R"("f_number": 5)", 6, 12.5),
      "3:", "the stop cannot open that far, because its clear aperture is 6 mm (got f/5, allowed f/7.7");
  expect_json_fault(stopped_lens(R"("entrance_pupil": 20)", 6, 12.5),
                    "3:", "(got an entrance pupil of 20 mm, allowed an entrance pupil of 12.9");
  for (const char* sound : {R"("f_number": 7.8)", R"("entrance_pupil": 12.9)", R"("title": "as its stop")"}) {
    const auto loaded = lens_of(stopped_lens(sound, 6, 12.5));
    EXPECT_TRUE(loaded.system && loaded.diagnostics.all().empty()) << loaded.text();
  }
}

TEST(LensPrescription, AperturesThatCutTheAxialBeamAreTold) {
  const auto cut = lens_of(stopped_lens(R"("f_number": 5)", 12.5, 6));
  ASSERT_TRUE(cut.system) << cut.text();
  EXPECT_NE(cut.text().find("warning: part of the axial beam that fills the stop does not reach the image: "
                            "its rim is stopped by the aperture of surface 1"),
            std::string::npos)
      << cut.text();
  const auto whole = lens_of(stopped_lens(R"("f_number": 5)", 12.5, 10.005));
  EXPECT_TRUE(whole.system && whole.diagnostics.all().empty()) << whole.text();
}

TEST(LensPrescription, SurfacesDoNotCross) {
  expect_json_fault(singlet(kFront + ", [-10, 40, null, 9]"), "2:", "surface 1 crosses surface 2");
  EXPECT_TRUE(lens_of(singlet(kFront + ", [-10, 40, null, 6]")).system);
  expect_json_fault(singlet(R"([50, -1, 1.5], {"thickness": 1, "stop": true})"), "2:", "got a gap of -1 mm");
  // A stop in air may be in front of the preceding vertex.
  EXPECT_TRUE(lens_of(singlet(R"([50, 4, 1.5], [50, -1], {"thickness": 30, "stop": true})")).system);
}

TEST(LensPrescription, ConditionsMustFit) {
  expect_json_fault(
      singlet(R"({"radius": 50, "thickness": 4, "glass": 1.5, "stop": true}, [0, 9])", R"("title": "x")"),
      "1:1", "the lens has no aperture");
  expect_json_fault(singlet(kFront, R"("entrance_pupil": 5, "f_number": 2)"),
                    "1:", "a lens has one aperture");
  expect_json_fault(singlet(kFront + ", [-50, 40]", R"("object_heights": [1])"), "1:1",
                    "object_heights need an object_distance");
  expect_json_fault(singlet(kFront, R"("primary_nm": 500)"),
                    "1:", "got 500, allowed 486.1327, 587.5618, 656.2725");
  expect_json_fault(singlet("[50]"), "2:", "got 1 values, allowed 2 to 4");
  expect_json_fault(singlet(R"({"radus": 50, "thickness": 1, "stop": true})"),
                    "2:", "did you mean \"radius\"?");
  expect_json_fault(singlet(kFront + R"(, {"asphere": [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]})"),
                    "2:", "an asphere ends at r^20");
}

TEST(LensPrescription, AfocalLensesHaveNoFocus) {
  const std::string hole = R"({"stop": true, "aperture": 0.5, "thickness": 100})";
  for (const char* focus : {R"("focus": "paraxial")", R"("focus": "best")"})
    expect_json_fault(singlet(hole, focus), "1:1", "the lens is afocal and has no focus");
  EXPECT_TRUE(lens_of(singlet(hole, R"("focus": "given")")).system);
  expect_json_fault(
      singlet(kFront + ", [-50, 40]", R"("entrance_pupil": 5, "focus": "best", "fields_deg": [100])"), "1:1",
      "no beam of the lens converges");
}

TEST(LensPrescription, FieldsOfAnyKindBecomeDirectionsOrHeights) {
  const System image = sound_lens_of(singlet(kFront + ", [-50, 40]", R"("image_heights": [0, 10])"));
  const double f = first_order(SystemAt(image, image.primary_nm())).focal_length_mm;
  EXPECT_NEAR(image.fields[1], std::atan(10 / f) * 180 / 3.14159265358979, 1e-9);
  const System near =
      sound_lens_of(singlet(kFront + ", [-50, 40]", R"("fields_deg": [0, 45], "object_distance": 200)"));
  EXPECT_NEAR(near.fields[1], -200, 1e-9);  // the stop is at the first vertex
  const System plain =
      sound_lens_of(singlet(kFront + ", [-50, 40]", R"("object_heights": [3], "object_distance": 200)"));
  EXPECT_EQ(plain.fields[0], 3);
}

TEST(LensPrescription, AnglesOfANearObjectAreLessThanARightAngle) {
  for (const char* angle : {"90", "-95"})
    expect_json_fault(singlet(kFront + ", [-50, 40]",
                              fmt::format(R"("object_distance": 200, "fields_deg": [0, {}])", angle)),
                      "1:1", fmt::format("within 90 degrees of the axis (got {}, allowed (-90, 90))", angle));
}

TEST(LensPrescription, TelecentricLensesTakeObjectHeights) {
  const auto telecentric = [](const std::string& fields) {
    return singlet(R"([50, 3, 1.5], [-50, 49.494949494949495], {"stop": true, "aperture": 0.5})",
                   R"("object_distance": 100, )" + fields);
  };
  expect_json_fault(telecentric(R"("fields_deg": [0, 5])"), "1:1",
                    "this lens is telecentric: use object_heights");
  EXPECT_EQ(sound_lens_of(telecentric(R"("fields_deg": [0])")).fields[0], 0);
  EXPECT_EQ(sound_lens_of(telecentric(R"("object_heights": [0, 5])")).fields[1], 5);
}

TEST(LensPrescription, ImagesAreInAir) {
  expect_json_fault(singlet(kFront),
                    "2:", "the image of a lens must be in air (got N-BK7 behind the last surface)");
  EXPECT_TRUE(lens_of(singlet(kFront + ", [-50, 40, 1.0]")).system);
}

TEST(LensPrescription, ImageHeightsNeedAnImage) {
  const std::string plate = R"({"thickness": 4, "glass": 1.5, "stop": true}, [0, 40])";
  expect_json_fault(singlet(plate, R"("entrance_pupil": 5, "image_heights": [0, 3])"), "1:1",
                    "image_heights need an image at a finite distance: use fields_deg");
}

TEST(LensPrescription, UnknownLensIsToldWithTheNearest) {
  const auto loaded = test::load_said("tesar");
  EXPECT_FALSE(loaded.system);
  EXPECT_NE(loaded.text().find("did you mean \"tessar\"?"), std::string::npos) << loaded.text();
  EXPECT_EQ(loaded.diagnostics.code(), ErrorCode::input);
}

TEST(LensPrescription, PbrtTableIsReadAsPbrtDoes) {
  const System table = sound_lens_of(
      "# A singlet behind its stop\n# radius thickness index diameter\n0 2 0 5\n50 4 1.5 12 # front\n-50\t90 "
      "1 12\n",
      ".dat");
  EXPECT_EQ(table.title, "A singlet behind its stop");
  EXPECT_EQ(table.stop, 0U);
  EXPECT_EQ(table.aperture.value, 2.5);
  EXPECT_EQ(*table.surfaces[1].semi_aperture_mm, 6);
  EXPECT_EQ(SystemAt(table, 550).n[2], 1.5);
  EXPECT_EQ(table.surfaces.back().thickness_mm, first_order(SystemAt(table, 550)).back_focus_mm);
  const auto torn = lens_of("0 2 0 5\n50 4 1.5\n", ".dat");
  EXPECT_FALSE(torn.system);
  EXPECT_NE(torn.text().find("lens.dat:2:"), std::string::npos) << torn.text();
  EXPECT_NE(torn.text().find("got 3 numbers, expected 4"), std::string::npos) << torn.text();
}

}  // namespace
}  // namespace abbe::lens
