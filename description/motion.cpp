#include "description/motion.h"

#include <numbers>

#include <fmt/format.h>

#include "description/kinds.h"

namespace abbe::spec {

using namespace schema;

static Fields fields(Tag<Keyframe>) {
  return describe(
      "keyframe", "Where what moves is at a time: rotated, then translated.",
      {field("time_s", &Keyframe::time_s, Range{-1e9, 1e9}.in("s"),
             "When, on the clock by which the shutter opens."),
       field("rotate", &Keyframe::rotate, "Rotation from where it is described."),
       field("translate", &Keyframe::translate, kCoordinate, "Displacement after the rotation.")});
}

Fields fields(Tag<Motion>) {
  return describe(
      "motion",
      "Rigid motion from keyframe to keyframe: the translation is linear, the rotation of a constant rate "
      "about one axis. Before the first and after the last nothing moves.",
      {field("keyframes", &Motion::keyframes, list<Keyframe>("keyframes", 1),
             "In the order of their times. Where two that follow each other turn about the same axis, the "
             "angle runs from one to the other, whole turns included; else the shorter way is taken "
             "(slerp).")});
}

}  // namespace abbe::spec

namespace abbe::description {

Moving build(const std::optional<spec::Motion>& said, LoadContext& context) {
  if (!said) return {};
  std::vector<Motion::Keyframe> keyframes;
  for (std::size_t i = 0; i < said->keyframes.size(); ++i) {
    const spec::Keyframe& key = said->keyframes[i];
    const double before_s = i > 0 ? said->keyframes[i - 1].time_s.value : 0;
    if (i > 0 && !(key.time_s.value > before_s)) {
      context.diagnostics.error(key.time_s.where, fmt::format("times of keyframes increase (got {} after {})",
                                                              key.time_s.value, before_s));
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
  const Imath::M44d opening = motion->pose(0);
  if (motion->still()) return {opening};
  context.motions.push_back(motion);
  return {opening, motion};
}

}  // namespace abbe::description
