#include "transport/technique/start_matter.h"

namespace abbe {

void enter_camera_matter(const Plan& plan, Walk& path) {
  if (plan.camera_matter_varies)
    path.around.enter(plan.scene, enclosing(plan.scene, path.ray.origin, path.ray.time), path.lambda_nm());
  else if (!plan.camera_inside.empty())
    path.around.enter(plan.scene, plan.camera_inside, path.lambda_nm());
}

MediumStack camera_matter(const Plan& plan, const Imath::V3f& lens_point, float time) {
  return plan.camera_matter_varies ? enclosing(plan.scene, lens_point, time) : plan.camera_inside;
}

void enter_light_matter(const Plan& plan, std::uint32_t light, Walk& path) {
  if (!plan.light_matter_moves.empty() && plan.light_matter_moves[light])
    path.around.enter(plan.scene, enclosing(plan.scene, path.ray.origin, path.ray.time), path.lambda_nm());
  else if (const MediumStack& inside = plan.light_inside[light]; !inside.empty())
    path.around.enter(plan.scene, inside, path.lambda_nm());
}

}  // namespace abbe
