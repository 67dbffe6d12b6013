#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "description/transform.h"
#include "io/schema/fields.h"
#include "scene/shapes/motion.h"

namespace abbe::spec {

/// Where what moves is at a time.
struct Keyframe {
  schema::Located<double> time_s;
  std::optional<Rotation> rotate;
  std::optional<Imath::V3d> translate;
};
/// Keyframes, by which something moves.
struct Motion {
  std::vector<Keyframe> keyframes;
  SourcePosition where;
};
[[nodiscard]] schema::Fields fields(schema::Tag<Motion>);

}  // namespace abbe::spec

namespace abbe::description {

/// Where something is brought to when the shutter opens, and how it moves from then on.
struct Moving {
  Imath::M44d opening;
  std::shared_ptr<const Motion> motion =
      nullptr;  ///< Nothing of what stands still while the film is exposed.
};
/// The motion in the scene file's coordinates, remembered by the context to be recentred with the scene.
/// Reports times that do not increase; nothing moves after an error.
[[nodiscard]] Moving build(const std::optional<spec::Motion>& said, LoadContext& context);

}  // namespace abbe::description
