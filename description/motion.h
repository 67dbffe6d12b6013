#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "description/transform.h"
#include "io/schema/fields.h"
#include "scene/shapes/motion.h"

namespace abbe::spec {

/// Pose at a time, relative to the described pose: a rotation, then a translation in scene units.
struct Keyframe {
  schema::Located<double> time_s;  ///< Time on the clock of the shutter's `open_s`.
  std::optional<Rotation> rotate;
  std::optional<Imath::V3d> translate;
};
/// A rigid motion, given by keyframes. Between two of them the translation is linear and the rotation has a
/// constant rate about one axis. Nothing moves before the first and after the last.
struct Motion {
  std::vector<Keyframe> keyframes;  ///< At least one, with strictly increasing times.
  SourcePosition where;
};
/// Key table by which scene files are read, written and documented.
[[nodiscard]] schema::Fields fields(schema::Tag<Motion>);

}  // namespace abbe::spec

namespace abbe::description {

/// Pose when the shutter opens, and the motion from then on.
struct PoseAndMotion {
  Imath::M44d pose_at_opening;  ///< Matrix for row vectors [m]; the identity for the described pose.
  std::shared_ptr<const Motion> motion = nullptr;  ///< Null if nothing moves during the exposure.
};
/// Builds the motion in the coordinates of the scene file [m]. Times become fractions of the exposure: 0 at
/// `context.open_s`, 1 after `context.span_s`. `context.motions` records the motion, to be recentred with the
/// scene. Reports times that do not increase to `context.diagnostics`. After an error, and without `spec`,
/// the pose is the identity and nothing moves.
[[nodiscard]] PoseAndMotion build(const std::optional<spec::Motion>& spec, LoadContext& context);

}  // namespace abbe::description
