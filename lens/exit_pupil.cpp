#include "lens/exit_pupil.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include <ImathBox.h>
#include <fmt/format.h>

#include "io/error.h"
#include "lens/paraxial.h"
#include "lens/trace.h"

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
  [[nodiscard]] std::vector<V2d> centers() const {
    std::vector<V2d> all;
    for (int j = 0; j < kGridSide; ++j)
      for (int i = 0; i < kGridSide; ++i)
        all.push_back(box.min + V2d((i + 0.5) * cell().x, (j + 0.5) * cell().y));
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

// Light that passes backwards through a lens from an image point.
struct VisiblePupil {
  // Points inside the pupil, then points just outside its rim, in the tangent plane of the last vertex [mm].
  std::vector<Imath::V2d> points;
  // Rays through the inner points and through points just inside the rim. They start at the first surface
  // and travel towards -z.
  std::vector<Ray> leaving;
};

// Movement of the center of the exit pupil in the tangent plane of the last vertex, over that of the image
// point, near the axis; 1 for a distant pupil.
double pupil_shift(const SpectralSystem& system, double wavelength_nm) {
  const std::optional<StopImage> stop = finite_stop_image(system, wavelength_nm);
  return stop ? stop->shift : 1;
}

// Finds the exit pupil from a point (x, y) of the image [mm] at one wavelength, with clear apertures. A grid
// is moved and zoomed until it contains all passing rays; bisection from the center then finds the rim.
// Empty if no ray passes. Throws Error{scene} if the passing rays have no bound.
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

constexpr int kRadii = 64;
constexpr int kCells = 16;                   // per side, for systems with displaced surfaces
constexpr double kMargin = 1.02;             // for rims between the traced points and wavelengths
constexpr double kCosineMargin = 0.99;       // the corresponding factor for cosines
constexpr double kMinForwardCosine = 0.052;  // cosine of 87 degrees
constexpr int kPlanes = 65;                  // candidate planes of the entrance disc
constexpr int kEdgeBisections = 6;           // to locate the edge of the image between two of its points

// Exit pupil at all wavelengths from a point of the image. Empty if no light arrives there.
struct PupilView {
  V2d image;
  std::vector<V2d> points;

  [[nodiscard]] bool is_illuminated() const { return !points.empty(); }
};

class PupilCollector {
 public:
  PupilCollector(const SpectralSystem& system, std::span<const double> wavelengths_nm)
      : system_(system), wavelengths_nm_(wavelengths_nm) {
    const double length = system.last_z() + system.stop_radius_mm();
    for (int i = 0; i < kPlanes; ++i) planes_.push_back({length * i / (kPlanes - 1), 0});
  }

  PupilView view_from(const V2d& image) {
    std::vector<V2d> points;
    for (const double nm : wavelengths_nm_) {
      const VisiblePupil pupil = search_pupil(system_, image, nm);
      points.insert(points.end(), pupil.points.begin(), pupil.points.end());
      for (const Ray& ray : pupil.leaving) add(ray);
    }
    const double depth = system_.image_z() - system_.last_z();
    for (const V2d& point : points)
      min_cosine_ = std::min(min_cosine_, depth / std::hypot(depth, (point - image).length()));
    return {image, std::move(points)};
  }

  // View from a point next to the edge of the illuminated image between two points; empty if there is no edge
  // between them.
  std::vector<PupilView> rim_between(const PupilView& a, const PupilView& b) {
    if (a.is_illuminated() == b.is_illuminated()) return {};
    V2d illuminated = a.is_illuminated() ? a.image : b.image;
    V2d dark = a.is_illuminated() ? b.image : a.image;
    std::vector<PupilView> rim;
    for (int i = 0; i < kEdgeBisections; ++i) {
      PupilView halfway = view_from((illuminated + dark) / 2);
      (halfway.is_illuminated() ? illuminated : dark) = halfway.image;
      if (halfway.is_illuminated()) rim = {std::move(halfway)};
    }
    return rim;
  }

  [[nodiscard]] EntranceDisc entrance() const {
    EntranceDisc best = planes_.front();
    for (const EntranceDisc& plane : planes_)
      if (plane.radius < best.radius) best = plane;
    return {best.z, best.radius * kMargin};
  }
  [[nodiscard]] double front_radius() const { return planes_.front().radius * kMargin; }
  [[nodiscard]] double min_cosine() const { return min_cosine_ * kCosineMargin; }

 private:
  void add(const Ray& leaving) {
    if (-leaving.direction.z < kMinForwardCosine)
      throw Error(ErrorCode::scene, system_.system().title,
                  "the field extends more than 87 degrees from the axis of the lens (allowed less)");
    for (EntranceDisc& plane : planes_) {
      const Imath::V3d at =
          leaving.origin + (plane.z - leaving.origin.z) / leaving.direction.z * leaving.direction;
      plane.radius = std::max(plane.radius, std::hypot(at.x, at.y));
    }
  }

  const SpectralSystem& system_;
  std::span<const double> wavelengths_nm_;
  std::vector<EntranceDisc> planes_;
  double min_cosine_ = 1;
};

// Ellipse around points, with the axes of their bounding box.
PupilBound around(const std::vector<V2d>& points) {
  PupilBound bound;
  if (points.empty()) return bound;
  Imath::Box2d box;
  for (const V2d& point : points) box.extendBy(point);
  bound.center = box.center();
  bound.semi = box.size() / 2;
  double largest = 0;
  for (const V2d& point : points) largest = std::max(largest, ((point - bound.center) / bound.semi).length());
  bound.semi *= largest * kMargin;
  return bound;
}

// Ellipse around the pupils of image points near `center`, for light to `center`. A pupil moves by `shift`
// times the movement of the image point.
PupilBound around(std::span<const PupilView> views, const V2d& center, double shift) {
  std::vector<V2d> points;
  for (const PupilView& from : views)
    for (const V2d& point : from.points) points.push_back(point - shift * (from.image - center));
  return around(points);
}

void append(std::vector<PupilView>& all, const std::vector<PupilView>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

/// Image point at a grid position in cells.
using GridPoint = std::function<V2d(double column, double row)>;

// Bounds at the centers of the cells of a radius of the image.
std::vector<PupilBound> bounds_along_radius(int columns, double shift, const GridPoint& at,
                                            PupilCollector& collector) {
  std::vector<PupilBound> bounds;
  PupilView before = collector.view_from(at(0, 0));
  for (int i = 1; i <= columns; ++i) {
    PupilView here = collector.view_from(at(i, 0));
    std::vector<PupilView> views = collector.rim_between(before, here);
    append(views, {std::move(before), here});
    bounds.push_back(around(views, at(i - 0.5, 0), shift));
    before = std::move(here);
  }
  return bounds;
}

// Bounds at the centers of the cells of the image, row by row.
std::vector<PupilBound> bounds_all_over(int columns, int rows, double shift, const GridPoint& at,
                                        PupilCollector& collector) {
  const auto index = [columns](int i, int j) { return static_cast<std::size_t>(j * (columns + 1) + i); };
  std::vector<PupilView> corners;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) corners.push_back(collector.view_from(at(i, j)));
  // Edges of the illuminated image on the sides of the cells that leave a corner along x and y.
  std::vector<std::vector<PupilView>> ends_in_x(corners.size());
  std::vector<std::vector<PupilView>> ends_in_y(corners.size());
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const std::size_t here = index(i, j);
      if (i < columns) ends_in_x[here] = collector.rim_between(corners[here], corners[index(i + 1, j)]);
      if (j < rows) ends_in_y[here] = collector.rim_between(corners[here], corners[index(i, j + 1)]);
    }
  std::vector<PupilBound> bounds;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      std::vector<PupilView> views{corners[index(i, j)], corners[index(i + 1, j)], corners[index(i, j + 1)],
                                   corners[index(i + 1, j + 1)]};
      append(views, ends_in_x[index(i, j)]);
      append(views, ends_in_x[index(i, j + 1)]);
      append(views, ends_in_y[index(i, j)]);
      append(views, ends_in_y[index(i + 1, j)]);
      bounds.push_back(around(views, at(i + 0.5, j + 0.5), shift));
    }
  return bounds;
}

