#pragma once

namespace abbe {

/// A rectangle of a film in pixels: x0 <= x < x1, y0 <= y < y1.
struct Crop {
  int x0, y0, x1, y1;

  bool operator==(const Crop&) const = default;
};

}  // namespace abbe
