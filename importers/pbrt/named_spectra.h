#pragma once

#include <array>
#include <string_view>

// Tables of Abbe for pbrt's named spectra and sensors.
namespace abbe::importers::pbrt {

/// A name of pbrt and the table of Abbe that replaces it.
struct Renamed {
  std::string_view source_name;  ///< Case-sensitive name in pbrt.
  std::string_view table_name;   ///< Name of a table that Abbe ships.
};

/// Metals, as tables of n and k. pbrt's names have the further ending "-eta" for n or "-k" for k.
inline constexpr std::array<Renamed, 6> kMetals{{{"metal-Ag", "Ag_Johnson"},
                                                 {"metal-Al", "Al_Rakic"},
                                                 {"metal-Au", "Au_Johnson"},
                                                 {"metal-Cu", "Cu_Johnson"},
                                                 {"metal-CuZn", "CuZn_Cu70Zn30_Querry"},
                                                 {"metal-TiO2", "TiO2_Sarkar"}}};

/// Glasses. pbrt's tables for the last three are those of SF5, SF10 and SF11.
inline constexpr std::array<Renamed, 7> kGlasses{{{"glass-BK7", "N-BK7"},
                                                  {"glass-BAF10", "N-BAF10"},
                                                  {"glass-FK51A", "N-FK51A"},
                                                  {"glass-LASF9", "schott/N-LASF9"},
                                                  {"glass-F5", "schott/SF5"},
                                                  {"glass-F10", "SF10"},
                                                  {"glass-F11", "SF11"}}};

/// There is no shipped table of MgO: this is its index at the d line by the dispersion formula of
/// [Stephens1952], without absorption.
inline constexpr std::string_view kMagnesia = "metal-MgO";
inline constexpr double kMagnesiaIndex = 1.7375;

/// CIE illuminants, as relative spectra.
inline constexpr std::array<Renamed, 17> kIlluminants{{{"stdillum-A", "A"},
                                                       {"stdillum-D50", "D50"},
                                                       {"stdillum-D65", "D65"},
                                                       {"stdillum-F1", "FL1"},
                                                       {"stdillum-F2", "FL2"},
                                                       {"stdillum-F3", "FL3"},
                                                       {"stdillum-F4", "FL4"},
                                                       {"stdillum-F5", "FL5"},
                                                       {"stdillum-F6", "FL6"},
                                                       {"stdillum-F7", "FL7"},
                                                       {"stdillum-F8", "FL8"},
                                                       {"stdillum-F9", "FL9"},
                                                       {"stdillum-F10", "FL10"},
                                                       {"stdillum-F11", "FL11"},
                                                       {"stdillum-F12", "FL12"},
                                                       {"illum-acesD60", "D60"},
                                                       {"stdillum-D60", "D60"}}};

/// Cameras, as tables of `data/camera`. pbrt's other sensors have no table in Abbe.
inline constexpr std::array<Renamed, 7> kSensors{{{"canon_eos_5d", "Canon_EOS_5D"},
                                                  {"canon_eos_5d_mkii", "Canon_EOS_5D_Mark_II"},
                                                  {"canon_eos_5d_mkiii", "Canon_EOS_5D_Mark_III"},
                                                  {"canon_eos_5d_mkiv", "Canon_EOS_5D_Mark_IV"},
                                                  {"nikon_d810", "Nikon_D810"},
                                                  {"nikon_d850", "Nikon_D850"},
                                                  {"sony_ilce_7m3", "Sony_ILCE-7M3"}}};

}  // namespace abbe::importers::pbrt