constexpr int kSteps = 8;  // from the center of the image to its corner

// Points on one radius if the system has rotational symmetry, otherwise on a grid.
std::vector<Imath::V2d> image_points(const System& system, const Imath::V2d& half_image_mm) {
  std::vector<Imath::V2d> points;
  for (int i = 0; i <= kSteps; ++i) {
    const double fraction = static_cast<double>(i) / kSteps;
    if (!system.displaced()) {
      points.emplace_back(half_image_mm.length() * fraction, 0);
      continue;
    }
    for (int j = 0; j <= kSteps; ++j)
      points.push_back(half_image_mm * Imath::V2d(2 * fraction - 1, 2.0 * j / kSteps - 1));
  }
  return points;
}

}  // namespace

V2d PupilBound::point(const V2d& disc) const {
  const V2d across(-along.y, along.x);
  return center.x * along + center.y * across + disc.x * semi.x * along + disc.y * semi.y * across;
}

bool PupilBound::contains(const V2d& point) const {
  const V2d off(point.dot(along) - center.x, point.y * along.x - point.x * along.y - center.y);
  const V2d scaled(off.x * semi.y, off.y * semi.x);
  return semi.x > 0 && scaled.length2() <= semi.x * semi.x * semi.y * semi.y;
}

ExitPupil::ExitPupil(const SpectralSystem& system, const V2d& half_image_mm, double low_nm, double high_nm)
    : half_image_(half_image_mm),
      centred_(!system.system().displaced()),
      columns_(centred_ ? kRadii : kCells),
      rows_(centred_ ? 1 : kCells),
      cell_mm_(centred_ ? V2d(half_image_mm.length() / columns_, 0)
                        : 2.0 * half_image_mm / V2d(columns_, rows_)),
      shift_(pupil_shift(system, (low_nm + high_nm) / 2)) {
  const std::array<double, 3> wavelengths_nm{low_nm, (low_nm + high_nm) / 2, high_nm};
  // A round stop, so that the bounds along a radius are valid in all directions.
  const SpectralSystem round(with_round_stop(system.system()), system.stop_radius_mm());
  PupilCollector collector(round, wavelengths_nm);
  const auto point = [this](double column, double row) { return at(column, row); };
  bounds_ = centred_ ? bounds_along_radius(columns_, shift_, point, collector)
                     : bounds_all_over(columns_, rows_, shift_, point, collector);
  entrance_ = collector.entrance();
  front_radius_ = collector.front_radius();
  min_cosine_ = collector.min_cosine();
  if (std::ranges::none_of(bounds_, [](const PupilBound& b) { return b.area() > 0; }))
    throw Error(ErrorCode::scene, system.system().title, "the lens transmits no light to the film");
}

