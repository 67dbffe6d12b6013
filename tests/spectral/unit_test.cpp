#include "spectral/curve_use.h"

#include <string>

#include <gtest/gtest.h>

namespace abbe {
namespace {

using Kind = TableUnit::Kind;

constexpr unsigned kRadiance = TableUnit::area | TableUnit::solid_angle | TableUnit::wavelength;
constexpr unsigned kIrradiance = TableUnit::area | TableUnit::wavelength;

TEST(Unit, IsReadInThreeNotations) {
  struct Case {
    const char* told;
    Kind kind;
    unsigned divisors;
    int log10_factor;
  };
  for (const Case& told : {Case{"W/(m^2 sr nm)", Kind::power, kRadiance, 0},
                           {"W/m^2/sr/nm", Kind::power, kRadiance, 0},
                           {"W / m2 / sr / nm", Kind::power, kRadiance, 0},
                           {"W m-2 sr-1 nm-1", Kind::power, kRadiance, 0},
                           {"W·sr⁻¹·m⁻²·nm⁻¹", Kind::power, kRadiance, 0},
                           {"W m^{-2} sr^{-1} nm^{-1}", Kind::power, kRadiance, 0},
                           {"W*sr^-1*m^-2*nm^-1", Kind::power, kRadiance, 0},
                           {"kW/(m² sr µm)", Kind::power, kRadiance, 0},
                           {"mW/(cm2 nm)", Kind::power, kIrradiance, 1},
                           {"μW/(mm2·nm)", Kind::power, kIrradiance, 0},
                           {"W/m2/\u212B", Kind::power, kIrradiance, 1},
                           {"W", Kind::power, 0, 0},
                           {"1 / cm", Kind::coefficient, TableUnit::length, 2},
                           {"m^{-1}", Kind::coefficient, TableUnit::length, 0},
                           {"umol/(m^2 s nm)", Kind::photons, kIrradiance | TableUnit::time, 0}}) {
    const TableUnit unit = table_unit(told.told);
    EXPECT_EQ(unit.kind, told.kind) << told.told;
    EXPECT_EQ(unit.divisors, told.divisors) << told.told;
    EXPECT_EQ(unit.log10_factor, told.log10_factor) << told.told;
  }
}

TEST(Unit, StandsAloneOrBehindWhatItIsOf) {
  for (const char* told : {"mW/nm", "mW/nm; of a lamp at 25 C", "mW/nm (2 pi sr)", "spectral flux, mW/nm",
                           "spectral flux [mW/nm]", "spectral flux (mW/nm)", "spectral flux in mW/nm",
                           "wavelength in nm, mW/nm"}) {
    const TableUnit unit = table_unit(told);
    EXPECT_EQ(unit.kind, Kind::power) << told;
    EXPECT_EQ(unit.log10_factor, -3) << told;
  }
}

TEST(Unit, IsNoneInOtherSpellings) {
  for (const char* told : {"",
                           "-",
                           "nm",
                           "furlongs",
                           "A",
                           "V",
                           "A/W",
                           "W/m2/mum",
                           "W/(m2 furlong)",
                           "W/m2/nm^x",
                           "W/nm/lamp",
                           "W/",
                           "/",
                           "(",
                           "W/(",
                           "())(",
                           "Wm-2nm-1",
                           "watts per nm",
                           "W/cm3",
                           "W/m",
                           "W nm",
                           "W/nm/nm",
                           "1/nm",
                           "1/m2",
                           "W/(m2 Hz)",
                           "W/(m2 sr cm-1)",
                           "lm/nm",
                           "log10 W/nm",
                           "T%",
                           "spectral radiance",
                           "relative power per THz",
                           "mw/nm"})
    EXPECT_EQ(table_unit(told).kind, Kind::unknown) << told;
  EXPECT_EQ(table_unit("W/" + std::string(100000, '(')).kind, Kind::unknown);
}

}  // namespace
}  // namespace abbe
