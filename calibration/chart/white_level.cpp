#include "calibration/chart/white_level.h"

#include <algorithm>
#include <cmath>

#include "io/text.h"

namespace abbe {
namespace {

constexpr double kHighestCode = 65535;

std::optional<double> told_white_dn(const Image& image) {
  const auto found = image.metadata.find("white_level_dn");
  return found == image.metadata.end() ? std::nullopt : parse_number(found->second);
}

// The highest code of all planes; nothing where a value is none.
std::optional<double> highest_code(const Image& image) {
  constexpr double kRounding = 0.01;  // of floats, 8 bits as well as 16 being shares of 65535
  double highest = 0;
  for (const ImageChannel& channel : image.channels)
    for (const float value : channel.values) {
      const double code = code_of(value);
      if (!(std::abs(static_cast<double>(value) * kHighestCode - code) < kRounding)) return std::nullopt;
      highest = std::max(highest, code);
    }
  return highest;
}

// Converters keep what a raw file tells beside planes and codes of their own.
bool holds_codes_up_to(const RawImage& read, double highest) {
  if (!read.scale) return false;
  if (!raw_scale(read.image)) return true;  // by tags
  return told_white_dn(read.image) && highest <= read.scale->highest() &&
         !(read.scale->mosaic && read.image.channels.size() != 1);
}

}  // namespace

bool holds_codes_told_of(const RawImage& read) {
  const std::optional<double> highest = highest_code(read.image);
  return highest && holds_codes_up_to(read, *highest);
}

double white_dn(const Image& image, const RawScale& scale) {
  return scale.linear(told_white_dn(image).value_or(scale.highest()));
}

std::optional<EndOfCodes> end_of_codes(const RawImage& read) {
  const std::optional<double> highest = highest_code(read.image);
  if (!highest) return std::nullopt;
  if (holds_codes_up_to(read, *highest)) return EndOfCodes{white_dn(read.image, *read.scale), true};
  if (*highest != kHighestCode) return std::nullopt;
  return EndOfCodes{kHighestCode, false};
}

}  // namespace abbe
