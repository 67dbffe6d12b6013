#include "lens/focus.h"

namespace abbe::lens {
namespace {

constexpr int kFocusCells = 48;  // across a beam

}  // namespace

std::vector<std::vector<Spot>> all_spots(const System& system, double stop_radius_mm, int side) {
  std::vector<std::vector<Spot>> groups;
  for (const double field : system.fields) {
    std::vector<Spot>& group = groups.emplace_back();
    for (const double nm : system.wavelengths_nm) {
      const SystemAt at(system, nm);
      if (const auto beam = Beam::of(at, field, stop_radius_mm))
        group.push_back(spot(*beam, field, side));
      else
        group.push_back({nm, field, {}});
    }
  }
  return groups;
}

std::optional<double> best_focus(const System& system) {
  return best_focus(all_spots(system, stop_radius(system), kFocusCells));
}

}  // namespace abbe::lens
