#include "description/zemax_keywords.h"

#include <algorithm>
#include <array>

namespace abbe::description::zemax {
namespace {

constexpr std::array<std::string_view, 44> kIgnored{
    // Keywords of the system.
    "VERS", "NOTE", "PFIL", "LANG", "GFAC", "RAIM", "PUSH", "SDMA", "OMMA", "ROPD", "HYPR", "PICB", "FWGN",
    "FWGT", "WWGN", "WWGT", "POLS", "GLRS", "GSTD", "NSCD", "COFN", "BLNK", "TOL", "MOFF", "TITL",
    // Keywords of surfaces.
    "COMM", "FIMP", "HIDE", "MIRR", "SLAB", "POPS", "MEMA", "VDSZ", "VCUR", "VCON", "VPAR", "PZUP", "PCUR",
    "PPAR", "PCON", "MAZH", "RSCE", "RSCO", "SCOL"};

}  // namespace

bool is_ignored(std::string_view word) {
  return std::find(kIgnored.begin(), kIgnored.end(), word) != kIgnored.end();
}

std::vector<std::string> ignored_words() {
  return {kIgnored.begin(), kIgnored.end()};
}

}  // namespace abbe::description::zemax
