#include "calibration/chart/transfer_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "calibration/chart/raw_scale.h"
#include "io/error.h"
#include "sensor/film/crop.h"

namespace abbe {
namespace {

constexpr double kCodeRangeFraction = 0.99;
constexpr double kSameGain = 1e-6;  // relative, since the text has few digits
constexpr double kSameLight = 0.1;  // relative, more than the flicker of lights
constexpr double kStandardErrors = 5;
constexpr std::size_t kMinRows = 8;   // enough to estimate the scatter of row means
constexpr double kUnderflow = 0.005;  // fraction of a channel's pixels

struct Frame {
  RawScale scale;  // with an exposure time
  double white_dn;
  int width;
  int height;
  std::vector<Crop> areas;  // rendered pixels
  std::vector<ChannelCodes> channels;
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw Error(ErrorCode::input, file.string(), what);
}

Frame read_frame(const std::filesystem::path& file, Inputs& inputs, std::vector<std::string>* warnings) {
  inputs.add_file(file);
  const auto [image, scale, about] = read_raw_image(file, &inputs);
  if (warnings != nullptr) warnings->insert(warnings->end(), about.begin(), about.end());
  if (!scale || !scale->exposure_s)
    refuse(file, "records neither bits nor exposure time: a raw file of `abbe develop` is needed");
  Frame frame{*scale,       white_dn(image, *scale), image.width,
              image.height, recorded_areas(image),   raw_codes(image, *scale)};
  for (const ChannelCodes& channel : frame.channels)
    if (channel.dn.size() < 2)
      refuse(file, fmt::format("has too few pixels in {} to measure noise (got {}, allowed 2 or more)",
                               channel.channel, channel.dn.size()));
  inputs.release_memory(image.memory_bytes());
  return frame;
}

void require_alike(const Frame& frame, const Frame& first, const std::filesystem::path& file) {
  if (!std::ranges::equal(frame.channels, first.channels, {}, &ChannelCodes::channel,
                          &ChannelCodes::channel) ||
      frame.width != first.width || frame.height != first.height)
    refuse(file, "has other pixels or channels than the first frame");
  if (frame.areas != first.areas)
    refuse(file,
           fmt::format(
               "was rendered at the pixels {}, the first frame at {}: fixed patterns need the same pixels",
               to_text(frame.areas), to_text(first.areas)));
  if (frame.scale.bits != first.scale.bits)
    refuse(file, fmt::format("has {} bits, the first frame {}", frame.scale.bits, first.scale.bits));
  const auto& gain = frame.scale.gain_e_per_dn;
  const auto& expected = first.scale.gain_e_per_dn;
  if (gain && expected && std::abs(*gain - *expected) > kSameGain * *expected)
    refuse(file, fmt::format("was read out at {} e/DN, the first frame at {}: measure one gain at a time",
                             *gain, *expected));
  if (frame.scale.linear_codes != first.scale.linear_codes)
    refuse(file, "has another response curve, offset_dn or saturation_dn than the first frame");
}

// Noise that is cut off at the lowest code raises the mean and lowers the scatter.
// If all codes are the lowest, as of an ideal read-out in the dark, there is no scatter to cut.
void require_no_underflow(const Frame& frame, const std::filesystem::path& file) {
  const double lowest = frame.scale.linear(0);
  for (const ChannelCodes& codes : frame.channels) {
    const auto clipped = std::ranges::count_if(codes.dn, [&](auto code) { return code <= lowest; });
    const double fraction = static_cast<double>(clipped) / static_cast<double>(codes.dn.size());
    if (fraction > kUnderflow && fraction < 1)
      refuse(file,
             fmt::format(
                 "{:.3g} % of its codes in {} are {}, the lowest, at which noise is cut off (allowed {} %), "
                 "so gain, read noise and dark current cannot be measured: give the read-out an offset_dn",
                 100 * fraction, codes.channel, lowest, 100 * kUnderflow));
  }
}

struct Moments {
  double mean;
  double mean_variance;  // variance of the mean
  std::size_t rows;
};

// Mean of a channel and its variance: that of independent pixels, or the larger one of independent rows,
// since the pixels of a row may have noise in common.
Moments moments(const ChannelCodes& codes) {
  const auto n = static_cast<double>(codes.dn.size());
  const double mean = std::accumulate(codes.dn.begin(), codes.dn.end(), 0.0) / n;
  std::map<int, double> row_sums;
  double squares = 0;
  auto code = codes.dn.begin();
  for (const auto& [y, count] : codes.rows) {
    double& row_sum = row_sums[y];
    for (std::size_t i = 0; i < count; ++i, ++code) {
      const double above = *code - mean;
      squares += above * above;
      row_sum += above;
    }
  }
  double row_squares = 0;
  for (const auto& [y, above] : row_sums) row_squares += above * above;
  const auto rows = static_cast<double>(row_sums.size());
  if (rows > 1) row_squares *= rows / (rows - 1);
  return {mean, std::max(squares, row_squares) / n / n, row_sums.size()};
}

// A few rows do not determine, in the dark, whether the means differ by more than noise.
void require_pair(const Frame& first, const Frame& second, bool are_dark, const std::filesystem::path& file) {
  if (second.scale.exposure_s != first.scale.exposure_s)
    refuse(file, fmt::format("is exposed for {} s and the frame before it for {}: two consecutive frames of "
                             "each exposure are needed",
                             *second.scale.exposure_s, *first.scale.exposure_s));
  bool is_copy = true;
  for (std::size_t c = 0; c < first.channels.size(); ++c) {
    const Moments a = moments(first.channels[c]);
    const Moments b = moments(second.channels[c]);
    // Frames in which all pixels have one code, dark or full, may be equal.
    is_copy = is_copy && first.channels[c].dn == second.channels[c].dn && a.mean_variance > 0;
    if (are_dark && a.rows < kMinRows) continue;
    const double difference = std::abs(a.mean - b.mean);
    const double signal = std::max(a.mean, b.mean) - first.scale.offset_dn;
    if (difference > kSameLight * signal &&
        difference > kStandardErrors * std::sqrt(a.mean_variance + b.mean_variance))
      refuse(file,
             fmt::format("has a mean of {:.5g} DN in {} and the frame before it {:.5g}: the two of a pair "
                         "see the same light",
                         b.mean, first.channels[c].channel, a.mean));
  }
  if (is_copy) refuse(file, "has exactly the codes of the frame before it: two exposures are needed");
}

std::vector<Frame> read_frames(std::span<const std::filesystem::path> files, bool are_dark, Inputs& inputs,
                               std::vector<std::string>* warnings) {
  std::vector<Frame> frames;
  for (const std::filesystem::path& file : files) {
    frames.push_back(read_frame(file, inputs, warnings));
    require_alike(frames.back(), frames.front(), file);
    require_no_underflow(frames.back(), file);
    if (frames.size() % 2 == 0) require_pair(frames[frames.size() - 2], frames.back(), are_dark, file);
  }
  if (files.size() % 2 == 1) refuse(files.back(), "is alone: two frames of each exposure are needed");
  return frames;
}

std::vector<FlatPair> pairs_of(const std::vector<Frame>& frames, std::size_t channel) {
  std::vector<FlatPair> pairs;
  for (std::size_t i = 0; i + 1 < frames.size(); i += 2)
    pairs.push_back({frames[i].scale.exposure_of(frames[i].channels[channel].channel).value(),
                     frames[i].channels[channel].dn, frames[i + 1].channels[channel].dn});
  return pairs;
}

}  // namespace

std::vector<ChannelTransfer> measure_transfer(std::span<const std::filesystem::path> dark,
                                              std::span<const std::filesystem::path> bright, Inputs& inputs,
                                              std::vector<std::string>* warnings) {
  const std::vector<Frame> dark_frames = read_frames(dark, true, inputs, warnings);
  const std::vector<Frame> bright_frames = read_frames(bright, false, inputs, warnings);
  if (dark_frames.empty() || bright_frames.empty())
    throw Error(ErrorCode::usage, "photon transfer",
                "needs dark and evenly illuminated frames, two of each exposure");
  const Frame& first = bright_frames.front();
  require_alike(first, dark_frames.front(), bright.front());
  const std::vector<CodeLevel> levels = code_levels(first.scale.curved.value_or(Readout{}));
  const auto white = static_cast<std::uint16_t>(std::clamp(std::round(first.white_dn), 0.0, 65535.0));
  std::vector<ChannelTransfer> all;
  for (std::size_t c = 0; c < first.channels.size(); ++c) {
    PhotonTransfer transfer = photon_transfer(pairs_of(dark_frames, c), pairs_of(bright_frames, c),
                                              first.scale.bits, levels, white);
    // If the light fills the range of codes, the full well remains unknown.
    const double range_e = (first.scale.highest() - first.scale.offset_dn) * transfer.gain_e_per_dn;
    if (transfer.full_well_e && *transfer.full_well_e > kCodeRangeFraction * range_e)
      transfer.full_well_e.reset();
    const auto range_db = transfer.saturation_e
                              ? std::optional(20 * std::log10(*transfer.saturation_e / transfer.read_noise_e))
                              : std::nullopt;
    // e^2 = 100 (e + s^2)
    const double snr10 = 50 + std::sqrt(2500 + 100 * transfer.read_noise_e * transfer.read_noise_e);
    const auto sensitivity = first.scale.electrons_per_lx_s;
    all.push_back({first.channels[c].channel, transfer, range_db, snr10,
                   sensitivity ? std::optional(snr10 / *sensitivity) : std::nullopt});
  }
  return all;
}

}  // namespace abbe
