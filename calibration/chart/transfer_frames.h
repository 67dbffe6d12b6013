#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/inputs.h"
#include "sensor/readout/photon_transfer.h"

namespace abbe {

/// What flat and dark frames say of one channel of a sensor.
struct ChannelTransfer {
  std::string channel;
  PhotonTransfer transfer;
  /// What saturates over read noise [dB]: 20 log10 of it [EMVA1288]. Nothing where no lit pair saturates.
  std::optional<double> dynamic_range_db;
  /// Electrons at which the signal is ten times its noise: e/sqrt(e + read noise^2) = 10.
  double snr10_e;
  std::optional<double>
      snr10_lx_s;  ///< The same as an exposure of the most sensitive channel, where it is told.
};

/// The photon transfer of raw files that Abbe wrote, of any kind: two frames of each exposure, one after the
/// other, dark ones of two exposure times or more. Exposure times, bits, mosaic and the pixels that were
/// rendered, which alone count, are read of the files. `warnings`, if any, receives those about files.
/// Throws Error{input} naming a file that tells of no read-out or differs from the first in size, rendered
/// pixels, channels, bits, gain or response curve, one of which more than 0.5 % of a channel's codes, but not
/// all, are the lowest, where noise is cut off [EMVA1288], and one without a second of its exposure that saw
/// the same light, as far as row noise lets that be known, and is another frame; otherwise as
/// `photon_transfer`.
[[nodiscard]] std::vector<ChannelTransfer> measure_transfer(std::span<const std::filesystem::path> dark,
                                                            std::span<const std::filesystem::path> lit,
                                                            Inputs& inputs,
                                                            std::vector<std::string>* warnings = nullptr);

}  // namespace abbe
