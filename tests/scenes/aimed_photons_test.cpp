// Where pilots aim photons: at what lets light through to the film.
#include <algorithm>

#include "tests/scenes/scene_fixture.h"
#include "transport/render/learnt_plan.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

// Of the photons of a plan, the share that adds to the film.
double share_landed(const Plan& plan) {
  constexpr std::uint32_t kPhotons = 1 << 15;
  RayCaster caster(plan.scene);
  LightTracer tracer(plan, caster, 1);
  std::vector<Sampler> photons;
  for (std::uint32_t i = 0; i < kPhotons; ++i) photons.emplace_back(5, Purpose::light, 0, 0, i);
  std::vector<bool> landed(kPhotons);
  tracer.trace(photons, [&](std::uint32_t photon, const FilmPoint&, std::span<const double>) {
    landed[photon] = true;
  });
  return static_cast<double>(std::count(landed.begin(), landed.end(), true)) / kPhotons;
}

// What prism faces reflect, and what is drawn anywhere, never comes there.
TEST(AimedPhotons, MostComeThroughASlit) {
  for (const auto& [name, least] : {std::pair("prism_area.json", 0.5), std::pair("sunlit_prism.json", 0.5)}) {
    const Scene scene = test::load(name, {});
    const double share = share_landed(make_learnt_plan(scene, 2));
    std::printf("%s: %.3f of the photons\n", name, share);
    EXPECT_GT(share, least) << name;
  }
}

}  // namespace
}  // namespace abbe
