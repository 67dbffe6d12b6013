#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"
#include "transport/path/packet.h"
#include "transport/path/spectra.h"

namespace abbe {

/// The packets that the paths of one block share, a block being one sample of every pixel of a tile: of each
/// distribution of wavelengths 32, the cumulative distribution between two lanes cut in 32 by a random
/// offset. A path picks one of them, and its hero, by the number it would have drawn a packet of its own by,
/// so that every path by itself has the wavelengths it would have had in law; those of one pixel come from
/// different blocks. Serves one thread.
class Palette {
 public:
  static constexpr int kPackets = 32;

  Palette(const Scene& scene, std::size_t distributions);

  /// Starts a block whose offset for a distribution is `offset` in [0, 1).
  void begin(std::size_t distribution, const WavelengthDistribution& of, float offset);
  /// The packet that `u` in [0, 1) picks, and what is known at it.
  struct Pick {
    PathPacket packet;
    SharedSpectra* spectra;
  };
  [[nodiscard]] Pick pick(std::size_t distribution, float u);

 private:
  std::vector<SharedSpectra> spectra_;  // of each distribution kPackets
};

}  // namespace abbe
