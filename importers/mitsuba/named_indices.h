#pragma once

#include <array>
#include <string_view>

// Materials that Mitsuba knows by name: dielectrics by their index, and metals.
namespace abbe::importers::mitsuba {

struct NamedIndex {
  std::string_view name;  ///< Name in Mitsuba, in lower case.
  double n;               ///< Refractive index relative to vacuum, the same at all wavelengths.
};
/// Mitsuba's dielectrics. Scene files may write their names in any case, so convert them to lower case first.
inline constexpr std::array<NamedIndex, 23> kDielectrics{
    {{"vacuum", 1},        {"helium", 1.000036},        {"hydrogen", 1.000132},
     {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.333},
     {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
     {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
     {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
     {"pyrex", 1.47},      {"acrylic glass", 1.49},     {"polypropylene", 1.49},
     {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
     {"pet", 1.575},       {"diamond", 2.419}}};

/// A metal of Mitsuba for which Abbe ships a table.
struct NamedMetal {
  std::string_view source_name;  ///< Case-sensitive name in Mitsuba.
  std::string_view table_name;   ///< Name of the table of n and k that Abbe ships.
};
/// All metals of Mitsuba for which Abbe ships a table.
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
