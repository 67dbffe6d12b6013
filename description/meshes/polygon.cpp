#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "description/meshes/mesh_formats.h"

namespace abbe {
namespace {

// Files round coordinates to about six digits, so smaller distances have no meaning.
constexpr double kRounding = 1e-6;
// Ear clipping takes a time quadratic in the number of corners.
constexpr std::size_t kMaxConcaveCorners = 16384;

/// A polygon that is triangulated by ear clipping. An ear is a triangle of three successive corners that
/// contains no other corner; every simple polygon has two [Meisters1975].
class Polygon {
 public:
  explicit Polygon(const std::vector<Imath::V3d>& corners) : corners_(corners) {
    double largest = 0;
    for (const Imath::V3d& corner : corners) {
      extent_ = std::max(extent_, (corner - corners[0]).length());
      largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    }
    rounding_ = kRounding * largest;
    Imath::V3d area(0);
    Imath::V3d widest(0);  // Used if edges cross, since their areas may cancel.
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Imath::V3d part = (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
      if (part.length2() > widest.length2()) widest = part;
      area += part;
    }
    normal_ = (area.length() > line() ? area : widest).normalized();
  }

  /// True if no triangle around the first corner turns back. This holds for every convex polygon.
  [[nodiscard]] bool is_fan() const {
    for (std::uint32_t i = 2; i < corners_.size(); ++i)
      if (turn(0, i - 1, i) < -line()) return false;
    return true;
  }
  [[nodiscard]] bool is_flat() const {
    return std::all_of(corners_.begin(), corners_.end(), [this](const Imath::V3d& corner) {
      return std::abs(normal_.dot(corner - corners_[0])) <= rounding_;
    });
  }
  /// Triangles with the winding of the polygon, those without area last. There are too few if its edges
  /// cross.
  [[nodiscard]] std::vector<Triangle> ears() {
    left_.resize(corners_.size());
    std::iota(left_.begin(), left_.end(), 0U);
    std::vector<Triangle> cut;
    std::size_t missed = 0;  // Corners tried since the last cut. The second round accepts ears without area.
    for (std::size_t i = 0; left_.size() > 2 && missed < 2 * left_.size();) {
      if (!is_ear(i, missed < left_.size() ? line() : -line())) {
        i = next(i);
        ++missed;
        continue;
      }
      cut.push_back({left_[previous(i)], left_[i], left_[next(i)]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
      i = previous(i);  // It may have become an ear.
      missed = 0;
    }
    return cut;
  }

 private:
  // Twice the area of a triangle as seen along the normal; negative for the opposite winding.
  [[nodiscard]] double turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return normal_.dot((corners_[b] - corners_[a]).cross(corners_[c] - corners_[a]));
  }
  // Bound for twice the area of a triangle that is a line up to rounding.
  [[nodiscard]] double line() const { return rounding_ * extent_; }
  [[nodiscard]] std::size_t next(std::size_t i) const { return (i + 1) % left_.size(); }
  [[nodiscard]] std::size_t previous(std::size_t i) const { return (i + left_.size() - 1) % left_.size(); }

  // True if the triangle contains the corner. A corner that coincides with one of the triangle does not
  // count; such corners occur where a slit leads to a hole.
  [[nodiscard]] bool is_within(std::uint32_t corner, const Triangle& t) const {
    const auto at = [&](std::uint32_t i) { return (corners_[corner] - corners_[i]).length() <= rounding_; };
    return turn(t[0], t[1], corner) >= 0 && turn(t[1], t[2], corner) >= 0 && turn(t[2], t[0], corner) >= 0 &&
           std::none_of(t.begin(), t.end(), at);
  }
  [[nodiscard]] bool is_ear(std::size_t i, double more_than) const {
    const Triangle ear{left_[previous(i)], left_[i], left_[next(i)]};
    return turn(ear[0], ear[1], ear[2]) > more_than &&
           std::none_of(left_.begin(), left_.end(),
                        [&](std::uint32_t other) { return is_within(other, ear); });
  }

  const std::vector<Imath::V3d>& corners_;
  std::vector<std::uint32_t> left_;  // Corners that have not been cut off.
  Imath::V3d normal_;
  double extent_ = 0;
  double rounding_ = 0;
};

}  // namespace

std::optional<std::string> cut_polygon(const std::vector<Imath::V3d>& corners,
                                       std::vector<Triangle>& triangles) {
  triangles.clear();
  for (std::uint32_t i = 2; i < corners.size(); ++i) triangles.push_back({0, i - 1, i});
  if (corners.size() == 3) return std::nullopt;
  Polygon polygon(corners);
  if (polygon.is_fan()) return std::nullopt;
  if (corners.size() > kMaxConcaveCorners)
    return fmt::format("a polygon of {} corners that is not convex (allowed {} or fewer)", corners.size(),
                       kMaxConcaveCorners);
  std::vector<Triangle> ears = polygon.ears();
  if (ears.size() == triangles.size()) {
    triangles = std::move(ears);
    return std::nullopt;
  }
  if (polygon.is_flat()) return fmt::format("a polygon of {} corners whose edges cross", corners.size());
  return std::nullopt;
}

}  // namespace abbe