V2d ExitPupil::at(double column, double row) const {
  return centred_ ? V2d(column * cell_mm_.x, 0) : V2d(column, row) * cell_mm_ - half_image_;
}

PupilBound ExitPupil::bound(const V2d& image) const {
  const auto cell = [](double at, int count) { return std::clamp(static_cast<int>(at), 0, count - 1); };
  if (!centred_) {
    const V2d cells = (image + half_image_) / cell_mm_;
    const int i = cell(cells.x, columns_);
    const int j = cell(cells.y, rows_);
    PupilBound bound = bounds_[static_cast<std::size_t>(j * columns_ + i)];
    bound.center += shift_ * (image - at(i + 0.5, j + 0.5));
    return bound;
  }
  const double radius = std::sqrt(image.length2());
  const int i = cell(radius / cell_mm_.x, columns_);
  PupilBound bound = bounds_[static_cast<std::size_t>(i)];
  bound.center.x += shift_ * (radius - at(i + 0.5, 0).x);
  if (radius > 0) bound.along = image * (1 / radius);
  return bound;
}

System with_clear_apertures(const SpectralSystem& system, const Imath::V2d& half_image_mm, double low_nm,
                            double high_nm) {
  System result = system.system();
  // A round stop, so that one radius represents all directions.
  const SpectralSystem round(with_round_stop(result), system.stop_radius_mm());
  std::vector<double> radius_mm(result.surfaces.size(), 0);
  for (const double nm : std::array{low_nm, (low_nm + high_nm) / 2, high_nm}) {
    const SystemAt at(round.system(), nm);
    for (const Imath::V2d& image : image_points(result, half_image_mm))
      for (const Ray& leaving : search_pupil(round, image, nm).leaving) {
        const RayPath path = trace(at, {leaving.origin, -leaving.direction}, Apertures::obeyed);
        for (std::size_t i = 0; i < path.hits.size(); ++i)
          radius_mm[i] = std::max(radius_mm[i], system.local_of(i, path.hits[i].point).length());
      }
  }
  for (std::size_t i = 0; i < radius_mm.size(); ++i)
    if (!result.surfaces[i].semi_aperture_mm) result.surfaces[i].semi_aperture_mm = radius_mm[i];
  return result;
}

}  // namespace abbe::lens
