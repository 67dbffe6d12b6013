#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spectral/curve_use.h"

namespace abbe {
namespace {

TEST(CurveUnit, PercentIsNoShare) {
  for (const char* unit :
       {"%", "percent", "Per cent; wavelength in nm", "pct", "quantum efficiency [%]", "reflectance (%)",
        "reflectance in percent", "reflectance (in %)", "transmittance, 0-100 %", "0-100", "T%", "% R"})
    EXPECT_NE(unit_fault("t.csv", unit, CurveUnit::fraction).value_or("").find("allowed fractions of 1"),
              std::string::npos)
        << unit;
  for (const char* unit : {"1", "reflectance factor (0-1)", "reflectance (0-1), within 0.5 %",
                           "transmittance (1 = 100 %)", "reflectance (0-1); uncertainty in percent"})
    EXPECT_FALSE(unit_fault("t.csv", unit, CurveUnit::fraction)) << unit;
  EXPECT_FALSE(unit_fault("t.csv", "%", CurveUnit::any));
}

TEST(CurveUnit, LogarithmsAreNoLinearValues) {
  for (const CurveUnit needed : {CurveUnit::fraction, CurveUnit::power, CurveUnit::spectral_radiance})
    for (const char* unit : {"optical density", "Absorbance (decadic)", "OD", "dB", "attenuation in dB",
                             "insertion loss [dB]", "relative power, log10", "radiance (log)", "ln(T)"})
      EXPECT_TRUE(unit_fault("t.csv", unit, needed, "; a factor converts")
                      .value_or("")
                      .ends_with("allowed linear values: 10^x for log10 x, 10^-D for a density D, "
                                 "10^(-A/10) for A dB)"))
          << unit;
  for (const char* unit : {"log10 W/m2/sr/nm", "ln radiance", "dBm/nm", "logarithm of it"})
    EXPECT_TRUE(unit_fault("t.csv", unit, CurveUnit::spectral_radiance)) << unit;
}

TEST(CurveUnit, PhotonsAndPowersPerHertzAreNoPowersPerNm) {
  for (const CurveUnit needed : {CurveUnit::power, CurveUnit::spectral_radiance,
                                 CurveUnit::spectral_intensity, CurveUnit::spectral_irradiance}) {
    const auto allowed = [needed](const char* unit) {
      return unit_fault("t.csv", unit, needed, "; a factor converts").value_or("");
    };
    for (const char* unit : {"photons/(s m^2 nm)", "umol/(m^2 s nm)", "µmol m-2 s-1 nm-1", "mol/(s nm)",
                             "photons/(s m^2 sr nm)", "relative photon flux"})
      EXPECT_TRUE(allowed(unit).ends_with("allowed power per nm: hc/lambda for each photon)"))
          << unit << allowed(unit);
    for (const char* unit : {"W/(m^2 Hz)", "W/(m2 sr Hz)", "relative power per THz", "Jy", "W/m2/eV",
                             "W m-2 sr-1 cm-1", "uE/m2/s"})
      EXPECT_NE(allowed(unit), "") << unit;
    for (const char* unit : {"relative spectrum", "1", "relative power (photopic peak 1); no photons",
                             "normalised to 560 nm (w.r.t. 1 m2)"})
      EXPECT_EQ(allowed(unit), "") << unit;
  }
}

TEST(CurveUnit, AreasAndSolidAnglesAreThoseOfTheQuantity) {
  const auto fits = [](const char* unit, CurveUnit needed) { return !unit_fault("t.csv", unit, needed); };
  struct Case {
    const char* unit;
    bool radiance;
    bool intensity;
    bool irradiance;
  };
  for (const Case& told : {Case{"W/(m^2 sr nm)", true, false, false},
                           {"W m-2 sr-1 nm-1", true, false, false},
                           {"W/(m^2 nm)", false, false, true},
                           {"spectral irradiance, W/m2/nm", false, false, true},
                           {"W·m⁻²·nm⁻¹", false, false, true},
                           {"W/(sr nm)", false, true, false},
                           {"mW/(sr nm)", false, false, false},
                           {"relative spectral radiance", true, true, true}}) {
    EXPECT_EQ(fits(told.unit, CurveUnit::spectral_radiance), told.radiance) << told.unit;
    EXPECT_EQ(fits(told.unit, CurveUnit::spectral_intensity), told.intensity) << told.unit;
    EXPECT_EQ(fits(told.unit, CurveUnit::spectral_irradiance), told.irradiance) << told.unit;
    EXPECT_TRUE(fits(told.unit, CurveUnit::power)) << told.unit;
  }
}

TEST(CurveUnit, PartsAndMultiplesAreOthersHoweverTheyAreWritten) {
  const auto allowed = [](const char* unit, CurveUnit needed = CurveUnit::spectral_radiance) {
    return unit_fault("t.csv", unit, needed, "; a factor converts").value_or("");
  };
  for (const char* unit : {"W m-2 sr-1 um-1", "W m^-2 sr^-1 um^-1", "W·m⁻²·sr⁻¹·µm⁻¹", "W/m^2/sr/μm",
                           "W/(um m2 sr)", "W cm-2 sr-1 nm-1", "W/(cm² sr nm)", "μW/(cm2 sr nm)",
                           "mW m-2 sr-1 nm-1", "spectral radiance in mW/(m2 sr nm)", "mW", "W/(m2 sr Å)",
                           "W/(sr nm)", "lm/(m2 sr nm)", "W/m2/sr/mum"})
    EXPECT_TRUE(allowed(unit).ends_with("allowed W/(m^2 sr nm); a factor converts)"))
        << unit << allowed(unit);
  for (const char* unit : {"W m-2 sr-1 nm-1", "W·m⁻²·sr⁻¹·nm⁻¹", "W/(m2 sr nm), wavelength in um",
                           "W/(m2 sr nm), 100 cd/m2 in all", "kW/(m2 sr um)", "relative; mW", "1"})
    EXPECT_EQ(allowed(unit), "") << unit;
}

TEST(CurveUnit, FluxesArePowersOfWholeLamps) {
  const auto allowed = [](const char* unit) {
    return unit_fault("t.csv", unit, CurveUnit::spectral_flux, "; a factor converts").value_or("");
  };
  for (const char* unit : {"mW/nm", "uW/nm", "µW nm⁻¹", "mW/(m2 nm)", "W/(m2 nm)", "W m-2 nm-1", "W/(sr nm)",
                           "W/um", "W", "lm/nm"})
    EXPECT_TRUE(allowed(unit).ends_with("allowed W/nm; a factor converts)")) << unit << allowed(unit);
  for (const char* unit : {"W/nm", "W nm-1", "W/nm (2 pi sr)", "relative", "a.u.", "1"})
    EXPECT_EQ(allowed(unit), "") << unit;
}

TEST(CurveUnit, CoefficientsOfPowersOfTenAreOthers) {
  const auto allowed = [](const char* unit) {
    return unit_fault("t.csv", unit, CurveUnit::per_metre, "; a factor converts").value_or("");
  };
  for (const char* unit : {"1/m, base 10", "m^-1 (log10)", "1/m; decadic", "m⁻¹ (Decadic)"})
    EXPECT_TRUE(allowed(unit).ends_with(
        "allowed 1/m for powers of e: ln 10 times the coefficient for powers of 10; a factor converts)"))
        << unit << allowed(unit);
  for (const char* unit : {"absorption coefficient (1/cm)", "cm^{-1}", "1/m2", "absorption", "1"})
    EXPECT_TRUE(allowed(unit).ends_with("allowed 1/m; a factor converts)")) << unit << allowed(unit);
  for (const char* unit : {"1/m, base e", "m⁻¹", "per metre", "1/m", "m^{-1}", "absorption coefficient (1/m)",
                           "1/m; converted from decadic by ln 10"})
    EXPECT_EQ(allowed(unit), "") << unit;
}

TEST(CurveUnit, FactorsMayBeOtherQuantitiesButNoPartsOfThem) {
  struct Case {
    const char* unit;
    CurveUnit needed;
    bool fits;
  };
  for (const Case& told : {Case{"%", CurveUnit::fraction, false},
                           {"optical density", CurveUnit::fraction, false},
                           {"photons/(s m2 sr nm)", CurveUnit::fraction, true},
                           {"1/cm", CurveUnit::per_metre, false},
                           {"mm⁻¹; in air", CurveUnit::per_metre, false},
                           {"1/m, base 10", CurveUnit::per_metre, false},
                           {"1/m", CurveUnit::per_metre, true},
                           {"m2", CurveUnit::per_metre, true},
                           {"share of 1", CurveUnit::per_metre, true},
                           {"mW/(m2 sr nm)", CurveUnit::spectral_radiance, false},
                           {"W m-2 sr-1 um-1", CurveUnit::spectral_radiance, false},
                           {"mW/nm", CurveUnit::spectral_flux, false},
                           {"W/(m2 nm)", CurveUnit::spectral_radiance, true},
                           {"photons/(s cm2 sr nm)", CurveUnit::spectral_radiance, true},
                           {"mW/nm", CurveUnit::power, true}})
    EXPECT_EQ(!unit_fault("t.csv", told.unit, told.needed, {}, UnitRole::factor), told.fits) << told.unit;
}

TEST(CurveUnit, NamesOfFractionsNeedNoUnit) {
  const auto allowed = [](const char* unit) {
    return unit_fault("t.csv", unit, CurveUnit::fraction).value_or("");
  };
  for (const char* unit :
       {"reflectance", "total transmittance", "transmittance, OD 4 blocking", "quantum efficiency", "QE",
        "fraction (100% = 1)", "fraction, not %", "electrons per photon", "e-/photon",
        "relative transmittance", "internal transmittance (0-1), 10 mm", "W/W",
        "relative response per photon or throughput"})
    EXPECT_EQ(allowed(unit), "") << unit;
  for (const char* unit : {"responsivity (mA/W)", "A/W", "DN/(nJ/cm2)", "absorption", "log book 12"})
    EXPECT_NE(allowed(unit).find("allowed fractions of 1: 1, 0-1, relative, electrons/photon or a name"),
              std::string::npos)
        << unit;
  EXPECT_NE(allowed("W/m2/nm").find("allowed fractions of 1)"), std::string::npos);
}

TEST(CurveUnit, UnknownUnitsAreRefusedWithAllThatAreAllowed) {
  EXPECT_EQ(unit_fault("t.csv", "W/nm per lamp", CurveUnit::power).value_or(""),
            "\"t.csv\" has the wrong unit (got \"W/nm per lamp\", allowed power per nm: W/nm, W/(m^2 nm), "
            "W/(sr nm), W/(m^2 sr nm) or multiples, 1 or relative)");
  for (const CurveUnit needed : {CurveUnit::fraction, CurveUnit::power, CurveUnit::spectral_irradiance}) {
    EXPECT_TRUE(unit_fault("t.csv", "W/m2/mum", needed));
    EXPECT_TRUE(unit_fault("t.csv", "W/m2/mum", needed, {}, UnitRole::factor));
  }
  EXPECT_FALSE(unit_fault("t.csv", "W/m2/mum", CurveUnit::any));
  EXPECT_FALSE(unit_fault("t.csv", "mW/(m2 nm)", CurveUnit::power)) << "of any scale";
}

TEST(CurveUnit, RelativeSpectraAreNoQuantities) {
  for (const char* unit :
       {"a.u.", "A.U.", "arb. u.", "arbitrary units", "rel.", "norm.", "counts", "%",
        "relative intensity (%)", "normalized to 560 nm", "unitless", "relative power per nm"})
    EXPECT_TRUE(relative_power("t.csv", unit, CurveUnit::spectral_flux)) << unit;
  EXPECT_FALSE(relative_power("t.csv", "W/m2/nm, relative to 1 AU", CurveUnit::spectral_irradiance));
  EXPECT_EQ(relative_power("D65", "relative spectrum", CurveUnit::spectral_radiance).value_or(""),
            "\"D65\" is used in W/(m^2 sr nm), but its unit is \"relative spectrum\": scale the "
            "emission to a quantity");
  for (const char* unit : {"W/(m2 sr nm), relative error 1 %", "1", "spectral radiance"})
    EXPECT_FALSE(relative_power("t.csv", unit, CurveUnit::spectral_flux)) << unit;
  EXPECT_FALSE(relative_power("t.csv", "relative", CurveUnit::power)) << "of any scale";
  for (const auto& [unit, power] : {std::pair{"mW/nm", true}, {"relative; W/nm", false}})
    EXPECT_EQ(declares_power(unit), power) << unit;
}

TEST(CurveUnit, UnitsThatSpeakOfPhotonsLeaveAResponseUnsaid) {
  for (const char* unit :
       {"e-/photon", "electrons/photon", "QE", "QE (0-1)", "quantum yield", "per Photon",
        "Quantum efficiency", "response (electrons/photon)", "sensitivity, electrons per photon"})
    EXPECT_NE(unknown_response("t.csv", unit).value_or("").find("is used as a response to energy"),
              std::string::npos)
        << unit;
  for (const char* unit :
       {"relative", "photopic response", "A/W", "relative to an opaque plate", "e-/J",
        "relative energy response; converted from photon response", "relative (energy, not quantum)",
        "energy response of a photon counter", "relative, photon noise removed"})
    EXPECT_FALSE(unknown_response("t.csv", unit)) << unit;
}

}  // namespace
}  // namespace abbe
