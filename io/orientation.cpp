#include "io/orientation.h"

#include <optional>
#include <string>
#include <utility>

namespace abbe {
namespace {

/// Where the pixels of an image belong.
struct Turn {
  bool rows_are_columns;
  bool from_right;
  bool from_bottom;
};

// The second four orientations have rows for columns, and go round as the first four do. Nothing of a text
// that is none of them.
std::optional<Turn> turn_of(const std::string& told) {
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const int round = (orientation - 1) % 4;
    if (told == std::to_string(orientation))
      return Turn{orientation > 4, round == 1 || round == 2, round > 1};
  }
  return std::nullopt;
}

// The plane of an image as it is to be seen, with so many columns and rows then.
std::vector<float> turned(const std::vector<float>& plane, const Turn& turn, std::size_t columns,
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

Image upright(Image image) {
  const auto told = image.metadata.find(kOrientation);
  if (told == image.metadata.end()) return image;
  const std::optional<Turn> turn = turn_of(told->second);
  image.metadata.erase(told);
  if (!turn) return image;
  if (turn->rows_are_columns) std::swap(image.width, image.height);
  for (ImageChannel& channel : image.channels)
    channel.values = turned(channel.values, *turn, static_cast<std::size_t>(image.width),
                            static_cast<std::size_t>(image.height));
  return image;
}

}  // namespace abbe
