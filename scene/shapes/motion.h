#pragma once

#include <vector>

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImathVec.h>

namespace abbe {

/// A rigid motion through keyframes. Time is that of rays: 0 when the shutter opens, 1 when it closes for the
/// last row. Between two keyframes the translation is linear and the rotation turns about one axis at a
/// constant rate. If both keyframes have the same axis, it runs from one angle to the other, whole turns
/// included. Opposite axes count as the same, with the sign of one angle reversed. A keyframe without
/// rotation takes the axis of the other keyframe, whole turns included. For two different axes the rotation
/// is the shortest, as with slerp [Shoemake1985]. Nothing moves before the first keyframe and after the last.
class Motion {
 public:
  /// A pose: a right-handed rotation about an axis through the scene file's origin, then a translation [m].
  struct Keyframe {
    double time = 0;
    Imath::V3d axis{0, 0, 0};  ///< Unit; zero without rotation.
    double angle = 0;          ///< [radians]; any number of turns.
    Imath::V3d translation{0, 0, 0};
  };

  /// Requires at least one keyframe, with strictly increasing times; this is not checked. Times may lie
  /// outside [0, 1].
  explicit Motion(const std::vector<Keyframe>& keyframes);

  /// Pose at that time, as a matrix for row vectors in scene-file coordinates [m]. `recentre` has no effect
  /// on it.
  [[nodiscard]] Imath::M44d pose(double time) const;
  /// True if the pose is the same at all times from 0 to 1.
  [[nodiscard]] bool is_static() const;

  /// Makes the position `origin` [m] of the scene file the origin of the coordinates of the functions below.
  /// It is (0, 0, 0) at first.
  void recentre(const Imath::V3d& origin);
  /// Rigid map for row vectors from the pose at time 0 to that at `time`; the identity at time 0.
  [[nodiscard]] Imath::M44d since_opening(double time) const;
  /// Box around the convex hull of `points`, given at time 0, at all times from `from` to `to`.
  [[nodiscard]] Imath::Box3d sweep(const std::vector<Imath::V3d>& points, double from, double to) const;

 private:
  // The motion between two keyframes: the rotation is `start`, followed by a fraction of a turn about the
  // axis.
  struct Segment {
    double from, to;
    Imath::M44d start;
    Imath::V3d axis;
    double angle;
    Imath::V3d first, last;  // translations
  };

  [[nodiscard]] const Segment& segment_at(double time) const;
  [[nodiscard]] static Imath::M44d pose_in(const Segment& segment, double time);
  void sweep_segment(const Segment& segment, const std::vector<Imath::V3d>& points, double from, double to,
                     Imath::Box3d& box) const;

  std::vector<Segment> segments_;
  Imath::M44d to_keyframes_;  // from the pose at time 0 to the coordinates that poses transform
  Imath::V3d origin_{0, 0, 0};
};

/// The inverse of a rotation followed by a translation, for row vectors; wrong for other maps.
[[nodiscard]] Imath::M44d rigid_inverse(const Imath::M44d& map);

}  // namespace abbe
