#include "calibration/chart/transfer_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>

#include <fmt/format.h>

#include "calibration/chart/raw_scale.h"
#include "calibration/chart/white_level.h"
#include "io/error.h"
#include "sensor/film/recorded_crop.h"

namespace abbe {
namespace {

constexpr double kOfTheCodes = 0.99;
constexpr double kSameGain = 1e-6;  // relative, of texts of few digits
constexpr double kSameLight = 0.1;  // relative, more than lamps flicker
constexpr double kStandardErrors = 5;
constexpr std::size_t kRowsThatTell = 8;  // how sure the mean of their means is
constexpr double kUnderflow = 0.005;      // of a channel's pixels

// A frame's codes, a list for each channel.
struct Frame {
  double exposure_s;
  RawScale scale;
  double white_dn;
  int width;
  int height;
  std::vector<Crop> areas;  // whose pixels were rendered
  std::vector<std::string> channels;
  std::vector<std::vector<std::uint16_t>> codes;
  std::vector<std::vector<ChannelCodes::RowCodes>> rows;
};

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw Error(ErrorCode::input, file.string(), what);
}

Frame read_frame(const std::filesystem::path& file, Inputs& inputs, std::vector<std::string>* warnings) {
  inputs.add_file(file);
  const auto [image, scale, about] = read_raw_image(file, &inputs);
  if (warnings != nullptr) warnings->insert(warnings->end(), about.begin(), about.end());
  if (!scale || !scale->exposure_s)
    refuse(file, "tells neither bits nor exposure time: a raw file of `abbe develop` is needed");
  Frame frame{*scale->exposure_s,
              *scale,
              white_dn(image, *scale),
              image.width,
              image.height,
              recorded_areas(image),
              {},
              {},
              {}};
  for (const ChannelCodes& channel : raw_codes(image, *scale)) {
    frame.channels.push_back(channel.channel);
    frame.codes.emplace_back(channel.dn.begin(), channel.dn.end());
    frame.rows.push_back(channel.rows);
    if (channel.dn.size() < 2)
      refuse(file, fmt::format("has too few pixels in {} to tell noise (got {}, allowed 2 or more)",
                               channel.channel, channel.dn.size()));
  }
  inputs.give_back_memory(image.memory_bytes());
  return frame;
}

// Whether a frame is of the first one's sensor and settings.
void require_alike(const Frame& frame, const Frame& first, const std::filesystem::path& file) {
  if (frame.channels != first.channels || frame.width != first.width || frame.height != first.height)
    refuse(file, "has other pixels or channels than the first frame");
  if (frame.areas != first.areas)
    refuse(file, fmt::format("was rendered at the pixels {}, the first frame at {}: patterns are those of "
                             "the same pixels",
                             to_text(frame.areas), to_text(first.areas)));
  if (frame.scale.bits != first.scale.bits)
    refuse(file, fmt::format("has {} bits, the first frame {}", frame.scale.bits, first.scale.bits));
  const auto& gain = frame.scale.gain_e_per_dn;
  const auto& expected = first.scale.gain_e_per_dn;
  if (gain && expected && std::abs(*gain - *expected) > kSameGain * *expected)
    refuse(file, fmt::format("was read out at {} e/DN, the first frame at {}: a gain is measured by itself",
                             *gain, *expected));
  if (frame.scale.linear_codes != first.scale.linear_codes)
    refuse(file, "has another response curve, offset_dn or saturation_dn than the first frame");
}

// What lies below the lowest code is cut off there: the mean is too high and the scatter too small. Codes
// that are all the lowest, as of an ideal read-out in the dark, have no scatter that could be cut.
void require_no_underflow(const Frame& frame, const std::filesystem::path& file) {
  const double lowest = frame.scale.linear(0);
  for (std::size_t c = 0; c < frame.codes.size(); ++c) {
    const std::vector<std::uint16_t>& codes = frame.codes[c];
    const auto cut = std::count_if(codes.begin(), codes.end(), [&](auto code) { return code <= lowest; });
    const double share = static_cast<double>(cut) / static_cast<double>(codes.size());
    if (share > kUnderflow && share < 1)
      refuse(file, fmt::format("{:.3g} % of its codes in {} are {}, the lowest, at which noise is cut off "
                               "(allowed {} %), so that neither gain, read noise nor dark current can be "
                               "told: give the read-out an offset_dn",
                               100 * share, frame.channels[c], lowest, 100 * kUnderflow));
  }
}

struct Moments {
  double mean;
  double mean_variance;  // of the mean
  std::size_t rows;
};

// The mean errs as that of independent pixels or, with noise that the pixels of a row have in common, as that
// of independent rows.
Moments moments(const Frame& frame, std::size_t channel) {
  const std::vector<std::uint16_t>& codes = frame.codes[channel];
  const auto n = static_cast<double>(codes.size());
  const double mean = std::accumulate(codes.begin(), codes.end(), 0.0) / n;
  std::map<int, double> of_rows;
  double squares = 0;
  auto code = codes.begin();
  for (const auto& [y, count] : frame.rows[channel]) {
    double& of_row = of_rows[y];
    for (std::size_t i = 0; i < count; ++i, ++code) {
      const double above = *code - mean;
      squares += above * above;
      of_row += above;
    }
  }
  double row_squares = 0;
  for (const auto& [y, above] : of_rows) row_squares += above * above;
  const auto rows = static_cast<double>(of_rows.size());
  if (rows > 1) row_squares *= rows / (rows - 1);
  return {mean, std::max(squares, row_squares) / n / n, of_rows.size()};
}

// Whether the second of two frames saw the light of the first, and is another frame. In the dark a few rows
// do not tell whether their means differ by more than noise.
void require_pair(const Frame& first, const Frame& second, bool are_dark, const std::filesystem::path& file) {
  if (second.exposure_s != first.exposure_s)
    refuse(file,
           fmt::format("is exposed for {} s and the frame before it for {}: two of each are needed, one "
                       "after the other",
                       second.exposure_s, first.exposure_s));
  bool is_copy = first.codes == second.codes;
  for (std::size_t c = 0; c < first.codes.size(); ++c) {
    const Moments a = moments(first, c);
    const Moments b = moments(second, c);
    // Frames of one code only, all dark or all full, may be alike.
    is_copy = is_copy && a.mean_variance > 0;
    if (are_dark && a.rows < kRowsThatTell) continue;
    const double apart = std::abs(a.mean - b.mean);
    const double signal = std::max(a.mean, b.mean) - first.scale.offset_dn;
    if (apart > kSameLight * signal && apart > kStandardErrors * std::sqrt(a.mean_variance + b.mean_variance))
      refuse(file,
             fmt::format("has a mean of {:.5g} DN in {} and the frame before it {:.5g}: the two of a pair "
                         "see the same light",
                         b.mean, first.channels[c], a.mean));
  }
  if (is_copy) refuse(file, "has the very codes of the frame before it: two exposures are needed");
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
    pairs.push_back({frames[i].scale.exposure_of(frames[i].channels[channel]).value(),
                     frames[i].codes[channel], frames[i + 1].codes[channel]});
  return pairs;
}

}  // namespace

