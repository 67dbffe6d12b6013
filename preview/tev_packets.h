#pragma once

#include <span>
#include <string>
#include <vector>

namespace abbe {

// TCP packets of the image viewer tev. A packet has its length in bytes (including the length), its kind, and
// the content. Integers have 32 bits; integers and floats are little-endian; strings end with a zero byte.

/// Packet that creates an image of zeros called `image`, `width` x `height` pixels with these channels, and
/// moves it to the front.
[[nodiscard]] std::string tev_create_image(const std::string& image, int width, int height,
                                           const std::vector<std::string>& channels);
/// Packet that replaces whole rows of a channel, beginning with row `y`, counted from 0 at the top. `width`
/// is that of the image. `values` are row by row, a multiple of `width`.
[[nodiscard]] std::string tev_update_rows(const std::string& image, const std::string& channel, int width,
                                          int y, std::span<const float> values);

}  // namespace abbe
