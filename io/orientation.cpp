#include "io/orientation.h"

#include <optional>
#include <string>
#include <utility>

namespace abbe {
namespace {

/// The transform from stored to displayed pixels.
struct Turn {
  bool rows_are_columns;
  bool from_right;
  bool from_bottom;
};

// Orientations 5 to 8 exchange rows and columns and then reflect like 1 to 4. Nothing for any other text.
std::optional<Turn> turn_of(const std::string& text) {
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const int quarter = (orientation - 1) % 4;
    if (text == std::to_string(orientation))
      return Turn{orientation > 4, quarter == 1 || quarter == 2, quarter > 1};
  }
  return std::nullopt;
}

// The displayed plane, which has `columns` columns and `rows` rows.
std::vector<float> reoriented(const std::vector<float>& plane, const Turn& turn, std::size_t columns,
                              std::size_t rows) {
  std::vector<float> values(plane.size());
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const std::size_t stored_columns = turn.rows_are_columns ? rows : columns;
    std::size_t x = i % stored_columns;
    std::size_t y = i / stored_columns;
    if (turn.rows_are_columns) std::swap(x, y);
    if (turn.from_right) x = columns - 1 - x;
    if (turn.from_bottom) y = rows - 1 - y;
    values[y * columns + x] = plane[i];
  }
  return values;
}

}  // namespace

Image apply_orientation(Image image) {
  const auto attribute = image.metadata.find(kOrientation);
  if (attribute == image.metadata.end()) return image;
  const std::optional<Turn> turn = turn_of(attribute->second);
  image.metadata.erase(attribute);
  if (!turn) return image;
  if (turn->rows_are_columns) std::swap(image.width, image.height);
  for (ImageChannel& channel : image.channels)
    channel.values = reoriented(channel.values, *turn, static_cast<std::size_t>(image.width),
                                static_cast<std::size_t>(image.height));
  return image;
}

}  // namespace abbe
