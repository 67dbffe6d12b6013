#pragma once

#include <span>
#include <string>

#include "io/image.h"
#include "sensor/response/mosaic.h"

namespace abbe {

/// The plane a mosaic makes of planes of all its channels: each pixel's own channel, and of the `Variance.`
/// planes its variance, as `kRawPlane` and its variance. Metadata are kept. Throws Error{input} when a plane
/// is missing.
[[nodiscard]] Image mosaicked(const Image& planes, const Mosaic& mosaic,
                              std::span<const std::string> channels);

/// A plane for each channel of a mosaic from the one that holds each pixel's own: linear interpolation. A
/// channel's value at a pixel that has another filter is the mean of the channel's pixels around it, weighted
/// by (1 - |dx|/w)(1 - |dy|/h) within one pattern of w by h pixels; for the pattern R G / G B that is
/// bilinear interpolation. Constant planes stay constant up to the borders of the image, of a film's crop and
/// of its gaps (`recorded_areas`), beyond which all planes are 0. Metadata is kept, other planes are left
/// out. Throws Error{input} when there is no plane of the name `raw`.
[[nodiscard]] Image demosaic(const Image& image, const std::string& raw, const Mosaic& mosaic,
                             std::span<const std::string> channels);

}  // namespace abbe
