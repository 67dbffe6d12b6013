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

// Collects the pupils of several image points, and bounds the rays that enter the lens.
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

  // The smallest of the discs.
  [[nodiscard]] EntranceDisc entrance() const {
    EntranceDisc best = planes_.front();
    for (const EntranceDisc& plane : planes_)
      if (plane.radius < best.radius) best = plane;
    return {best.z, best.radius * kMargin};
  }
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

// Ellipse around the pupils of image points near `center`, as seen from there. A pupil moves by `shift` times
// the movement of the image point.
PupilBound around(std::span<const PupilView> views, const V2d& center, double shift) {
  std::vector<V2d> points;
  for (const PupilView& from : views)
    for (const V2d& point : from.points) points.push_back(point - shift * (from.image - center));
  return around(points);
}

void append(std::vector<PupilView>& all, const std::vector<PupilView>& more) {
  all.insert(all.end(), more.begin(), more.end());
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
  centred_ ? bound_along_radius(round, wavelengths_nm) : bound_all_over(round, wavelengths_nm);
  if (std::all_of(bounds_.begin(), bounds_.end(), [](const PupilBound& b) { return !(b.area() > 0); }))
    throw Error(ErrorCode::scene, system.system().title, "the lens transmits no light to the film");
}

V2d ExitPupil::at(double column, double row) const {
  return centred_ ? V2d(column * cell_mm_.x, 0) : V2d(column, row) * cell_mm_ - half_image_;
}

void ExitPupil::bound_along_radius(const SpectralSystem& system, std::span<const double> wavelengths_nm) {
  PupilCollector collector(system, wavelengths_nm);
  PupilView before = collector.view_from(at(0, 0));
  for (int i = 1; i <= columns_; ++i) {
    PupilView here = collector.view_from(at(i, 0));
    std::vector<PupilView> views = collector.rim_between(before, here);
    append(views, {std::move(before), here});
    bounds_.push_back(around(views, at(i - 0.5, 0), shift_));
    before = std::move(here);
  }
  entrance_ = collector.entrance();
  min_cosine_ = collector.min_cosine();
}

void ExitPupil::bound_all_over(const SpectralSystem& system, std::span<const double> wavelengths_nm) {
  PupilCollector collector(system, wavelengths_nm);
  const auto index = [this](int i, int j) { return static_cast<std::size_t>(j * (columns_ + 1) + i); };
  std::vector<PupilView> corners;
  for (int j = 0; j <= rows_; ++j)
    for (int i = 0; i <= columns_; ++i) corners.push_back(collector.view_from(at(i, j)));
  // Edges of the illuminated image on the sides of the cells that leave a corner along x and y.
  std::vector<std::vector<PupilView>> ends_in_x(corners.size());
  std::vector<std::vector<PupilView>> ends_in_y(corners.size());
  for (int j = 0; j <= rows_; ++j)
    for (int i = 0; i <= columns_; ++i) {
      const std::size_t here = index(i, j);
      if (i < columns_) ends_in_x[here] = collector.rim_between(corners[here], corners[index(i + 1, j)]);
      if (j < rows_) ends_in_y[here] = collector.rim_between(corners[here], corners[index(i, j + 1)]);
    }
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      std::vector<PupilView> views{corners[index(i, j)], corners[index(i + 1, j)], corners[index(i, j + 1)],
                                   corners[index(i + 1, j + 1)]};
      append(views, ends_in_x[index(i, j)]);
      append(views, ends_in_x[index(i, j + 1)]);
      append(views, ends_in_y[index(i, j)]);
      append(views, ends_in_y[index(i + 1, j)]);
      bounds_.push_back(around(views, at(i + 0.5, j + 0.5), shift_));
    }
  entrance_ = collector.entrance();
  min_cosine_ = collector.min_cosine();
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

}  // namespace abbe::lens
