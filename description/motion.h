#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "description/transform.h"
#include "io/schema/fields.h"
#include "scene/shapes/motion.h"

namespace abbe::spec {

/// Pose of a moving thing at a time.
struct Keyframe {
  schema::Located<double> time_s;
  std::optional<Rotation> rotate;
  std::optional<Imath::V3d> translate;
};
/// A rigid motion, given by keyframes.
struct Motion {
  std::vector<Keyframe> keyframes;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Motion>);

}  // namespace abbe::spec

namespace abbe::description {

/// Pose when the shutter opens, and the motion from then on.
struct PoseAndMotion {
  Imath::M44d pose_at_opening;
  std::shared_ptr<const Motion> motion = nullptr;  ///< Null if nothing moves during the exposure.
};
/// Builds the motion in the coordinates of the scene file. The context records it, to be recentred with the
/// scene. Reports times that do not increase; after an error nothing moves.
[[nodiscard]] PoseAndMotion build(const std::optional<spec::Motion>& spec, LoadContext& context);

}  // namespace abbe::description
