#pragma once

#include <optional>

#include "calibration/chart/raw_scale.h"

namespace abbe {

/// True if the values of an image are the codes of the sensor that its `scale` describes. Films and developed
/// or converted pictures copy that description from a raw file, but have other values.
[[nodiscard]] bool holds_sensor_codes(const RawImage& read);

/// Smallest code [DN] at which a pixel of a raw file counts as saturated. It is the attribute
/// `white_level_dn`, which Abbe's files have, otherwise `RawScale::highest`. Like the codes that
/// `read_raw_image` returns, it is linearised if the file records a response curve.
[[nodiscard]] double white_dn(const Image& image, const RawScale& scale);

/// Code at which a picture clips.
struct ClippingLevel {
  double dn;  ///< In the scale of 16-bit codes; `white_dn` for a raw file.
  /// True if the file records it as white level; false if it is the highest code of the format.
  bool is_declared;
};

/// Clipping level of a picture that is not a film:
/// - empty if a value is not a 16-bit code;
/// - `white_dn` if the picture holds sensor codes (`holds_sensor_codes`);
/// - otherwise 65535 if a pixel has that code, and empty if none has. A white level that a converter copied
///   from a raw file is ignored.
[[nodiscard]] std::optional<ClippingLevel> clipping_level(const RawImage& read);

}  // namespace abbe
