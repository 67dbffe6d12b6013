#include "description/motion.h"

#include <numbers>

#include <fmt/format.h>

#include "description/value_ranges.h"

namespace abbe::spec {

using namespace schema;

static Fields fields(Tag<Keyframe>) {
  return describe(
      "keyframe", "Pose at a time: a rotation, then a translation.",
      {field("time_s", &Keyframe::time_s, Range{-1e9, 1e9}.in("s"),
             "Time, on the same clock as the shutter's `open_s`."),
       field("rotate", &Keyframe::rotate, "Rotation from the described pose."),
       field("translate", &Keyframe::translate, kCoordinate, "Displacement after the rotation.")});
}

Fields fields(Tag<Motion>) {
  return describe(
      "motion",
      "Rigid motion between keyframes: the translation is linear, the rotation has a constant rate about one "
      "axis. Before the first and after the last keyframe nothing moves.",
      {field(
          "keyframes", &Motion::keyframes, list<Keyframe>("keyframes", 1),
          "Keyframes in the order of their times. If two successive ones rotate about the same axis, the "
          "angle is interpolated, including full turns. Otherwise the shorter rotation is taken (slerp).")});
}

}  // namespace abbe::spec

namespace abbe::description {

PoseAndMotion build(const std::optional<spec::Motion>& spec, LoadContext& context) {
  if (!spec) return {};
  std::vector<Motion::Keyframe> keyframes;
  for (std::size_t i = 0; i < spec->keyframes.size(); ++i) {
    const spec::Keyframe& key = spec->keyframes[i];
    const double before_s = i > 0 ? spec->keyframes[i - 1].time_s.value : 0;
    if (i > 0 && !(key.time_s.value > before_s)) {
      context.diagnostics.error(
          key.time_s.where,
          fmt::format("times of keyframes must increase (got {} after {})", key.time_s.value, before_s));
      return {};
    }
    Motion::Keyframe at{(key.time_s.value - context.open_s) / context.span_s};
    if (key.rotate) {
      at.axis = key.rotate->axis.normalized();
      at.angle = key.rotate->deg * std::numbers::pi / 180;
    }
    if (key.translate) at.translation = *key.translate * context.unit_m;
    keyframes.push_back(at);
  }
  auto motion = std::make_shared<Motion>(keyframes);
  const Imath::M44d pose_at_opening = motion->pose(0);
  if (motion->is_static()) return {pose_at_opening};
  context.motions.push_back(motion);
  return {pose_at_opening, motion};
}

}  // namespace abbe::description
