#include "transport/render/learnt_plan.h"

#include "transport/render/learn_aims.h"
#include "transport/render/learn_caustics.h"
#include "transport/render/learn_wavelengths.h"

namespace abbe {

Plan make_learnt_plan(const Scene& scene, int threads, const std::shared_ptr<const Guides>& guides) {
  Plan plan = make_plan(scene);
  if (guides != nullptr) {
    plan.guides = *guides;
    return plan;
  }
  if (plan.techniques.size() > 1) {
    learn_aims(plan, threads);
    learn_wavelengths(plan, threads);
  }
  learn_caustics(plan, threads);
  return plan;
}

}  // namespace abbe
