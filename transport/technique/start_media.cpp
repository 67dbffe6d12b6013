#include "transport/technique/start_media.h"

namespace abbe {

void enter_camera_media(const Plan& plan, PathState& path) {
  if (plan.camera_media_vary)
    path.media.enter(plan.scene, enclosing_media(plan.scene, path.ray.origin, path.ray.time),
                     path.lambda_nm());
  else if (!plan.camera_media.empty())
    path.media.enter(plan.scene, plan.camera_media, path.lambda_nm());
}

MediumStack camera_media(const Plan& plan, const Imath::V3f& lens_point, float time) {
  return plan.camera_media_vary ? enclosing_media(plan.scene, lens_point, time) : plan.camera_media;
}

void enter_light_media(const Plan& plan, std::uint32_t light, PathState& path) {
  if (!plan.light_media_vary.empty() && plan.light_media_vary[light])
    path.media.enter(plan.scene, enclosing_media(plan.scene, path.ray.origin, path.ray.time),
                     path.lambda_nm());
  else if (const MediumStack& stack = plan.light_media[light]; !stack.empty())
    path.media.enter(plan.scene, stack, path.lambda_nm());
}

}  // namespace abbe
