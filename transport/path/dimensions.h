#pragma once

#include <cstddef>
#include <cstdint>

namespace abbe {

// Indices of groups of four random numbers (`Sampler::group`), one group per use. Camera paths and light
// paths have different samplers, so they may use equal indices.

/// Group of a camera path: two numbers for the film position within the pixel, one for the packet
/// (`draw_packet`), one for the time. Position and wavelength have one group, because the spectrum on the
/// film depends on both.
inline constexpr std::uint32_t kFilmGroup = 0;
/// Group of a camera path: two numbers for the point on the lens or probe.
inline constexpr std::uint32_t kLensGroup = 1;
/// Group of a light path: two numbers for its direction or target point, one for the packet, one for the
/// time.
inline constexpr std::uint32_t kPhotonGuideGroup = 0;
/// Group of a light path: two numbers for the point on the light, or the direction of a light at infinity.
/// The third chooses between guide and emission, the fourth the light.
inline constexpr std::uint32_t kEmissionGroup = 1;
/// Index within `kFilmGroup`, `kPhotonGuideGroup` and `kGhostGroup` of the number for the time of the path.
inline constexpr std::size_t kTimeIndex = 3;
/// Group for a point on the lens and the time; the next group chooses a light that is visible from the point
/// by way of a lens ghost. A camera with ghosts is never a probe, so no group for scattering is equal.
inline constexpr std::uint32_t kGhostGroup = 2;

/// Depth of the scattering at a probe, where camera paths scatter before they hit the first surface.
inline constexpr int kProbeDepth = -1;

/// Group for the scattering at depth `event`, which is at least `kProbeDepth`: two numbers for the direction,
/// one for the lobe, one for roulette. The numbers that a matt surface does not use may draw the next
/// direction. The following group is for next-event estimation at the vertex.
[[nodiscard]] constexpr std::uint32_t scattering_group(int event) {
  return 2 + 2 * static_cast<std::uint32_t>(event - kProbeDepth);
}
/// Group for the absorption decision of a brute-force path at depth `event`.
[[nodiscard]] constexpr std::uint32_t absorption_group(int event) {
  return 0x40000000 + static_cast<std::uint32_t>(event);
}
/// Group for the free path in a scattering medium before the event at depth `event`: two numbers for the free
/// path, two for equiangular sampling along the segment. After an event within a medium the spare numbers of
/// that event are used instead.
[[nodiscard]] constexpr std::uint32_t free_path_group(int event) {
  return 0x80000000 + static_cast<std::uint32_t>(event);
}
/// Group for the second direction that the caustic guide may add at depth `event`: two numbers for the
/// direction, one for the lobe, one for the decision to add a path.
[[nodiscard]] constexpr std::uint32_t guide_group(int event) {
  return 0xA0000000 + static_cast<std::uint32_t>(event - kProbeDepth);
}
/// Group whose first number decides which samples trace a path through a pixel, if not all samples do.
inline constexpr std::uint32_t kPhaseGroup = 0xC0000000;
/// Group whose first number decides which vertices of a long path are connected to another path.
inline constexpr std::uint32_t kJoiningGroup = 0xE0000000;

}  // namespace abbe
