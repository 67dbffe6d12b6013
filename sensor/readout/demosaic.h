#pragma once

#include <span>
#include <string>

#include "io/image.h"
#include "sensor/response/mosaic.h"

namespace abbe {

/// Mosaic plane from the planes of all channels, named by `channels` in the order of the sensor: `kRawPlane`
/// contains each pixel's own channel, and `Variance.<kRawPlane>` its variance. Metadata are copied. Throws
/// Error{input} if a plane or its `Variance.` plane is missing.
[[nodiscard]] Image mosaicked(const Image& planes, const Mosaic& mosaic,
                              std::span<const std::string> channels);

/// Interpolates a plane for each of the `channels` from the mosaic in the plane named `raw`. In a pixel of
/// another channel, the value is a mean of the channel's pixels around it. Their weights are (1 - |dx|/w)(1 -
/// |dy|/h) within a pattern of w by h pixels; for the pattern R G / G B this is bilinear interpolation.
/// Constant planes stay constant up to the borders of the image, the crop and its gaps (`recorded_areas`);
/// outside these all planes are 0. Metadata are copied, other planes are not. Throws Error{input} if the
/// plane `raw` is missing.
[[nodiscard]] Image demosaic(const Image& image, const std::string& raw, const Mosaic& mosaic,
                             std::span<const std::string> channels);

}  // namespace abbe
