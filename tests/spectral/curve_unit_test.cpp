#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "spectral/curve_use.h"

namespace abbe {
namespace {

TEST(CurveUnit, PercentIsNoShareHoweverItIsWritten) {
  for (const char* unit :
       {"%", "percent", "Per cent; wavelength in nm", "quantum efficiency [%]", "T%", "R%", "Trans%", "100%T",
        "100%R", "reflectance (%)", "reflectance in percent", "transmittance, 0-100 %"})
    EXPECT_NE(unit_fault("t.csv", unit, CurveUnit::fraction).value_or("").find("allowed fractions of 1"),
              std::string::npos)
        << unit;
  for (const char* unit : {"1", "reflectance factor (0-1)", "reflectance (0-1), within 0.5 %",
                           "transmittance (1 = 100 %)", "reflectance (0-1); uncertainty in percent"})
    EXPECT_FALSE(unit_fault("t.csv", unit, CurveUnit::fraction)) << unit;
  EXPECT_FALSE(unit_fault("t.csv", "%", CurveUnit::any));
}

TEST(CurveUnit, DensitiesAndDecibelsAreNoShares) {
  const auto allowed = [](const char* unit) {
    return unit_fault("t.csv", unit, CurveUnit::fraction, "; a factor converts").value_or("");
  };
  for (const char* unit : {"optical density", "Absorbance (decadic)", "OD", "extinction",
                           "attenuation; of 2 mm", "neutral density filter, density", "transmission density"})
    EXPECT_TRUE(allowed(unit).ends_with("allowed fractions of 1: 10^-D for a density D)"))
        << unit << allowed(unit);
  for (const char* unit : {"attenuation in dB", "dB", "insertion loss [dB]"})
    EXPECT_TRUE(allowed(unit).ends_with("allowed fractions of 1: 10^(-A/10) for A dB)"))
        << unit << allowed(unit);
  for (const char* unit :
       {"transmittance of a neutral density filter", "transmittance (0-1); not the density",
        "model of the camera's body", "reflectance, adbmal"})
    EXPECT_EQ(allowed(unit), "") << unit;
}

TEST(CurveUnit, PhotonsAndPowersPerHertzAreNoPowersPerNm) {
  for (const CurveUnit needed : {CurveUnit::power, CurveUnit::spectral_radiance,
                                 CurveUnit::spectral_intensity, CurveUnit::spectral_irradiance}) {
    const auto allowed = [needed](const char* unit) {
      return unit_fault("t.csv", unit, needed, "; a factor converts").value_or("");
    };
    for (const char* unit : {"photons/(s m^2 nm)", "umol/(m^2 s nm)", "µmol m-2 s-1 nm-1", "mol/(s nm)",
                             "photons/(s m^2 sr nm)", "quanta per s and nm", "photon flux, relative"})
      EXPECT_TRUE(allowed(unit).ends_with("allowed power per nm: hc/lambda for each photon)"))
          << unit << allowed(unit);
    for (const char* unit : {"W/(m^2 Hz)", "W/(m2 sr Hz)", "relative power per THz", "Jy"})
      EXPECT_TRUE(allowed(unit).ends_with("allowed power per nm: c/lambda^2 times that per Hz)"))
          << unit << allowed(unit);
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
                           {"Watt per m² and sr and nm", true, false, false},
                           {"W/(m^2 nm)", false, false, true},
                           {"spectral irradiance, W/m2/nm", false, false, true},
                           {"Wm-2nm-1", false, false, true},
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
  for (const char* unit :
       {"W m-2 sr-1 um-1", "W m^-2 sr^-1 um^-1", "W·m⁻²·sr⁻¹·µm⁻¹", "W/m^2/sr/μm", "W/(um m2 sr)",
        "W per m2, sr and nm per micron", "W cm-2 sr-1 nm-1", "W cm^-2 sr^-1 nm^-1", "W/(cm² sr nm)",
        "Wcm-2sr-1nm-1", "μW/(cm2 sr nm)", "mW m-2 sr-1 nm-1", "spectral radiance in mW/(m2 sr nm)",
        "milliwatt", "erg/s", "erg/(s cm2 sr nm)", "W/(m2 sr Å)", "W m-2 sr-1 Angstrom-1"})
    EXPECT_TRUE(allowed(unit).ends_with("allowed W/(m^2 sr nm); a factor converts)"))
        << unit << allowed(unit);
  for (const char* unit : {"W/(m2 sr cm-1)", "W m⁻² sr⁻¹ (cm⁻¹)⁻¹"})
    EXPECT_TRUE(allowed(unit).ends_with("allowed power per nm: 10^7 nm cm^-1/lambda^2 times that per cm^-1)"))
        << unit << allowed(unit);
  for (const char* unit : {"cd/(m2 nm)", "lm/(m2 sr nm)", "lux"})
    EXPECT_TRUE(allowed(unit).ends_with("allowed W/(m^2 sr nm))")) << unit << allowed(unit);
  for (const char* unit :
       {"W m-2 sr-1 nm-1", "W·m⁻²·sr⁻¹·nm⁻¹", "W m**-2 sr**-1 nm**-1", "W/(m2 sr nm), wavelength in um",
        "W/(m2 sr nm) of a 2 kW lamp", "W/(m2 sr nm), 100 cd/m2 in all", "relative; mW", "1"})
    EXPECT_EQ(allowed(unit), "") << unit;
}

TEST(CurveUnit, FluxesArePowersOfWholeLamps) {
  const auto allowed = [](const char* unit) {
    return unit_fault("t.csv", unit, CurveUnit::spectral_flux, "; a factor converts").value_or("");
  };
  for (const char* unit : {"mW/nm", "uW/nm", "µW nm⁻¹", "mW/(m2 nm)", "W/(m2 nm)", "W m-2 nm-1", "W/(sr nm)",
                           "W/um", "W per micron"})
    EXPECT_TRUE(allowed(unit).ends_with("allowed W/nm; a factor converts)")) << unit << allowed(unit);
  EXPECT_TRUE(allowed("lm/nm").ends_with("allowed W/nm)")) << allowed("lm/nm");
  for (const char* unit : {"W/nm", "W nm-1", "watts per nm", "relative", "1"})
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
  for (const char* unit : {"1/m, base e", "m^-1 (natural, not decadic)", "m⁻¹", "per metre", "1/m"})
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
    EXPECT_EQ(!factor_unit_fault("t.csv", told.unit, told.needed), told.fits) << told.unit;
}

TEST(CurveUnit, RemarksMakeNoOtherUnit) {
  struct Case {
    CurveUnit needed;
    std::vector<const char*> units;
  };
  for (const Case& told :
       {Case{CurveUnit::per_metre,
             {"1/m; converted from decadic by ln 10", "1/m; decadic absorbance x 2.303",
              "1/m; a = 2.303 A/l, A base 10", "1/m; from log10 transmittance", "m^{-1}",
              "absorption coefficient (1/m)", "absorption coefficient, m-1"}},
        {CurveUnit::fraction,
         {"transmittance (0-1), OD > 6 blocking",
          "transmittance, OD 4 blocking",
          "transmittance (OD6 blocking)",
          "throughput (0-1) including atmospheric extinction at airmass 1.3",
          "transmittance of a neutral density filter, OD 1",
          "transmittance = 10^-absorbance",
          "1 - absorbance",
          "reflectance of high density polyethylene",
          "reflectance, 50 dB SNR",
          "reflectance factor of film of optical density 0.1",
          "fraction (100% = 1)",
          "1 means 100 %",
          "1 corresponds to 100 %",
          "reflectance of 100% cotton",
          "fraction, not %",
          "% / 100",
          "transmittance (uncertainty in %)",
          "99% Spectralon",
          "reflectance, 45% relative humidity",
          "R = 0..1 (not percent)",
          "electrons per photon",
          "e-/photon",
          "reflectance (s/p)",
          "transmittance/cm",
          "V(lambda)",
          "internal transmittance (0-1), 10 mm",
          "1.0 = 100.0 %",
          "transmittance (W/W)",
          "W/W",
          "W/m2/(W/m2)",
          "reflectance, W/W",
          "relative transmittance, LG",
          "log book 12"}},
        {CurveUnit::power,
         {"relative power of a quantum-dot LED",
          "relative power at 60 Hz mains",
          "relative spectral power in energy units, not photons",
          "W/(m2 nm), resolution 5 cm-1",
          "PWM at 1 kHz, relative",
          "relative energy (not quanta)",
          "W/nm, measured with a photon counter",
          "W/cm3",
          "J/(m2 nm)",
          "relative, 50 dB SNR",
          "a.u.",
          "counts",
          "nm, relative",
          "W/nm per lamp",
          "W/m2/nm per LED",
          "mW/nm/lamp",
          "W/m2/nm **",
          "W/furlong",
          "relative power, LG",
          "LG lamp",
          "log book 12",
          "log of lamp 12",
          "Log 12"}},
        {CurveUnit::spectral_radiance,
         {"W/(m2 sr nm), 100 Hz flicker averaged", "W/(m2 sr nm) of 2 mm2 LED",
          "W/(m2 sr nm) with 1 cm2 aperture", "W/(m2 sr nm) vs wavelength / um", "kW/(m2 sr um)",
          "GW/(m2 sr m)", "W/(m2 sr nm), measured with a photon counter", "W/(m2 sr nm), luminance 250 nit"}},
        {CurveUnit::spectral_irradiance, {"W/m2/nm, FOV 0.006 sr", "GW/m3", "W/m2/nm at 1 W"}},
        {CurveUnit::spectral_flux,
         {"W/nm (2 pi sr)", "W/nm into 4 pi sr", "W/nm, integrated over all sr", "W/nm in an m2-sphere",
          "W/nm (1000 lm)", "a.u."}}})
    for (const char* unit : told.units)
      EXPECT_EQ(unit_fault("t.csv", unit, told.needed).value_or(""), "") << unit;
}

TEST(CurveUnit, OtherUnitsAreOthersInAllSpellings) {
  struct Case {
    CurveUnit needed;
    const char* allowed;
    std::vector<const char*> units;
  };
  for (const Case& told :
       {Case{CurveUnit::spectral_irradiance,
             "allowed W/(m^2 nm); a factor converts)",
             {"W/cm^3", "W/cm3", "W m-3", "W/nm", "watts", "mW/m2/nm at 1 W", "1/nm",
              "uW/cm2/nm (1000 W FEL)"}},
        {CurveUnit::spectral_radiance,
         "allowed W/(m^2 sr nm); a factor converts)",
         {"W m-3 sr-1", "W/m^3/sr", "W/(m2.sr.um)", "W/(m2.µm.sr)", "W/(sr nm)", "1e-3 W/(m2 sr nm)"}},
        {CurveUnit::spectral_flux,
         "allowed W/nm; a factor converts)",
         {"mW/nm, 1 W in all", "W/5nm", "W/m", "W"}},
        {CurveUnit::power,
         "allowed power per nm: c/lambda^2 times that per Hz)",
         {"mJy", "uJy", "Jansky", "erg s^-1 cm^-2 Hz^-1", "relative power per THz"}},
        {CurveUnit::power,
         "allowed power per nm: hc/lambda^2 times that per unit of energy)",
         {"W/m2/eV", "W/(m^2 meV)"}},
        {CurveUnit::power,
         "allowed power per nm: 10^7 nm cm^-1/lambda^2 times that per cm^-1)",
         {"W/(m2 1/cm)", "W m-2 / cm^-1", "W m-2 sr-1 cm-1", "relative power per cm-1"}},
        {CurveUnit::power,
         "allowed power per nm: hc/lambda for each photon)",
         {"uE/m2/s", "μE m-2 s-1 nm-1", "photon counts", "counts (photons)", "relative photon flux",
          "micromoles"}},
        {CurveUnit::power, "allowed power per nm: 10^(A/10) for A dB)", {"dBm/nm", "dB", "dBm"}},
        {CurveUnit::fraction,
         "allowed fractions of 1; a factor converts)",
         {"pct", "‰", "0-100", "norm. to 100", "0..100", "0…100 %", "from 0% to 100%", "% R", "%R",
          "Percentage", "reflectance (in %)", "relative (max 100)", "per mille"}},
        {CurveUnit::per_metre,
         "allowed 1/m; a factor converts)",
         {"absorption coefficient (1/cm)", "cm^{-1}", "1/m2", "absorption"}}})
    for (const char* unit : told.units) {
      const std::string fault = unit_fault("t.csv", unit, told.needed, "; a factor converts").value_or("");
      EXPECT_TRUE(fault.ends_with(told.allowed)) << unit << ": " << fault;
    }
  EXPECT_TRUE(unit_fault("t.csv", "W/m2/nm", CurveUnit::fraction)) << "no share at all";
}

TEST(CurveUnit, UnitsThatCannotBeReadAreRefused) {
  struct Case {
    const char* unit;
    CurveUnit needed;
    const char* allowed = "products such as W/(m^2 nm)";
  };
  for (const Case& told : {Case{"W/m2/mum", CurveUnit::spectral_irradiance},
                           {"W/m2/sr/furlong", CurveUnit::spectral_radiance},
                           {"spectral power, W/furlong", CurveUnit::spectral_flux},
                           {"W/nm per lamp", CurveUnit::spectral_flux},
                           {"J/furlong", CurveUnit::fraction, "fractions of 1"}})
    for (const auto& fault :
         {unit_fault("t.csv", told.unit, told.needed), factor_unit_fault("t.csv", told.unit, told.needed)})
      EXPECT_EQ(fault.value_or(""), "\"t.csv\" has a unit that cannot be parsed (got \"" +
                                        std::string(told.unit) + "\", allowed " + told.allowed +
                                        "; put remarks after a \";\")");
  EXPECT_FALSE(unit_fault("t.csv", "W/m2/mum", CurveUnit::any));
}

TEST(CurveUnit, LogarithmsAreOthers) {
  struct Case {
    CurveUnit needed;
    std::vector<const char*> units;
  };
  for (const Case& told :
       {Case{CurveUnit::spectral_radiance,
             {"log10 W/m2/sr/nm", "log W·m⁻²·sr⁻¹·nm⁻¹", "log 10 W/(m2 sr nm)", "ln radiance",
              "radiance (log)"}},
        {CurveUnit::power, {"log10 W/nm/lamp", "log radiance", "relative power, log10", "logarithmic"}},
        {CurveUnit::fraction,
         {"log(reflectance)", "ln(T)", "Log10(reflectance)", "log of transmittance", "[log transmittance]"}}})
    for (const char* unit : told.units)
      EXPECT_TRUE(unit_fault("t.csv", unit, told.needed, "; a factor converts")
                      .value_or("")
                      .ends_with("allowed linear values: 10^x for log10 x, e^x for ln x)"))
          << unit;
}

TEST(CurveUnit, AngstromsAmperesAndVoltsAreOthers) {
  struct Case {
    const char* unit;
    CurveUnit needed;
  };
  for (const Case& told : {Case{"erg/s/cm2/A", CurveUnit::spectral_irradiance},
                           {"W/m2/A", CurveUnit::spectral_irradiance},
                           {"W/m2/AA", CurveUnit::spectral_irradiance},
                           {"W/m^2/Ang", CurveUnit::spectral_irradiance},
                           {"ph/s/m2/nm", CurveUnit::power},
                           {"A/W", CurveUnit::fraction},
                           {"responsivity (mA/W)", CurveUnit::fraction},
                           {"V/(uJ/cm2)", CurveUnit::fraction},
                           {"DN/(nJ/cm2)", CurveUnit::fraction},
                           {"response, e-/J", CurveUnit::fraction}})
    EXPECT_TRUE(unit_fault("t.csv", told.unit, told.needed)) << told.unit;
  EXPECT_TRUE(factor_unit_fault("t.csv", "W/m2/A", CurveUnit::spectral_irradiance));
  EXPECT_FALSE(unit_fault("t.csv", "erg/s/cm2/A", CurveUnit::power)) << "of any scale";
}

TEST(CurveUnit, RelativeSpectraAreNoQuantities) {
  for (const char* unit :
       {"a.u.", "A.U.", "arb. u.", "arbitrary units", "rel.", "norm.", "counts", "counts/s", "%",
        "relative intensity (%)", "SPD normalized to 560 nm", "unitless", "relative power per nm"})
    EXPECT_TRUE(relative_power("t.csv", unit, CurveUnit::spectral_flux)) << unit;
  EXPECT_FALSE(relative_power("t.csv", "W/m2/nm, relative to 1 AU", CurveUnit::spectral_irradiance));
  EXPECT_EQ(relative_power("D65", "relative spectrum", CurveUnit::spectral_radiance).value_or(""),
            "\"D65\" is used in W/(m^2 sr nm), but its unit is \"relative spectrum\": scale the "
            "emission to a quantity");
  for (const char* unit : {"W/(m2 sr nm), relative error 1 %", "1", "spectral radiance"})
    EXPECT_FALSE(relative_power("t.csv", unit, CurveUnit::spectral_flux)) << unit;
  EXPECT_FALSE(relative_power("t.csv", "relative", CurveUnit::power)) << "of any scale";
  for (const auto& [unit, power] : {std::pair{"mW/nm", true}, {"erg/s", true}, {"relative; W/nm", false}})
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
