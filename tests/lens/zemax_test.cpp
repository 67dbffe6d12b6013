#include <string>

#include <gtest/gtest.h>

#include "lens/paraxial.h"
#include "lenses.h"

namespace abbe::lens {
namespace {

using test::lens_of;
using test::sound_lens_of;

// A cemented achromat in the form of manufacturers' files.
const std::string kAchromat = R"(VERS 120928 0 30221
MODE SEQ
NAME AC254-100-A POSITIVE ACHROMAT
UNIT MM X W X CM MR CPMM
ENPD 2.286E+1
ENVD 2.0E+1 1 0
GCAT SCHOTT INFRARED MISC
FTYP 0 0 2 3 0 0 0
XFLN 0 0 0 0 0 0 0 0 0 0 0 0
YFLN 0 1 0 0 0 0 0 0 0 0 0 0
VCYN 0 0 0 0 0 0 0 0 0 0 0 0
WAVM 1 4.861E-1 1
WAVM 2 5.876E-1 1
WAVM 3 6.563E-1 1
WAVM 4 5.5E-1 1
PWAV 2
SURF 0
  TYPE STANDARD
  CURV 0.0 0 0 0 0 ""
  DISZ INFINITY
  DIAM 0 0 0 0 1 ""
SURF 1
  COMM front
  STOP
  TYPE STANDARD
  CURV 1.593625498007969800E-002 0 0 0 0 ""
  HIDE 0 0 0 0 0 0 0 0 0 0
  DISZ 4.0
  GLAS N-BK7 0 0 0 0 0 0 0 0 0 0
  DIAM 1.27E+1 1 0 0 1 ""
SURF 2
  TYPE STANDARD
  CURV -2.187705097352880100E-002 0 0 0 0 ""
  DISZ 2.5
  GLAS SF5 0 0 0 0 0 0 0 0 0 0
  DIAM 1.27E+1 1 0 0 1 ""
SURF 3
  TYPE STANDARD
  CURV -7.798487093503899700E-003 0 0 0 0 ""
  DISZ 9.706800996493E+1
  DIAM 1.2 0 0 0 1 ""
SURF 4
  TYPE STANDARD
  CURV 0.0 0 0 0 0 ""
  DISZ 0
TOL TOFF   0   0              0              0   0 0 0
MNUM 1 1
)";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

std::string utf16(const std::string& text, bool little, bool mark) {
  std::string bytes = mark ? (little ? "\xFF\xFE" : "\xFE\xFF") : "";
  for (const char c : text) bytes += little ? std::string{c, '\0'} : std::string{'\0', c};
  return bytes;
}

void expect_zemax_fault(const std::string& text, const std::string& place, const std::string& message) {
  const ErrorCode code = test::unsound_lens_of(text, ".zmx", place, message).diagnostics.code();
  EXPECT_EQ(code == ErrorCode::input || code == ErrorCode::scene, true);
}

TEST(LensZemax, MakersAchromatIsTheShippedOne) {
  const System read = sound_lens_of(kAchromat, ".zmx");
  const System shipped = test::lens_named("achromat");
  EXPECT_EQ(read.title, "AC254-100-A POSITIVE ACHROMAT");
  EXPECT_EQ(read.fields, shipped.fields);
  EXPECT_EQ(read.primary, 1U);
  ASSERT_EQ(read.wavelengths_nm.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(read.wavelengths_nm[i], shipped.wavelengths_nm[i], 1e-9);
  const FirstOrder found = first_order(SystemAt(read, 587.6));
  const FirstOrder expected = first_order(SystemAt(shipped, 587.6));
  EXPECT_NEAR(found.focal_length_mm, expected.focal_length_mm, 1e-11);
  EXPECT_NEAR(found.back_focus_mm, expected.back_focus_mm, 1e-11);
  EXPECT_EQ(*read.surfaces[0].semi_aperture_mm, 12.7);
  EXPECT_FALSE(read.surfaces[2].semi_aperture_mm);  // computed by Zemax
  EXPECT_EQ(read.surfaces[1].behind->name, "schott/SF5");
}

TEST(LensZemax, Utf16IsReadAsUtf8Is) {
  const FirstOrder plain = first_order(SystemAt(sound_lens_of(kAchromat, ".zmx"), 587.6));
  for (const bool little : {true, false})
    for (const bool mark : {true, false}) {
      const auto loaded = lens_of(utf16(kAchromat, little, mark), ".zmx");
      ASSERT_TRUE(loaded.system) << loaded.text();
      EXPECT_EQ(first_order(SystemAt(*loaded.system, 587.6)).focal_length_mm, plain.focal_length_mm);
    }
}

// Letters of Latin-1, and the quotes and the dash of Windows-1252.
TEST(LensZemax, Windows1252IsReadAsUtf8Is) {
  std::string bytes = replaced(kAchromat, "AC254-100-A POSITIVE", "\x93M\xFCller\x94 \x96 20\xB0 5\xB5m");
  bytes = replaced(bytes, "ENVD", "NOTE 0 f\xFCr\nENVD");
  const auto loaded = lens_of(bytes, ".zmx");
  ASSERT_TRUE(loaded.system) << loaded.text();
  EXPECT_EQ(loaded.system->title, "\u201CM\u00FCller\u201D \u2013 20\u00B0 5\u00B5m ACHROMAT");
  EXPECT_EQ(first_order(SystemAt(*loaded.system, 587.6)).focal_length_mm,
            first_order(SystemAt(sound_lens_of(kAchromat, ".zmx"), 587.6)).focal_length_mm);
  expect_zemax_fault(replaced(bytes, "GLAS SF5", "GLAS Gl\xE4ser"), "36:8", "\"Gl\u00E4ser\"");
  EXPECT_EQ(sound_lens_of(replaced(kAchromat, "AC254-100-A", "\u00B5\u00FC"), ".zmx").title,
            "\u00B5\u00FC POSITIVE ACHROMAT");
}

TEST(LensZemax, OtherEncodingsAreErrors) {
  expect_zemax_fault(replaced(kAchromat, "front", "\xFC\x81"), "23:9",
                     "neither UTF-8 nor Windows-1252 (got byte 0x81)");
  expect_zemax_fault("\xEF\xBB\xBF" + replaced(kAchromat, "front", "fr\xF6nt"), "23:10", "invalid UTF-8");
  expect_zemax_fault(replaced(kAchromat, "front", std::string("\xB5\0", 2)), "23:9", "NUL byte");
  expect_zemax_fault(utf16(kAchromat, true, true) + "x", "", "invalid UTF-16");
  expect_zemax_fault(utf16("MODE SEQ\n", true, true) + "\x01\xD8\x41" + std::string(1, '\0'), "2:1",
                     "invalid UTF-16");
  expect_zemax_fault(std::string("MODE\0SEQ", 8), "1:5", "NUL byte");
}

TEST(LensZemax, FaultsAreToldAtTheirPlace) {
  expect_zemax_fault(replaced(kAchromat, "GLAS SF5", "GLAS N-SF555"), "35:8", "did you mean");
  expect_zemax_fault(replaced(kAchromat, "  STOP\n", ""), "", "no surface is marked as the stop");
  expect_zemax_fault(replaced(kAchromat, "  DISZ 2.5", "  STOP\n  DISZ 2.5"), "31:1", "a lens has one stop");
  expect_zemax_fault(replaced(kAchromat, "TYPE STANDARD\n  CURV -2", "TYPE COORDBRK\n  CURV -2"), "32:8",
                     "got COORDBRK");
  expect_zemax_fault(replaced(kAchromat, "GLAS SF5", "GLAS MIRROR"), "35:8", "mirrors are not supported");
  expect_zemax_fault(replaced(kAchromat, "MODE SEQ", "MODE NSC"), "2:6", "only sequential lenses");
  expect_zemax_fault(replaced(kAchromat, "UNIT MM", "UNIT FT"), "4:6", "unknown unit");
  expect_zemax_fault(replaced(kAchromat, "FTYP 0", "FTYP 3"), "8:6", "fields of this kind");
  expect_zemax_fault(replaced(kAchromat, "XFLN 0 0", "XFLN 0 2"), "9:8", "only fields along y");
  expect_zemax_fault(replaced(kAchromat, "DISZ 4.0", "DISZ four"), "28:8", "got \"four\"");
  expect_zemax_fault(replaced(kAchromat, "  COMM front", "  GRAT 600"), "23:3",
                     "unknown keyword of Zemax \"GRAT\"");
  expect_zemax_fault(replaced(kAchromat, "ENPD 2.286E+1", "ENPD 0"), "5:6", "got 0, allowed (0, 1e+09]");
  expect_zemax_fault(replaced(kAchromat, "MNUM 1 1", "MNUM 3 1"), "47:6", "several configurations");
  expect_zemax_fault(replaced(kAchromat, "-2.187705097352880100E-002", "-0.2"), "31:1",
                     "larger than the surface");
}

TEST(LensZemax, ObjectsAndImagesOfOtherKindsAreErrorsAtTheirLine) {
  const std::string object = "  CURV 0.0 0 0 0 0 \"\"\n  DISZ INFINITY";
  expect_zemax_fault(replaced(kAchromat, "  DISZ INFINITY", "  GLAS N-BK7\n  DISZ 200"), "20:8",
                     "an object in glass is not supported (got N-BK7, allowed air)");
  expect_zemax_fault(replaced(kAchromat, object, "  CURV 0.01\n  DISZ 200"), "19:8",
                     "a curved object is not supported (got 0.01, allowed 0)");
  expect_zemax_fault(replaced(kAchromat, "STANDARD\n" + object, "EVENASPH\n CURV 0\n PARM 2 1e-5\n DISZ 200"),
                     "20:9", "a curved object is not supported (got 1e-5, allowed 0)");
  expect_zemax_fault(replaced(kAchromat, "  DISZ INFINITY", "  STOP\n  DISZ 200"), "20:3",
                     "the object cannot be the stop");
  expect_zemax_fault(replaced(kAchromat, "FTYP 0 0", "FTYP 0 1"), "8:8",
                     "a telecentric object space is not supported (got 1, allowed 0)");
  expect_zemax_fault(replaced(kAchromat, "2 3 0 0 0", "2 3 0 0 1"), "8:18",
                     "an afocal image space is not supported (got 1, allowed 0)");
  expect_zemax_fault(replaced(kAchromat, "SURF 4\n  TYPE STANDARD\n", "SURF 4\n TYPE EVENASPH\n PARM 1 1\n"),
                     "42:1", "the last surface, which is the image, must be plane");
  EXPECT_TRUE(lens_of(replaced(kAchromat, "FTYP 0 0 2 3 0 0 0", "FTYP 0 0.0 2 3"), ".zmx").system);
}

// Syntax of older files.
TEST(LensZemax, ObjectsBeyondADistanceAreAtInfinity) {
  const auto with = [](const std::string& distance) { return replaced(kAchromat, "INFINITY", distance); };
  for (const char* far : {"1.000000000000000000E+010", "1e11"})
    EXPECT_FALSE(sound_lens_of(with(far), ".zmx").object_distance_mm) << far;
  EXPECT_EQ(sound_lens_of(with("1e9"), ".zmx").object_distance_mm, 1e9);
  expect_zemax_fault(with("5e9"), "20:8",
                     "distance of the object out of range (got 5e+09 mm, allowed (0, 1000000000] mm)");
  expect_zemax_fault(with("0"), "20:8",
                     "distance of the object out of range (got 0 mm, allowed (0, 1000000000] mm)");
  expect_zemax_fault(replaced(with("5e7"), "UNIT MM", "UNIT METER"), "20:8", "(got 5e+10 mm,");
  expect_zemax_fault(replaced(kAchromat, "DISZ 4.0", "DISZ 1e10"), "28:8",
                     "only the object can be at infinity");
}

TEST(LensZemax, WhatASystemSaysTwiceOrNotInFullIsAnError) {
  expect_zemax_fault(replaced(kAchromat, "PWAV 2", "PWAV 4"), "16:6",
                     "no wavelength of the file has this number (got 4, allowed 1, 2, 3)");
  expect_zemax_fault(replaced(kAchromat.substr(0, kAchromat.find("WAVM")), "GCAT", "PWAV 1\nGCAT") +
                         kAchromat.substr(kAchromat.find("SURF 0")),
                     "7:6", "no wavelength of the file has this number (got 1, allowed none without WAVM)");
  const std::string heights = "YFLN 0 1 0 0 0 0 0 0 0 0 0 0\n";
  expect_zemax_fault(replaced(kAchromat, heights, "YFLN 0\n"), "10:1",
                     "fewer fields along y than FTYP declares (got 1, expected 2)");
  expect_zemax_fault(replaced(kAchromat, heights, ""), "8:10",
                     "fewer fields along y than FTYP declares (got 0, expected 2)");
  EXPECT_TRUE(lens_of(replaced(replaced(kAchromat, heights, ""), "FTYP 0 0 2", "FTYP 0 0 1"), ".zmx").system);
  expect_zemax_fault(replaced(kAchromat, "WAVM 3 6.563E-1 1\n", ""), "8:12",
                     "fewer wavelengths (WAVM) than FTYP declares (got 2, expected 3)");
  EXPECT_TRUE(lens_of(replaced(kAchromat, "WAVM 4 5.5E-1 1\n", ""), ".zmx").system);
  for (const std::string second : {"FNUM 4 0", "ENPD 20", "FLOA"})
    expect_zemax_fault(
        replaced(kAchromat, "ENVD", second + "\nENVD"), "6:1",
        "a second aperture (got ENPD and " + second.substr(0, 4) + ", allowed one of ENPD, FNUM, FLOA)");
}

TEST(LensZemax, StandardSurfacesHaveNoParameters) {
  const std::string type = "  TYPE STANDARD\n  CURV 1";
  for (const std::string parameter : {"PARM 1 0.001", "PARM 2 0.001"})
    expect_zemax_fault(replaced(kAchromat, type, "  " + parameter + "\n" + type), "25:10",
                       "a STANDARD surface has no parameters: is it an EVENASPH? (got 0.001, allowed 0)");
  EXPECT_TRUE(lens_of(replaced(kAchromat, type, "  PARM 1 0\n" + type), ".zmx").system);
}

TEST(LensZemax, TruncatedFilesAreToldAsSuch) {
  expect_zemax_fault(kAchromat.substr(0, kAchromat.find("SURF 1")), "", "is the file cut short?");
  expect_zemax_fault(kAchromat.substr(0, kAchromat.find("  DISZ 9.7068")), "37:1", "surface 3 has no DISZ");
  expect_zemax_fault(kAchromat.substr(0, kAchromat.find("SURF 3")), "31:1",
                     "the last surface, which is the image");
  expect_zemax_fault(kAchromat.substr(0, kAchromat.find("9.706800996493E+1\n")), "40:3",
                     "got the end of the line");
}

TEST(LensZemax, ModelGlassesAreOfTwoNumbersThatAGlassCanHave) {
  const auto with = [](const std::string& numbers) {
    return replaced(kAchromat, "GLAS N-BK7 0 0 0 0 0", "GLAS ___BLANK 1 0 " + numbers);
  };
  expect_zemax_fault(with("1.6 50 0.01"), "29:28",
                     "a deviating partial dispersion is not supported (got 0.01, allowed 0)");
  expect_zemax_fault(with("1.6 -50 0"), "29:25",
                     "Abbe number out of range (got -50, allowed [1, 1000] or 0)");
  expect_zemax_fault(with("0.9 50 0"), "29:21", "index out of range (got 0.9, allowed [1, 4])");
  for (const char* sound : {"1.6 50 0.0", "1.6 50", "1.6 0 0"})
    EXPECT_TRUE(lens_of(with(sound), ".zmx").system) << sound;
}

TEST(LensZemax, AnglesHaveTheRangeOfJson) {
  expect_zemax_fault(replaced(kAchromat, "YFLN 0 1 ", "YFLN 0 200 "), "10:8",
                     "field out of range (got 200 degrees, allowed [-120, 120] degrees)");
  EXPECT_TRUE(lens_of(replaced(kAchromat, "YFLN 0 1 0", "YFLN 0 1 200"), ".zmx")
                  .system);  // neither of the two values
}

// FCD1 is a glass of Hoya.
TEST(LensZemax, GlassesOfOtherCataloguesAreTold) {
  const std::string other = replaced(kAchromat, "GLAS N-BK7", "GLAS FCD1");
  const auto loaded = lens_of(other, ".zmx");
  ASSERT_TRUE(loaded.system) << loaded.text();
  EXPECT_NE(loaded.text().find("lens.zmx:29:8: warning: FCD1 is in none of the file's catalogues known to "
                               "Abbe (got GCAT schott infrared misc): all catalogues are searched"),
            std::string::npos)
      << loaded.text();
  for (const std::string& sound :
       {kAchromat, replaced(other, "GCAT SCHOTT", "GCAT SCHOTT HOYA"),
        replaced(replaced(other, "GCAT SCHOTT INFRARED MISC\n", ""), "SF5", "schott/SF5")})
    EXPECT_EQ(lens_of(sound, ".zmx").text(), "");
}

TEST(LensZemax, WhatIsLeftOutIsTold) {
  auto loaded = lens_of(replaced(kAchromat, "VCYN 0 0", "VCYN 0 0.2"), ".zmx");
  ASSERT_TRUE(loaded.system);
  EXPECT_NE(loaded.text().find("lens.zmx:11:6: warning: the vignetting factors of VCYN"), std::string::npos)
      << loaded.text();
  loaded = lens_of(replaced(kAchromat, "  COMM front", "  COAT THORA"), ".zmx");
  ASSERT_TRUE(loaded.system);
  EXPECT_NE(loaded.text().find("the coating THORA is ignored"), std::string::npos) << loaded.text();
  loaded = lens_of(replaced(kAchromat, "WAVM 2 5.876E-1 1", "WAVM 2 5.876E-1 0"), ".zmx");
  ASSERT_TRUE(loaded.system);
  EXPECT_EQ(loaded.system->wavelengths_nm.size(), 3U);
  EXPECT_NE(
      loaded.text().find(
          "lens.zmx:13:17: warning: the weights of WAVM are ignored: all wavelengths have equal weights"),
      std::string::npos)
      << loaded.text();
  // Values for an unused entry.
  EXPECT_EQ(lens_of(replaced(kAchromat, "WAVM 4 5.5E-1 1", "WAVM 4 5.5E-1 0"), ".zmx").text(), "");
}

TEST(LensZemax, UnitsAspheresAndModelGlassesAreUnderstood) {
  const auto lens = [](const std::string& unit, const std::string& scale) {
    return "MODE SEQ\nUNIT " + unit + "\nFLOA\nFTYP 1 0 2 1\nYFLN 0 0.5" + scale + "\nWAVM 1 0.55 1\n" +
           "SURF 0\n TYPE STANDARD\n CURV 0\n DISZ 20" + scale + "\nSURF 1\n TYPE EVENASPH\n STOP\n CURV " +
           (scale.empty() ? "0.5" : "0.05") + "\n PARM 1 " + (scale.empty() ? "0.01" : "0.001") +
           "\n PARM 2 " + (scale.empty() ? "0.02" : "0.00002") + "\n CONI -0.5\n DISZ 0.5" + scale +
           "\n GLAS ___BLANK 1 0 1.6 50 0\n DIAM 0.1" + scale +
           " 0\nSURF 2\n TYPE STANDARD\n CURV 0\n DISZ 3" + scale +
           "\nSURF 3\n TYPE STANDARD\n CURV 0\n DISZ 0\n";
  };
  const System cm = sound_lens_of(lens("CM", ""), ".zmx");
  const System mm = sound_lens_of(lens("MM", "E+1"), ".zmx");
  EXPECT_NEAR(cm.surfaces[0].profile.curvature, 0.05, 1e-15);
  EXPECT_NEAR(cm.surfaces[0].profile.even[0], 0.001, 1e-15);
  EXPECT_NEAR(cm.surfaces[0].profile.even[1], 0.00002, 1e-15);
  EXPECT_EQ(cm.surfaces[0].profile.conic, -0.5);
  EXPECT_NEAR(cm.surfaces[0].profile.even[1], mm.surfaces[0].profile.even[1], 1e-18);
  EXPECT_EQ(*cm.object_distance_mm, 200);
  EXPECT_EQ(cm.fields[1], 5);
  EXPECT_EQ(cm.aperture.kind, ApertureKind::stop);
  EXPECT_EQ(cm.aperture.value, 1);
  EXPECT_NEAR(SystemAt(cm, 587.5618).n[1], 1.6, 1e-12);
}

}  // namespace
}  // namespace abbe::lens
