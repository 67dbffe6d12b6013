#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/inputs.h"
#include "sensor/readout/photon_transfer.h"

namespace abbe {

/// Photon transfer of one channel of a sensor, from flat and dark frames.
struct ChannelTransfer {
  std::string channel;
  PhotonTransfer transfer;
  /// Dynamic range [dB] [EMVA1288]: 20 log10 of saturation over read noise, infinite without read noise.
  /// Empty if no bright pair saturates.
  std::optional<double> dynamic_range_db;
  /// Electrons at which the signal is ten times its noise: e/sqrt(e + read noise^2) = 10.
  double snr10_e;
  /// `snr10_e` as an exposure of the most sensitive channel [lx s]; empty if its sensitivity is unknown.
  std::optional<double> snr10_lx_s;
};

/// Photon transfer of raw files that Abbe wrote, of any format. `dark` and `bright` hold two consecutive
/// frames of each exposure; dark frames need two exposure times or more. Exposure times, bits, mosaic and the
/// rendered pixels, which alone count, are read from the files. Returns one result per channel, in the order
/// of the files. `inputs` records all files and limits their memory. Adds warnings about files to `warnings`,
/// unless null.
///
/// Throws Error{input} naming a file that
/// - records no read-out, or has fewer than two pixels of a channel;
/// - differs from the first in size, rendered pixels, channels, bits, gain or response curve;
/// - has more than 0.5 % of a channel's codes, but not all, at the lowest code, where noise is cut off
///   [EMVA1288];
/// - has no second frame of its exposure, or a copy of it, or one that saw other light, as far as row noise
///   allows that test.
///
/// Throws Error{usage} if `dark` or `bright` is empty, and as `read_raw_image` and `photon_transfer`.
[[nodiscard]] std::vector<ChannelTransfer> measure_transfer(std::span<const std::filesystem::path> dark,
                                                            std::span<const std::filesystem::path> bright,
                                                            Inputs& inputs,
                                                            std::vector<std::string>* warnings = nullptr);

}  // namespace abbe
