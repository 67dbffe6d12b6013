#pragma once

#include <optional>

#include "calibration/chart/raw_scale.h"

namespace abbe {

/// True if an image holds the codes that its `scale` describes. Films and pictures developed or converted
/// from a raw file also record its sensor, but have values of their own.
[[nodiscard]] bool holds_sensor_codes(const RawImage& read);

/// Code from which pixels of a raw file count as saturated, on the straight line that `read_raw_image` makes
/// of its codes. It is `white_level_dn` of Abbe's files, or the highest code, which files of other programs
/// record as their white level.
[[nodiscard]] double white_dn(const Image& image, const RawScale& scale);

/// Code at which a picture clips.
struct ClippingLevel {
  double dn;
  /// True if the file records it as white level; false if it is the highest code of the format.
  bool is_declared;
};

/// Clipping level of a picture that is not a film: the white level that it records, or 65535 if a pixel has
/// that code. Empty if some values are not codes of 16 bits, or if no pixel is at 65535. A picture that a
/// converter made of a raw file does not inherit that file's white level.
[[nodiscard]] std::optional<ClippingLevel> clipping_level(const RawImage& read);

}  // namespace abbe
