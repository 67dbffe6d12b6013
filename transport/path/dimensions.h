#pragma once

#include <cstddef>
#include <cstdint>

namespace abbe {

/// Which group of four random numbers a path uses for what. The film position shares its group with the
/// wavelength, since a spectrum on the film is a function of both; a photon's target shares its with the
/// same. The time within the exposure is the fourth number there, `kTimeNumber`, of either.
inline constexpr std::uint32_t kFilmGroup = 0;
inline constexpr std::uint32_t kLensGroup = 1;
inline constexpr std::uint32_t kAimGroup = 0;
inline constexpr std::uint32_t kEmissionGroup = 1;
inline constexpr std::size_t kTimeNumber = 3;
/// A point of the lens and, in the next group, a light that it sees by way of a ghost; no camera that has
/// these is a meter.
inline constexpr std::uint32_t kGhostGroup = 2;

/// Number of the event at a meter, where camera paths scatter before they meet the first surface.
inline constexpr int kMeterEvent = -1;

/// The group for the scattering of an event, its direction first, then a lobe and roulette; what a matt
/// surface leaves of it may draw the direction of the next event. The next group is for the connection made
/// there.
[[nodiscard]] constexpr std::uint32_t scattering_group(int event) {
  return 2 + 2 * static_cast<std::uint32_t>(event - kMeterEvent);
}
/// The group for whether a path of brute force is absorbed at an event.
[[nodiscard]] constexpr std::uint32_t absorption_group(int event) {
  return 0x40000000 + static_cast<std::uint32_t>(event);
}
/// The group for how far a path comes in matter that scatters, before an event; but after one within matter,
/// numbers which that leaves say so. The last two are for a connection from along the way.
[[nodiscard]] constexpr std::uint32_t free_path_group(int event) {
  return 0x80000000 + static_cast<std::uint32_t>(event);
}
/// The group for the second direction that a camera path may leave an event in, by its caustic guide: the
/// direction, then a lobe and whether there is one.
[[nodiscard]] constexpr std::uint32_t guide_group(int event) {
  return 0xA0000000 + static_cast<std::uint32_t>(event - kMeterEvent);
}
/// The group for which samples have a path through a pixel, where not all have one.
inline constexpr std::uint32_t kPhaseGroup = 0xC0000000;
/// The group for which vertices of a long path are joined to those of another.
inline constexpr std::uint32_t kJoiningGroup = 0xE0000000;

}  // namespace abbe