std::vector<ChannelTransfer> measure_transfer(std::span<const std::filesystem::path> dark,
                                              std::span<const std::filesystem::path> lit, Inputs& inputs,
                                              std::vector<std::string>* warnings) {
  const std::vector<Frame> dark_frames = read_frames(dark, true, inputs, warnings);
  const std::vector<Frame> lit_frames = read_frames(lit, false, inputs, warnings);
  if (dark_frames.empty() || lit_frames.empty())
    throw Error(ErrorCode::usage, "photon transfer", "needs dark and lit frames, two of each exposure");
  const Frame& first = lit_frames.front();
  require_alike(first, dark_frames.front(), lit.front());
  const std::vector<CodeLevel> levels = code_levels(first.scale.curved.value_or(Readout{}));
  const auto white = static_cast<std::uint16_t>(std::clamp(std::round(first.white_dn), 0.0, 65535.0));
  std::vector<ChannelTransfer> all;
  for (std::size_t c = 0; c < first.channels.size(); ++c) {
    PhotonTransfer found =
        photon_transfer(pairs_of(dark_frames, c), pairs_of(lit_frames, c), first.scale.bits, levels, white);
    // What fills the codes tells nothing of the well.
    const double range_e = (first.scale.highest() - first.scale.offset_dn) * found.gain_e_per_dn;
    if (found.full_well_e && *found.full_well_e > kOfTheCodes * range_e) found.full_well_e.reset();
    const auto range_db = found.saturation_e
                              ? std::optional(20 * std::log10(*found.saturation_e / found.read_noise_e))
                              : std::nullopt;
    // e^2 = 100 (e + s^2)
    const double snr10 = 50 + std::sqrt(2500 + 100 * found.read_noise_e * found.read_noise_e);
    const auto sensitivity = first.scale.electrons_per_lx_s;
    all.push_back({first.channels[c], found, range_db, snr10,
                   sensitivity ? std::optional(snr10 / *sensitivity) : std::nullopt});
  }
  return all;
}

}  // namespace abbe
