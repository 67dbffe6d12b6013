#include "sensor/response/mosaic.h"

#include <algorithm>

#include "io/text.h"

namespace abbe {

std::string to_text(const Mosaic& mosaic, std::span<const std::string> names) {
  std::string text;
  for (int y = 0; y < mosaic.height; ++y)
    for (int x = 0; x < mosaic.width; ++x) {
      if (x > 0 || y > 0) text += x > 0 ? ',' : '/';
      text += names[static_cast<std::size_t>(mosaic.at(x, y))];
    }
  return text;
}

std::optional<Mosaic> parse_mosaic(std::string_view text, std::span<const std::string> names) {
  Mosaic mosaic{0, 0, {}};
  for (const std::string& row : split(text, '/')) {
    const std::vector<std::string> cells = split(row, ',');
    if (mosaic.height++ == 0) mosaic.width = static_cast<int>(cells.size());
    if (cells.size() != static_cast<std::size_t>(mosaic.width)) return std::nullopt;
    for (const std::string& cell : cells) {
      const auto known = std::find(names.begin(), names.end(), cell);
      if (known == names.end()) return std::nullopt;
      mosaic.channel.push_back(static_cast<int>(known - names.begin()));
    }
  }
  return mosaic.channel.empty() ? std::nullopt : std::optional(std::move(mosaic));
}

}  // namespace abbe
