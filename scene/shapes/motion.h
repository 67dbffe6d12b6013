#pragma once

#include <vector>

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImathVec.h>

namespace abbe {

/// A rigid motion through keyframes, in time as rays have it: 0 when the shutter opens, 1 when it closes for
/// the last time. Between two keyframes the translation is linear, and the rotation runs about one axis at a
/// constant rate: from one angle to the other where both turn about the same axis, whole turns included, and
/// else the shorter way, as slerp does [Shoemake1985]. Before the first and after the last keyframe nothing
/// moves.
class Motion {
 public:
  /// A pose: a right-handed rotation about an axis through the scene file's origin, then a translation [m].
  struct Keyframe {
    double time = 0;
    Imath::V3d axis{0, 0, 0};  ///< Unit; zero where nothing is turned.
    double angle = 0;          ///< [radians]
    Imath::V3d translation{0, 0, 0};
  };

  /// At least one keyframe; times increase.
  explicit Motion(const std::vector<Keyframe>& keyframes);

  /// The pose at that time as a matrix for row vectors, in the coordinates of the scene file.
  [[nodiscard]] Imath::M44d pose(double time) const;
  /// Whether the pose is the same at all times from 0 to 1.
  [[nodiscard]] bool still() const;

  /// Takes the scene file's point `origin` [m] for (0, 0, 0) from now on, in what follows.
  void recentre(const Imath::V3d& origin);
  /// What has happened since time 0 to what moves: the rigid map from where it was then.
  [[nodiscard]] Imath::M44d since_opening(double time) const;
  /// A box around all that is, at time 0, within the convex hull of `points`, at all times from `from` to
  /// `to`.
  [[nodiscard]] Imath::Box3d sweep(const std::vector<Imath::V3d>& points, double from, double to) const;

 private:
  // From one keyframe to the next: the rotation is `start`, then a share of a turn about the axis.
  struct Segment {
    double from, to;
    Imath::M44d start;
    Imath::V3d axis;
    double angle;
    Imath::V3d first, last;  // translations
  };

  [[nodiscard]] const Segment& segment_at(double time) const;
  [[nodiscard]] static Imath::M44d pose_in(const Segment& segment, double time);
  void sweep_piece(const Segment& segment, const std::vector<Imath::V3d>& points, double from, double to,
                   Imath::Box3d& box) const;

  std::vector<Segment> segments_;
  Imath::M44d to_keyframes_;  // from the place at time 0 to what the poses are applied to
  Imath::V3d origin_{0, 0, 0};
};

/// The inverse of a rotation and a translation.
[[nodiscard]] Imath::M44d rigid_inverse(const Imath::M44d& map);

}  // namespace abbe
