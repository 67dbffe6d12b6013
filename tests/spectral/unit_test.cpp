#include "spectral/unit.h"

#include <string>

#include <gtest/gtest.h>

#include "spectral/unit_line.h"

namespace abbe {
namespace {

constexpr Unit::Exponents kRadiance{1, 0, 0, -3, -1};
constexpr Unit::Exponents kIrradiance{1, 0, 0, -3, 0};
constexpr Unit::Exponents kFlux{1, 0, 0, -1};

TEST(Unit, IsReadInAllSpellings) {
  struct Case {
    const char* told;
    Unit::Exponents exponents;
    double log10_factor;
  };
  for (const Case& told : {Case{"W/(m^2 sr nm)", kRadiance, 9},
                           {"W*sr^-1*m^-2*nm^-1", kRadiance, 9},
                           {"W.m-2.sr-1.nm-1", kRadiance, 9},
                           {"W/m^2/sr/nm", kRadiance, 9},
                           {"W/m2-sr-nm", kRadiance, 9},
                           {"W / m^2 / sr / nm", kRadiance, 9},
                           {"W/sqm/sr/nm", kRadiance, 9},
                           {"watts per square meter per steradian per nanometer", kRadiance, 9},
                           {"W m-2 ster-1 nm-1", kRadiance, 9},
                           {"W/m²·sr·nm", kRadiance, 9},
                           {"W m^{-2} sr^{-1} nm^{-1}", kRadiance, 9},
                           {"W m**-2 sr**-1 nm**-1", kRadiance, 9},
                           {"Wm-2sr-1nm-1", kRadiance, 9},
                           {"W·sr–1·m−2·nm⁻¹", kRadiance, 9},
                           {"W (m2 sr nm)^-1", kRadiance, 9},
                           {"J s-1 m-2 sr-1 nm-1", kRadiance, 9},
                           {"kW/(m^2 sr µm)", kRadiance, 9},
                           {"GW/(m2 sr m)", kRadiance, 9},
                           {"10⁻⁶ W/(cm2 sr nm)", kRadiance, 7},
                           {"W m-2 sr-1 (10 nm)-1", kRadiance, 8},
                           {"W/cm^3", kIrradiance, 6},
                           {"mWcm-2nm-1", kIrradiance, 10},
                           {"erg s-1 cm-2 Å-1", kIrradiance, 7},
                           {"W/100nm", kFlux, 7},
                           {"1 / cm", {0, 0, 0, -1}, 2},
                           {"m^(-1)", {0, 0, 0, -1}, 0},
                           {"mJy", {1, 0, -1, -2}, -29},
                           {"janskys", {1, 0, -1, -2}, -26},
                           {"microjansky", {1, 0, -1, -2}, -32},
                           {"W/(m2 GHz)", {1, 0, -1, -2}, -9},
                           {"W/m^2/Ang", kIrradiance, 10},
                           {"W/m2/AA", kIrradiance, 10},
                           {"ph/s/m2/nm", {0, -1, 0, -3, 0, 1}, 9},
                           {"mA/W", {-1, 0, 0, 0, 0, 0, 0, 0, 1}, -3},
                           {"V/(uJ/cm2)", {-1, -1, 0, 2, 0, 0, 0, 0, 0, 1}, 2},
                           {"DN/(nJ/cm2)", {-1, -1, 0, 2}, 5}}) {
    const auto unit = unit_line(told.told).unit;
    ASSERT_TRUE(unit) << told.told;
    EXPECT_TRUE(unit->equals({told.exponents, told.log10_factor})) << told.told << ' ' << unit->log10_factor;
  }
}

TEST(Unit, DividesByWavenumbersWhereLengthsAreMultiplied) {
  for (const char* told : {"W/(m2 cm-1)", "W/(m2 1/cm)", "W m-2 / cm^-1", "W m⁻² (cm⁻¹)⁻¹", "W cm/m2"})
    EXPECT_TRUE(unit_line(told).unit.value().per_wavenumber) << told;
  for (const char* told : {"W/cm3", "W/m2/nm", "W cm-2 nm-1", "1/cm"})
    EXPECT_FALSE(unit_line(told).unit.value().per_wavenumber) << told;
}

TEST(Unit, StandsBeforeRemarksOrBehindWhatItIsOf) {
  struct Case {
    const char* told;
    const char* unit;
  };
  for (const Case& told : {Case{"spectral irradiance, W/m2/nm", "W/m2/nm"},
                           {"radiance (W/m2/sr/nm), photopic 100 cd/m2", "W/m2/sr/nm"},
                           {"radiance [mW/m2/nm]", "mW/m2/nm"},
                           {"Spectral radiance in mW/(m2 sr nm) with 1 cm2 aperture", "mW/(m2 sr nm)"},
                           {"spectral radiance mW/(m2 nm)", "mW/(m2 nm)"},
                           {"wavelength in nm, W/nm", "W/nm"},
                           {"W/nm (2 pi sr)", "W/nm"},
                           {"W/nm into 4 pi sr", "W/nm"},
                           {"mW/nm at 1 W", "mW/nm"},
                           {"W/(m2 nm) vs wavelength / um", "W/(m2 nm)"},
                           {"absorption coefficient (1/m)", "1/m"},
                           {"relative power per THz", "1/THz"}}) {
    const auto unit = unit_line(told.told).unit;
    ASSERT_TRUE(unit) << told.told;
    EXPECT_TRUE(unit->equals(leading_unit(told.unit).value())) << told.told;
  }
  for (const char* prose : {"1",
                            "-",
                            "",
                            "nm",
                            "reflectance, 10 mm",
                            "relative power at 60 Hz mains",
                            "relative, 100 cd/m2",
                            "W-shaped",
                            "furlongs",
                            "A",
                            "V",
                            "V(lambda)",
                            "mA",
                            "reflectance (s/p)",
                            "wavelength/nm",
                            "e-/count",
                            "relative; W/nm",
                            "normalised to 560 nm (w.r.t. 1 m2)",
                            "relative power, converted from photons/s",
                            "m0",
                            "W/W",
                            "mW/mW",
                            "lm/lm",
                            "J/J",
                            "sr/sr",
                            "watts/watts",
                            "W / W",
                            "W/m2/(W/m2)",
                            "transmittance (W/W)",
                            "ratio W / W",
                            "reflectance, W/W",
                            "W/",
                            "/",
                            "(",
                            "())("})
    EXPECT_FALSE(unit_line(prose).unit) << prose;
}

TEST(Unit, IsUnreadWhereItGoesOnWithWhatIsNone) {
  for (const char* told :
       {"W/m2/mum", "W/(m2 furlong)", "W m-2 / furlong", "W/m2/nm^x", "W.m-2.mum-1", "erg/s per furlong",
        "ph/s/m2/pixel", "spectral irradiance W/m2/mum", "spectral irradiance, W/m2/mum"})
    EXPECT_TRUE(unit_line(told).unit.value().has_unknown_factor) << told;
  for (const char* told : {"W/m2/nm", "W/nm at 25 C", "mW/nm. Of a lamp", "e-/photon", "counts/s/pixel"}) {
    const auto unit = unit_line(told).unit;
    EXPECT_FALSE(unit && unit->has_unknown_factor) << told;
  }
}

TEST(Unit, IsNoneWhereItHasNoEnd) {
  EXPECT_TRUE(leading_unit("W/" + std::string(100000, '(')).value().has_unknown_factor);
  EXPECT_FALSE(leading_unit("m^1000"));
  std::string nested = "m9";
  for (int i = 0; i < 100; ++i) nested.insert(0, "(").append(")9");
  EXPECT_TRUE(leading_unit("W/" + nested).value().has_unknown_factor);
}

}  // namespace
}  // namespace abbe
