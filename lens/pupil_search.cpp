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
constexpr int kMaxGrids = 40;
constexpr int kRimDirections = 64;
constexpr int kBisections = 12;

// Rays from an image point, addressed by their point in the tangent plane of the last vertex.
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
  // Distance from the center of the stop, in radii of the stop; infinite for rays that do not arrive.
  [[nodiscard]] double off_axis(const V2d& point) const {
    const auto there = system.at_stop(through(point), wavelength_nm);
    return there ? there->length() : std::numeric_limits<double>::infinity();
  }
};

// Paraxial image of the stop; nothing if the image plane is in the exit pupil.
std::optional<StopImage> finite_stop_image(const SpectralSystem& system, double wavelength_nm) {
  const StopImage image =
      stop_image(SystemAt(system.system(), wavelength_nm), system.image_z() - system.last_z());
  return std::isfinite(image.magnification) ? std::optional(image) : std::nullopt;
}

// Square around the paraxial exit pupil.
Box paraxial_box(const PupilRays& rays) {
  const SpectralSystem& system = rays.system;
  const std::optional<StopImage> image = finite_stop_image(system, rays.wavelength_nm);
  const V2d center = rays.image * (image ? image->shift : 1);
  const double half = image ? 1.5 * std::abs(system.stop_radius_mm() * image->magnification)
                            : (system.image_z() - system.last_z()) / 2;
  return {center - V2d(half), center + V2d(half)};
}

struct Grid {
  Box box;
  [[nodiscard]] V2d cell() const { return box.size() / kGridSide; }
  [[nodiscard]] V2d cell_center(int i, int j) const {
    return box.min + V2d((i + 0.5) * cell().x, (j + 0.5) * cell().y);
  }
  [[nodiscard]] std::vector<V2d> centers() const {
    std::vector<V2d> all;
    for (int j = 0; j < kGridSide; ++j)
      for (int i = 0; i < kGridSide; ++i) all.push_back(cell_center(i, j));
    return all;
  }
};

// Bounding box of the centers of the cells whose rays pass; empty if none does.
Box passing_cells(const PupilRays& rays, const Grid& grid) {
  Box passing;
  const std::vector<V2d> centers = grid.centers();
  const std::vector<std::optional<Ray>> leaving = rays.leaving(centers);
  for (std::size_t i = 0; i < centers.size(); ++i)
    if (leaving[i]) passing.extendBy(centers[i]);
  return passing;
}

// Box around the cell whose ray passes nearest to the center of the stop; a larger box if no ray arrives.
Box towards_stop(const PupilRays& rays, const Grid& grid) {
  double nearest = std::numeric_limits<double>::infinity();
  V2d there = grid.box.center();
  for (const V2d& center : grid.centers())
    if (const double off = rays.off_axis(center); off < nearest) {
      nearest = off;
      there = center;
    }
  const V2d half = std::isfinite(nearest) ? 3.0 * grid.cell() : grid.box.size();
  return {there - half, there + half};
}

bool is_cut_by_edge(const Grid& grid, const Box& passing) {
  const V2d c = grid.cell();
  return passing.min.x < grid.box.min.x + c.x || passing.min.y < grid.box.min.y + c.y ||
         passing.max.x > grid.box.max.x - c.x || passing.max.y > grid.box.max.y - c.y;
}

// True if the passing cells fill enough of the grid to resolve their rim.
bool is_fine(const Grid& grid, const Box& passing) {
  constexpr double kMinFraction = 0.3;
  return passing.size().x > kMinFraction * grid.box.size().x &&
         passing.size().y > kMinFraction * grid.box.size().y;
}

// Grid that encloses all passing rays; nothing if none passes.
std::optional<Grid> enclosing_grid(const PupilRays& rays) {
  Grid grid{paraxial_box(rays)};
  bool passes = false;
  for (int tried = 0; tried < kMaxGrids; ++tried) {
    const Box passing = passing_cells(rays, grid);
    if (passing.isEmpty()) {
      if (tried > kMaxGrids / 4) return std::nullopt;
      grid.box = towards_stop(rays, grid);
      continue;
    }
    passes = true;
    const bool is_cut = is_cut_by_edge(grid, passing);
    if (!is_cut && is_fine(grid, passing)) return grid;
    const V2d room = is_cut ? V2d(0.4 * passing.size() + 3.0 * grid.cell()) : V2d(1.5 * grid.cell());
    grid.box = {passing.min - room, passing.max + room};
  }
  if (!passes) return std::nullopt;
  throw Error(ErrorCode::scene, rays.system.system().title,
              fmt::format("the rays that the lens transmits to ({:g}, {:g}) mm of its image have no bound: "
                          "add clear apertures",
                          rays.image.x, rays.image.y));
}

// Rim around an inner point: the farthest points that pass in all directions, up to the distance `far`.
std::vector<V2d> rim_around(const PupilRays& rays, const V2d& inner, double far) {
  struct Search {
    V2d direction;
    double inside;
    double outside;
    [[nodiscard]] double midpoint() const { return (inside + outside) / 2; }
  };
  std::vector<Search> searches;
  for (int i = 0; i < kRimDirections; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRimDirections;
    searches.push_back({{std::cos(angle), std::sin(angle)}, 0, far});
  }
  std::vector<V2d> points(searches.size());
  for (int step = 0; step < kBisections; ++step) {
    std::transform(searches.begin(), searches.end(), points.begin(),
                   [&](const Search& search) { return inner + search.midpoint() * search.direction; });
    const std::vector<std::optional<Ray>> leaving = rays.leaving(points);
    for (std::size_t i = 0; i < searches.size(); ++i)
      (leaving[i] ? searches[i].inside : searches[i].outside) = searches[i].midpoint();
  }
  std::transform(searches.begin(), searches.end(), points.begin(),
                 [&](const Search& search) { return inner + search.outside * search.direction; });
  return points;
}

}  // namespace

double pupil_shift(const SpectralSystem& system, double wavelength_nm) {
  const std::optional<StopImage> stop = finite_stop_image(system, wavelength_nm);
  return stop ? stop->shift : 1;
}

VisiblePupil search_pupil(const SpectralSystem& system, const V2d& image, double wavelength_nm) {
  const PupilRays rays{system, image, wavelength_nm};
  const std::optional<Grid> grid = enclosing_grid(rays);
  VisiblePupil pupil;
  if (!grid) return pupil;
  const std::vector<V2d> centers = grid->centers();
  const std::vector<std::optional<Ray>> inner_rays = rays.leaving(centers);
  V2d inner(0, 0);
  for (std::size_t i = 0; i < centers.size(); ++i) {
    if (!inner_rays[i]) continue;
    pupil.points.push_back(centers[i]);
    pupil.leaving.push_back(*inner_rays[i]);
    inner += centers[i];
  }
  inner /= static_cast<double>(pupil.points.size());
  std::vector<V2d> rim = rim_around(rays, inner, grid->box.size().length());
  pupil.points.insert(pupil.points.end(), rim.begin(), rim.end());
  for (V2d& point : rim) point = inner + 0.999 * (point - inner);
  for (const auto& ray : rays.leaving(rim))
    if (ray) pupil.leaving.push_back(*ray);
  return pupil;
}

}  // namespace abbe::lens
