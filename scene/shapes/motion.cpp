#include "scene/shapes/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <ImathMatrixAlgo.h>

namespace abbe {
namespace {

Imath::M44d rotation(const Imath::V3d& axis, double angle) {
  return angle == 0 ? Imath::M44d() : Imath::M44d().setAxisAngle(axis, angle);
}

struct Turn {
  Imath::V3d axis;
  double angle;
};

// The rotation between two keyframes about a common axis; nothing if their axes differ.
std::optional<Turn> turn_about_one_axis(const Motion::Keyframe& a, const Motion::Keyframe& b) {
  constexpr double kSameAxis = 1e-9;  // sine of the angle between them
  if (a.angle == 0) return Turn{b.axis, b.angle};
  if (b.angle == 0) return Turn{a.axis, -a.angle};
  if (a.axis.cross(b.axis).length() > kSameAxis) return std::nullopt;
  return Turn{a.axis, std::copysign(b.angle, b.angle * a.axis.dot(b.axis)) - a.angle};
}

// The shortest rotation between two orientations.
Turn shortest_turn(const Imath::M44d& from, const Imath::M44d& to) {
  const Imath::Quatd q = Imath::extractQuat(from.transposed() * to).normalized();
  const double angle = q.angle();
  return angle <= std::numbers::pi ? Turn{q.axis(), angle} : Turn{-q.axis(), 2 * std::numbers::pi - angle};
}

}  // namespace

Motion::Motion(const std::vector<Keyframe>& keyframes) {
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const Keyframe& a = keyframes[i];
    const Keyframe& b = keyframes[std::min(i + 1, keyframes.size() - 1)];
    const Imath::M44d start = rotation(a.axis, a.angle);
    const auto same = turn_about_one_axis(a, b);
    const Turn turn = same ? *same : shortest_turn(start, rotation(b.axis, b.angle));
    segments_.push_back({a.time, b.time, start, turn.axis, turn.angle, a.translation, b.translation});
  }
  recentre(Imath::V3d(0));
}

// The last segment has zero length.
const Motion::Segment& Motion::segment_at(double time) const {
  const auto next = std::upper_bound(segments_.begin(), segments_.end(), time,
                                     [](double t, const Segment& segment) { return t < segment.from; });
  return next == segments_.begin() ? *next : *(next - 1);
}

Imath::M44d Motion::pose_in(const Segment& segment, double time) {
  const double length = segment.to - segment.from;
  const double fraction = length > 0 ? std::clamp((time - segment.from) / length, 0.0, 1.0) : 0;
  Imath::M44d pose = segment.start * rotation(segment.axis, fraction * segment.angle);
  const Imath::V3d at = segment.first + (segment.last - segment.first) * fraction;
  for (int i = 0; i < 3; ++i) pose[3][i] = at[i];
  return pose;
}

Imath::M44d Motion::pose(double time) const {
  return pose_in(segment_at(time), time);
}

bool Motion::is_static() const {
  return std::none_of(segments_.begin(), segments_.end(), [](const Segment& segment) {
    return segment.from < 1 && segment.to > 0 && (segment.angle != 0 || segment.first != segment.last);
  });
}

void Motion::recentre(const Imath::V3d& origin) {
  origin_ = origin;
  to_keyframes_ = Imath::M44d().setTranslation(origin) * rigid_inverse(pose(0));
}

Imath::M44d Motion::since_opening(double time) const {
  Imath::M44d map = to_keyframes_ * pose(time);
  for (int i = 0; i < 3; ++i) map[3][i] -= origin_[i];
  return map;
}

Imath::Box3d Motion::sweep(const std::vector<Imath::V3d>& points, double from, double to) const {
  std::vector<Imath::V3d> rest_points;  // the points in the coordinates that poses transform
  for (const Imath::V3d& point : points) rest_points.push_back(point * to_keyframes_);
  Imath::Box3d box;
  const Segment* first = &segment_at(from);
  const Segment* last = &segment_at(to);
  for (const Segment* segment = first; segment <= last; ++segment)
    sweep_segment(*segment, rest_points, segment == first ? from : segment->from,
                  segment == last ? to : segment->to, box);
  return box;
}

// During a step by the angle theta, a point at the distance r from the axis deviates from the chord by at
// most r theta^2 / 8. This is the maximum error of linear interpolation for a second derivative of r theta^2.
void Motion::sweep_segment(const Segment& segment, const std::vector<Imath::V3d>& points, double from,
                           double to, Imath::Box3d& box) const {
  constexpr double kMaxTurn = std::numbers::pi / 16;
  const double length = segment.to - segment.from;
  const double turned = length > 0 ? std::abs(segment.angle) * std::min(1.0, (to - from) / length) : 0;
  const int steps = 1 + static_cast<int>(std::min(turned / kMaxTurn, 1e4));
  const double theta = std::min(turned / steps, 4.0);  // above 4, the deviation is at most twice the distance
  for (int i = 0; i <= steps; ++i) {
    const Imath::M44d pose = pose_in(segment, from + (to - from) * i / steps);
    for (const Imath::V3d& point : points) {
      const Imath::V3d at = point * pose - origin_;
      const auto slack = Imath::V3d(point.length() * theta * theta / 8);
      box.extendBy(at - slack);
      box.extendBy(at + slack);
    }
  }
}

Imath::M44d rigid_inverse(const Imath::M44d& map) {
  Imath::M44d inverse;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) inverse[i][j] = map[j][i];
  const Imath::V3d shift(map[3][0], map[3][1], map[3][2]);
  for (int i = 0; i < 3; ++i)
    inverse[3][i] = -(shift.x * inverse[0][i] + shift.y * inverse[1][i] + shift.z * inverse[2][i]);
  return inverse;
}

}  // namespace abbe
