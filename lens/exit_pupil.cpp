#include "lens/exit_pupil.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "io/error.h"
#include "lens/pupil_search.h"

namespace abbe::lens {
namespace {

using V2d = Imath::V2d;

constexpr int kRadii = 64;
constexpr int kCells = 16;               // along a side, of systems with displaced surfaces
constexpr double kWider = 1.02;          // than the rim found at some points and wavelengths
constexpr double kInwards = 0.99;        // of cosines, likewise
constexpr double kLeastForward = 0.052;  // cosine of 87 degrees
constexpr int kPlanes = 65;              // that the disc in front may lie in

// The points of some pupils, and where their rays come in.
class Findings {
 public:
  explicit Findings(const SpectralSystem& system) : system_(system) {
    const double length = system.last_z() + system.stop_radius_mm();
    for (int i = 0; i < kPlanes; ++i) planes_.push_back({length * i / (kPlanes - 1), 0});
  }

  // All points at the wavelengths.
  std::vector<V2d> points_at(const V2d& image, std::span<const double> wavelengths_nm) {
    std::vector<V2d> points;
    for (const double nm : wavelengths_nm) {
      const SeenPupil seen = search_pupil(system_, image, nm);
      points.insert(points.end(), seen.points.begin(), seen.points.end());
      for (const Ray& ray : seen.leaving) add(ray);
    }
    const double depth = system_.image_z() - system_.last_z();
    for (const V2d& point : points)
      least_cosine_ = std::min(least_cosine_, depth / std::hypot(depth, (point - image).length()));
    return points;
  }

  // The smallest of the discs.
  [[nodiscard]] EntranceDisc entrance() const {
    EntranceDisc best = planes_.front();
    for (const EntranceDisc& plane : planes_)
      if (plane.radius < best.radius) best = plane;
    return {best.z, best.radius * kWider};
  }
  [[nodiscard]] double least_cosine() const { return least_cosine_ * kInwards; }

 private:
  void add(const Ray& leaving) {
    if (-leaving.direction.z < kLeastForward)
      throw Error(ErrorCode::scene, system_.system().title,
                  "the film sees more than 87 degrees off the axis of the lens (allowed less)");
    for (EntranceDisc& plane : planes_) {
      const Imath::V3d at =
          leaving.origin + (plane.z - leaving.origin.z) / leaving.direction.z * leaving.direction;
      plane.radius = std::max(plane.radius, std::hypot(at.x, at.y));
    }
  }

  const SpectralSystem& system_;
  std::vector<EntranceDisc> planes_;
  double least_cosine_ = 1;
};

// An ellipse around points, its axes those of their box.
PupilBound around(const std::vector<V2d>& points) {
  PupilBound bound;
  if (points.empty()) return bound;
  Imath::Box2d box;
  for (const V2d& point : points) box.extendBy(point);
  bound.center = box.center();
  bound.semi = box.size() / 2;
  double largest = 0;
  for (const V2d& point : points) largest = std::max(largest, ((point - bound.center) / bound.semi).length());
  bound.semi *= largest * kWider;
  return bound;
}

std::vector<V2d> joined(std::span<const std::vector<V2d>* const> parts) {
  std::vector<V2d> all;
  for (const std::vector<V2d>* part : parts) all.insert(all.end(), part->begin(), part->end());
  return all;
}

// Of which the bounds along a radius are those all around.
SpectralSystem without_blades(const SpectralSystem& system) {
  System round = system.system();
  round.surfaces[round.stop].iris.reset();
  return {std::move(round), system.stop_radius_mm()};
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
      columns_per_mm_(columns_ / half_image_mm.length()) {
  const std::array<double, 3> wavelengths_nm{low_nm, (low_nm + high_nm) / 2, high_nm};
  const SpectralSystem round = without_blades(system);
  centred_ ? bound_along_radius(round, wavelengths_nm) : bound_all_over(round, wavelengths_nm);
  if (std::all_of(bounds_.begin(), bounds_.end(), [](const PupilBound& b) { return !(b.area() > 0); }))
    throw Error(ErrorCode::scene, system.system().title, "no light comes through the lens to the film");
}

void ExitPupil::bound_along_radius(const SpectralSystem& system, std::span<const double> wavelengths_nm) {
  Findings findings(system);
  std::vector<V2d> before = findings.points_at({0, 0}, wavelengths_nm);
  for (int i = 1; i <= columns_; ++i) {
    std::vector<V2d> here = findings.points_at({half_image_.length() * i / columns_, 0}, wavelengths_nm);
    bounds_.push_back(around(joined(std::array<const std::vector<V2d>*, 2>{&before, &here})));
    before = std::move(here);
  }
  entrance_ = findings.entrance();
  least_cosine_ = findings.least_cosine();
}

void ExitPupil::bound_all_over(const SpectralSystem& system, std::span<const double> wavelengths_nm) {
  Findings findings(system);
  std::vector<std::vector<V2d>> corners;
  for (int j = 0; j <= rows_; ++j)
    for (int i = 0; i <= columns_; ++i)
      corners.push_back(
          findings.points_at(half_image_ * V2d(2.0 * i / columns_ - 1, 2.0 * j / rows_ - 1), wavelengths_nm));
  const auto corner = [&](int i, int j) {
    return &corners[static_cast<std::size_t>(j * (columns_ + 1) + i)];
  };
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i)
      bounds_.push_back(around(joined(std::array<const std::vector<V2d>*, 4>{
          corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)})));
  entrance_ = findings.entrance();
  least_cosine_ = findings.least_cosine();
}

PupilBound ExitPupil::bound(const V2d& image) const {
  const auto cell = [](double at, int count) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(at), 0, count - 1));
  };
  if (!centred_) {
    const V2d share = (image / half_image_ + V2d(1)) / 2;
    return bounds_[cell(share.y * rows_, rows_) * static_cast<std::size_t>(columns_) +
                   cell(share.x * columns_, columns_)];
  }
  const double radius = std::sqrt(image.length2());
  PupilBound bound = bounds_[cell(radius * columns_per_mm_, columns_)];
  if (radius > 0) bound.along = image * (1 / radius);
  return bound;
}

}  // namespace abbe::lens
