#include "calibration/chart/white_level.h"

#include <algorithm>
#include <cmath>

#include "io/text.h"

namespace abbe {
namespace {

constexpr double kHighestCode = 65535;

std::optional<double> recorded_white_dn(const Image& image) {
  const auto found = image.metadata.find("white_level_dn");
  return found == image.metadata.end() ? std::nullopt : parse_number(found->second);
}

// Highest code of all planes; empty if a value is not a code.
std::optional<double> highest_code(const Image& image) {
  constexpr double kRounding = 0.01;  // of floats; codes of 8 and of 16 bits are fractions of 65535
  double highest = 0;
  for (const ImageChannel& channel : image.channels)
    for (const float value : channel.values) {
      const double code = code_of(value);
      if (!(std::abs(static_cast<double>(value) * kHighestCode - code) < kRounding)) return std::nullopt;
      highest = std::max(highest, code);
    }
  return highest;
}

// True if the image holds the sensor's codes. Converters copy the attributes of a raw file but write planes
// and codes of their own.
bool holds_codes_up_to(const RawImage& read, double highest) {
  if (!read.scale) return false;
  if (!raw_scale(read.image)) return true;  // known from tags
  return recorded_white_dn(read.image) && highest <= read.scale->highest() &&
         !(read.scale->mosaic && read.image.channels.size() != 1);
}

}  // namespace

bool holds_sensor_codes(const RawImage& read) {
  const std::optional<double> highest = highest_code(read.image);
  return highest && holds_codes_up_to(read, *highest);
}

double white_dn(const Image& image, const RawScale& scale) {
  return scale.linear(recorded_white_dn(image).value_or(scale.highest()));
}

std::optional<ClippingLevel> clipping_level(const RawImage& read) {
  const std::optional<double> highest = highest_code(read.image);
  if (!highest) return std::nullopt;
  if (holds_codes_up_to(read, *highest)) return ClippingLevel{white_dn(read.image, *read.scale), true};
  if (*highest != kHighestCode) return std::nullopt;
  return ClippingLevel{kHighestCode, false};
}

}  // namespace abbe
