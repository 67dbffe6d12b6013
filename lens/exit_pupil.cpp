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
constexpr int kEdgeBisections = 6;       // towards where light ends between two points of the image

// The pupil as a point of the image sees it, at all wavelengths; no points where no light comes.
struct SeenFrom {
  V2d image;
  std::vector<V2d> points;

  [[nodiscard]] bool is_lit() const { return !points.empty(); }
};

// The points of some pupils, and where their rays come in.
class Findings {
 public:
  Findings(const SpectralSystem& system, std::span<const double> wavelengths_nm)
      : system_(system), wavelengths_nm_(wavelengths_nm) {
    const double length = system.last_z() + system.stop_radius_mm();
    for (int i = 0; i < kPlanes; ++i) planes_.push_back({length * i / (kPlanes - 1), 0});
  }

  SeenFrom seen_from(const V2d& image) {
    std::vector<V2d> points;
    for (const double nm : wavelengths_nm_) {
      const SeenPupil seen = search_pupil(system_, image, nm);
      points.insert(points.end(), seen.points.begin(), seen.points.end());
      for (const Ray& ray : seen.leaving) add(ray);
    }
    const double depth = system_.image_z() - system_.last_z();
    for (const V2d& point : points)
      least_cosine_ = std::min(least_cosine_, depth / std::hypot(depth, (point - image).length()));
    return {image, std::move(points)};
  }

  // From next to where light ends between two points of the image; nothing where it does not end there.
  std::vector<SeenFrom> rim_between(const SeenFrom& a, const SeenFrom& b) {
    if (a.is_lit() == b.is_lit()) return {};
    V2d lit = a.is_lit() ? a.image : b.image;
    V2d dark = a.is_lit() ? b.image : a.image;
    std::vector<SeenFrom> rim;
    for (int i = 0; i < kEdgeBisections; ++i) {
      SeenFrom middle = seen_from((lit + dark) / 2);
      (middle.is_lit() ? lit : dark) = middle.image;
      if (middle.is_lit()) rim = {std::move(middle)};
    }
    return rim;
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
  std::span<const double> wavelengths_nm_;
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

// An ellipse around what points of the image near `middle` see, as that sees it if pupils move by `shift`
// times as much as who looks.
PupilBound around(std::span<const SeenFrom> seen, const V2d& middle, double shift) {
  std::vector<V2d> points;
  for (const SeenFrom& from : seen)
    for (const V2d& point : from.points) points.push_back(point - shift * (from.image - middle));
  return around(points);
}

void append(std::vector<SeenFrom>& all, const std::vector<SeenFrom>& more) {
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
  // Of which the bounds along a radius are those all around.
  const SpectralSystem round(with_round_stop(system.system()), system.stop_radius_mm());
  centred_ ? bound_along_radius(round, wavelengths_nm) : bound_all_over(round, wavelengths_nm);
  if (std::all_of(bounds_.begin(), bounds_.end(), [](const PupilBound& b) { return !(b.area() > 0); }))
    throw Error(ErrorCode::scene, system.system().title, "no light comes through the lens to the film");
}

V2d ExitPupil::at(double column, double row) const {
  return centred_ ? V2d(column * cell_mm_.x, 0) : V2d(column, row) * cell_mm_ - half_image_;
}

void ExitPupil::bound_along_radius(const SpectralSystem& system, std::span<const double> wavelengths_nm) {
  Findings findings(system, wavelengths_nm);
  SeenFrom before = findings.seen_from(at(0, 0));
  for (int i = 1; i <= columns_; ++i) {
    SeenFrom here = findings.seen_from(at(i, 0));
    std::vector<SeenFrom> seen = findings.rim_between(before, here);
    append(seen, {std::move(before), here});
    bounds_.push_back(around(seen, at(i - 0.5, 0), shift_));
    before = std::move(here);
  }
  entrance_ = findings.entrance();
  least_cosine_ = findings.least_cosine();
}

void ExitPupil::bound_all_over(const SpectralSystem& system, std::span<const double> wavelengths_nm) {
  Findings findings(system, wavelengths_nm);
  const auto index = [this](int i, int j) { return static_cast<std::size_t>(j * (columns_ + 1) + i); };
  std::vector<SeenFrom> corners;
  for (int j = 0; j <= rows_; ++j)
    for (int i = 0; i <= columns_; ++i) corners.push_back(findings.seen_from(at(i, j)));
  // Where light ends on the edges that leave a corner in x and in y.
  std::vector<std::vector<SeenFrom>> ends_in_x(corners.size());
  std::vector<std::vector<SeenFrom>> ends_in_y(corners.size());
  for (int j = 0; j <= rows_; ++j)
    for (int i = 0; i <= columns_; ++i) {
      const std::size_t here = index(i, j);
      if (i < columns_) ends_in_x[here] = findings.rim_between(corners[here], corners[index(i + 1, j)]);
      if (j < rows_) ends_in_y[here] = findings.rim_between(corners[here], corners[index(i, j + 1)]);
    }
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) {
      std::vector<SeenFrom> seen{corners[index(i, j)], corners[index(i + 1, j)], corners[index(i, j + 1)],
                                 corners[index(i + 1, j + 1)]};
      append(seen, ends_in_x[index(i, j)]);
      append(seen, ends_in_x[index(i, j + 1)]);
      append(seen, ends_in_y[index(i, j)]);
      append(seen, ends_in_y[index(i + 1, j)]);
      bounds_.push_back(around(seen, at(i + 0.5, j + 0.5), shift_));
    }
  entrance_ = findings.entrance();
  least_cosine_ = findings.least_cosine();
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
