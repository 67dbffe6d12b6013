#include "transport/render/relative_splats.h"

#include <algorithm>
#include <numeric>

#include "sensor/film/relative_error.h"
#include "spectral/rgb.h"

namespace abbe {
namespace {

constexpr int kBlocks = 32;  // along an edge of the film

}  // namespace

RelativeErrorCells::RelativeErrorCells(const Scene& scene)
    : camera_(scene.camera),
      planes_(scene.film_planes().size()),
      across_(std::min(kBlocks, scene.camera.width)),
      down_(std::min(kBlocks, scene.camera.height)) {
  if (!scene.mosaic && standard_observer(scene.channels)) from_xyz_ = rgb_to_xyz(kRec709).inverse();
}

std::size_t RelativeErrorCells::count() const {
  return static_cast<std::size_t>(across_) * static_cast<std::size_t>(down_) * planes_;
}

void RelativeErrorCells::add(std::size_t source, const FilmPoint& at, std::span<const double> values,
                             std::vector<Splat>& splats) const {
  const int block = at.y * down_ / camera_.height * across_ + at.x * across_ / camera_.width;
  const std::size_t first = static_cast<std::size_t>(block) * planes_;
  const LinearRgb rgb = from_xyz_ ? multiply(*from_xyz_, {values[0], values[1], values[2]}) : LinearRgb();
  for (std::size_t k = 0; k < values.size(); ++k)  // with many bands, most are zero
    if (const double value = from_xyz_ ? rgb[k] : values[k]; value != 0)
      splats.push_back({source, first + k, value});
}

std::vector<double> relative_squares(std::span<const Splat> splats, const RelativeErrorCells& cells,
                                     std::size_t count) {
  std::vector<double> means(cells.count());
  for (const Splat& splat : splats) means[splat.cell] += splat.value;
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / static_cast<double>(means.size());
  std::vector<double> squares(count);
  for (const auto& [source, cell, value] : splats)
    squares[source] += value * value / (means[cell] * means[cell] + kUsualFloor * mean * mean);
  return squares;
}

}  // namespace abbe
