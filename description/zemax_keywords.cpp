#include "description/zemax_keywords.h"

#include <algorithm>
#include <array>

namespace abbe::description::zemax {
namespace {

constexpr std::array<std::string_view, 44> kIdle{
    // of the system
    "VERS", "NOTE", "PFIL", "LANG", "GFAC", "RAIM", "PUSH", "SDMA", "OMMA", "ROPD", "HYPR", "PICB", "FWGN",
    "FWGT", "WWGN", "WWGT", "POLS", "GLRS", "GSTD", "NSCD", "COFN", "BLNK", "TOL", "MOFF", "TITL",
    // of surfaces
    "COMM", "FIMP", "HIDE", "MIRR", "SLAB", "POPS", "MEMA", "VDSZ", "VCUR", "VCON", "VPAR", "PZUP", "PCUR",
    "PPAR", "PCON", "MAZH", "RSCE", "RSCO", "SCOL"};

}  // namespace

bool is_idle(std::string_view word) {
  return std::find(kIdle.begin(), kIdle.end(), word) != kIdle.end();
}

std::vector<std::string> idle_words() {
  return {kIdle.begin(), kIdle.end()};
}

}  // namespace abbe::description::zemax
