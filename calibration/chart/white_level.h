#pragma once

#include <optional>

#include "calibration/chart/raw_scale.h"

namespace abbe {

/// Whether an image holds the codes that its `scale` tells of. Films, and pictures that are developed or
/// converted of a raw file, tell of its sensor too, but have values of their own.
[[nodiscard]] bool holds_codes_told_of(const RawImage& read);

/// The code from which pixels of a raw file count as saturated, on the straight line that `read_raw_image`
/// makes of its codes: the `white_level_dn` that the files of Abbe tell, or the highest code, which those of
/// other programs tell as their white level.
[[nodiscard]] double white_dn(const Image& image, const RawScale& scale);

/// The code from which nothing more is told of the light.
struct EndOfCodes {
  double dn;
  bool is_told;  ///< As the white level of the sensor; else it is the highest code of the file's format.
};

/// Where the codes of a picture that is no film end: at the white level that it tells, or at 65535 of 65535
/// where a pixel has that. Nothing of one with values that are no codes of 16 bits, or in which no code is
/// that high. What a raw file told is of no account in a picture that a converter made of it.
[[nodiscard]] std::optional<EndOfCodes> end_of_codes(const RawImage& read);

}  // namespace abbe
