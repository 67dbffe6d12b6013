#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "materials/material.h"
#include "scene/scene.h"
#include "spectral/packet.h"

namespace abbe {

/// What matter and lights are at the wavelengths of one packet that many paths share, worked out when it is
/// first asked for and kept while the packet lasts. Serves one thread.
class SharedSpectra {
 public:
  explicit SharedSpectra(const Scene& scene) : scene_(scene) {}

  /// Starts a packet: all that is kept is forgotten.
  void begin(const SampledWavelengths& wavelengths);
  [[nodiscard]] const SampledWavelengths& wavelengths() const { return wavelengths_; }

  /// The scattering of a material that needs no surface coordinates, in air.
  [[nodiscard]] const Bsdf& bsdf(std::uint32_t material) {
    Kept<Bsdf>& kept = bsdfs_[material % kKept];
    if (kept.number != material || kept.packet != packet_) [[unlikely]]
      look_up(material, kept);
    return kept.value;
  }
  /// What light of these wavelengths counts in a channel that does not depend on the angle, over the density
  /// they were drawn with.
  [[nodiscard]] const SampledSpectrum& channel_share(std::uint32_t channel) {
    Kept<SampledSpectrum>& kept = channel_shares_[channel % kKept];
    if (kept.number != channel || kept.packet != packet_) [[unlikely]]
      kept = {channel, packet_, scene_.channels[channel].weight(wavelengths_.lambda_nm) / wavelengths_.pdf};
    return kept.value;
  }
  /// The emission of a light that is no image.
  [[nodiscard]] const SampledSpectrum& emission(std::uint32_t light) {
    Kept<SampledSpectrum>& kept = emissions_[light % kKept];
    if (kept.number != light || kept.packet != packet_) [[unlikely]]
      kept = {light, packet_, scene_.lights[light].emission(wavelengths_.lambda_nm)};
    return kept.value;
  }

 private:
  static constexpr std::size_t kKept = 64;
  template <typename T>
  struct Kept {
    std::uint32_t number = 0;
    std::uint32_t packet = 0;  // since when; 0 is none
    T value = {};
  };
  void look_up(std::uint32_t material, Kept<Bsdf>& kept) const;

  const Scene& scene_;
  SampledWavelengths wavelengths_;
  std::uint32_t packet_ = 0;
  std::array<Kept<Bsdf>, kKept> bsdfs_;
  std::array<Kept<SampledSpectrum>, kKept> emissions_;
  std::array<Kept<SampledSpectrum>, kKept> channel_shares_;
};

}  // namespace abbe
