#pragma once

#include <array>
#include <string_view>

// Mitsuba's names of dielectrics and metals.
namespace abbe::importers::mitsuba {

struct NamedIndex {
  std::string_view name;
  double n;
};
/// Refractive indices of its dielectrics, which have no dispersion. Names are matched in any case.
inline constexpr std::array<NamedIndex, 23> kDielectrics{
    {{"vacuum", 1},        {"helium", 1.000036},        {"hydrogen", 1.000132},
     {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.333},
     {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
     {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
     {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
     {"pyrex", 1.47},      {"acrylic glass", 1.49},     {"polypropylene", 1.49},
     {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
     {"pet", 1.575},       {"diamond", 2.419}}};

struct NamedMetal {
  std::string_view source_name;
  std::string_view table_name;
};
inline constexpr std::array<NamedMetal, 14> kMetals{{{"Ag", "Ag_Johnson"},
                                                     {"Al", "Al_Rakic"},
                                                     {"Au", "Au_Johnson"},
                                                     {"Be", "Be_Rakic-BB"},
                                                     {"Cr", "Cr_Johnson"},
                                                     {"Cu", "Cu_Johnson"},
                                                     {"Hg", "Hg_Inagaki"},
                                                     {"Ir", "Ir_Roberts"},
                                                     {"Mo", "Mo_Kirillova"},
                                                     {"Rh", "Rh_Weaver"},
                                                     {"TiN", "TiN_Pfluger"},
                                                     {"TiO2", "TiO2_Sarkar"},
                                                     {"V", "V_Johnson"},
                                                     {"W", "W_Weaver"}}};

}  // namespace abbe::importers::mitsuba
