#include "transport/render/trained_plan.h"

#include "transport/render/train_caustic_guides.h"
#include "transport/render/train_photon_guides.h"
#include "transport/render/train_photon_wavelengths.h"

namespace abbe {

Plan make_trained_plan(const Scene& scene, int threads, const std::shared_ptr<const GuidingData>& guides) {
  Plan plan = make_plan(scene);
  if (guides != nullptr) {
    plan.guides = *guides;
    return plan;
  }
  if (plan.techniques.size() > 1) {
    train_photon_guides(plan, threads);
    train_photon_wavelengths(plan, threads);
  }
  train_caustic_guides(plan, threads);
  return plan;
}

}  // namespace abbe
