#pragma once

#include <span>
#include <string>
#include <vector>

namespace abbe {

// What the viewer tev is told over TCP: packets of a length in bytes that counts itself, a kind, and what
// belongs to it; whole numbers of 32 bits and floats little-endian, texts ended by a zero byte.

/// Makes an image of zeros in these channels, in front of those that the viewer shows.
[[nodiscard]] std::string tev_create_image(const std::string& image, int width, int height,
                                           const std::vector<std::string>& channels);
/// Replaces whole rows of a channel, from `y` on, by these values.
[[nodiscard]] std::string tev_update_rows(const std::string& image, const std::string& channel, int width,
                                          int y, std::span<const float> values);

}  // namespace abbe
