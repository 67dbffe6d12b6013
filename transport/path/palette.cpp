#include "transport/path/palette.h"

#include <algorithm>

namespace abbe {

Palette::Palette(const Scene& scene, std::size_t distributions)
    : spectra_(distributions * kPackets, SharedSpectra(scene)) {}

void Palette::begin(std::size_t distribution, const WavelengthDistribution& of, float offset) {
  for (int i = 0; i < kPackets; ++i)
    spectra_[distribution * kPackets + static_cast<std::size_t>(i)].begin(
        of.sample((static_cast<float>(i) + offset) / (kPackets * kLanes)));
}

Palette::Pick Palette::pick(std::size_t distribution, float u) {
  const int choice = std::min(static_cast<int>(u * (kPackets * kLanes)), kPackets * kLanes - 1);
  SharedSpectra& spectra = spectra_[distribution * kPackets + static_cast<std::size_t>(choice % kPackets)];
  PathPacket packet;
  packet.wavelengths = spectra.wavelengths();
  packet.hero = choice / kPackets;
  return {packet, &spectra};
}

}  // namespace abbe
