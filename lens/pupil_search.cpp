#include "lens/pupil_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "io/error.h"
#include "lens/paraxial.h"

namespace abbe::lens {
namespace {

using Box = Imath::Box2d;
using V2d = Imath::V2d;
using V3d = Imath::V3d;

constexpr int kGridSide = 24;
constexpr int kMostGrids = 40;
constexpr int kRimDirections = 64;
constexpr int kBisections = 12;

// Rays from a point of the image by where they pass the tangent plane of the last vertex.
struct PupilRays {
  const SpectralSystem& system;
  V2d image;
  double wavelength_nm;

  [[nodiscard]] Ray through(const V2d& point) const {
    const V3d from(image.x, image.y, system.image_z());
    return {from, (V3d(point.x, point.y, system.last_z()) - from).normalized()};
  }
  [[nodiscard]] std::vector<std::optional<Ray>> leaving(std::span<const V2d> points) const {
    std::vector<ColouredRay> rays;
    rays.reserve(points.size());
    for (const V2d& point : points) rays.push_back({through(point), wavelength_nm});
    return system.to_object(rays);
  }
  // In radii of the stop.
  [[nodiscard]] double off_axis(const V2d& point) const {
    const auto there = system.at_stop(through(point), wavelength_nm);
    return there ? there->length() : std::numeric_limits<double>::infinity();
  }
};

// As the image sees it paraxially; nothing for an image in the exit pupil.
std::optional<SeenStop> seen_stop(const SpectralSystem& system, double wavelength_nm) {
  const SeenStop seen =
      stop_seen_from(SystemAt(system.system(), wavelength_nm), system.image_z() - system.last_z());
  return std::isfinite(seen.magnification) ? std::optional(seen) : std::nullopt;
}

// A square around where paraxial optics has the exit pupil.
Box first_guess(const PupilRays& rays) {
  const SpectralSystem& system = rays.system;
  const std::optional<SeenStop> seen = seen_stop(system, rays.wavelength_nm);
  const V2d center = rays.image * (seen ? seen->shift : 1);
  const double half = seen ? 1.5 * std::abs(system.stop_radius_mm() * seen->magnification)
                           : (system.image_z() - system.last_z()) / 2;
  return {center - V2d(half), center + V2d(half)};
}

struct Grid {
  Box box;
  [[nodiscard]] V2d cell() const { return box.size() / kGridSide; }
  [[nodiscard]] V2d middle(int i, int j) const {
    return box.min + V2d((i + 0.5) * cell().x, (j + 0.5) * cell().y);
  }
  [[nodiscard]] std::vector<V2d> middles() const {
    std::vector<V2d> all;
    for (int j = 0; j < kGridSide; ++j)
      for (int i = 0; i < kGridSide; ++i) all.push_back(middle(i, j));
    return all;
  }
};

// The box of the cells whose middles pass; empty where none does.
Box passing_cells(const PupilRays& rays, const Grid& grid) {
  Box passing;
  const std::vector<V2d> middles = grid.middles();
  const std::vector<std::optional<Ray>> leaving = rays.leaving(middles);
  for (std::size_t i = 0; i < middles.size(); ++i)
    if (leaving[i]) passing.extendBy(middles[i]);
  return passing;
}

// Around the cell whose ray comes next to the middle of the stop; a larger box where none comes there.
Box towards_stop(const PupilRays& rays, const Grid& grid) {
  double nearest = std::numeric_limits<double>::infinity();
  V2d there = grid.box.center();
  for (const V2d& middle : grid.middles())
    if (const double off = rays.off_axis(middle); off < nearest) {
      nearest = off;
      there = middle;
    }
  const V2d half = std::isfinite(nearest) ? 3.0 * grid.cell() : grid.box.size();
  return {there - half, there + half};
}

bool touches_edge(const Grid& grid, const Box& passing) {
  const V2d c = grid.cell();
  return passing.min.x < grid.box.min.x + c.x || passing.min.y < grid.box.min.y + c.y ||
         passing.max.x > grid.box.max.x - c.x || passing.max.y > grid.box.max.y - c.y;
}

// A box that fills a good part of the grid, so that cells tell its rim from afar.
bool is_fine(const Grid& grid, const Box& passing) {
  constexpr double kShare = 0.3;
  return passing.size().x > kShare * grid.box.size().x && passing.size().y > kShare * grid.box.size().y;
}

// The grid that holds all that passes; nothing where nothing does.
std::optional<Grid> holding_grid(const PupilRays& rays) {
  Grid grid{first_guess(rays)};
  bool passes = false;
  for (int tried = 0; tried < kMostGrids; ++tried) {
    const Box passing = passing_cells(rays, grid);
    if (passing.isEmpty()) {
      if (tried > kMostGrids / 4) return std::nullopt;
      grid.box = towards_stop(rays, grid);
      continue;
    }
    passes = true;
    const bool outside = touches_edge(grid, passing);
    if (!outside && is_fine(grid, passing)) return grid;
    const V2d room = outside ? V2d(0.4 * passing.size() + 3.0 * grid.cell()) : V2d(1.5 * grid.cell());
    grid.box = {passing.min - room, passing.max + room};
  }
  if (!passes) return std::nullopt;
  throw Error(ErrorCode::scene, rays.system.system().title,
              fmt::format("there is no end to what the lens lets through to ({:g}, {:g}) mm of its image: it "
                          "needs clear apertures",
                          rays.image.x, rays.image.y));
}

// The farthest points that pass from an inner one all around, no farther than `far`.
std::vector<V2d> rim_around(const PupilRays& rays, const V2d& inner, double far) {
  struct Search {
    V2d direction;
    double within;
    double beyond;
    [[nodiscard]] double middle() const { return (within + beyond) / 2; }
  };
  std::vector<Search> searches;
  for (int i = 0; i < kRimDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRimDirections;
    searches.push_back({{std::cos(angle), std::sin(angle)}, 0, far});
  }
  std::vector<V2d> points(searches.size());
  for (int step = 0; step < kBisections; ++step) {
    std::transform(searches.begin(), searches.end(), points.begin(),
                   [&](const Search& search) { return inner + search.middle() * search.direction; });
    const std::vector<std::optional<Ray>> leaving = rays.leaving(points);
    for (std::size_t i = 0; i < searches.size(); ++i)
      (leaving[i] ? searches[i].within : searches[i].beyond) = searches[i].middle();
  }
  std::transform(searches.begin(), searches.end(), points.begin(),
                 [&](const Search& search) { return inner + search.beyond * search.direction; });
  return points;
}

}  // namespace

double pupil_shift(const SpectralSystem& system, double wavelength_nm) {
  const std::optional<SeenStop> seen = seen_stop(system, wavelength_nm);
  return seen ? seen->shift : 1;
}

SeenPupil search_pupil(const SpectralSystem& system, const V2d& image, double wavelength_nm) {
  const PupilRays rays{system, image, wavelength_nm};
  const std::optional<Grid> grid = holding_grid(rays);
  SeenPupil seen;
  if (!grid) return seen;
  const std::vector<V2d> middles = grid->middles();
  const std::vector<std::optional<Ray>> inner_rays = rays.leaving(middles);
  V2d inner(0, 0);
  for (std::size_t i = 0; i < middles.size(); ++i) {
    if (!inner_rays[i]) continue;
    seen.points.push_back(middles[i]);
    seen.leaving.push_back(*inner_rays[i]);
    inner += middles[i];
  }
  inner /= static_cast<double>(seen.points.size());
  std::vector<V2d> rim = rim_around(rays, inner, grid->box.size().length());
  seen.points.insert(seen.points.end(), rim.begin(), rim.end());
  for (V2d& point : rim) point = inner + 0.999 * (point - inner);
  for (const auto& ray : rays.leaving(rim))
    if (ray) seen.leaving.push_back(*ray);
  return seen;
}

}  // namespace abbe::lens
