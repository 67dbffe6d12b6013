// Guided photons beside unguided ones, branch by branch: by which specular shapes, and by which events there,
// light comes to the film or to a meter.
#include <cmath>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "tests/scenes/only_meter.h"
#include "tests/tier.h"
#include "transport/render/trained_plan.h"
#include "transport/technique/light.h"

namespace abbe {
namespace {

struct BranchSum {
  double sum = 0;
  double squares = 0;  // of what each photon brings
  [[nodiscard]] double photons() const { return squares > 0 ? sum * sum / squares : 0; }
};
using Branches = std::map<std::uint32_t, BranchSum>;

double magnitude_of(std::span<const double> values) {
  double sum = 0;
  for (const double value : values) sum += std::abs(value);
  return sum;
}

// Mean of what photons of a plan bring the film by each branch, and what the sums of squares then are.
Branches trace_branches(const Plan& plan, std::uint32_t photons) {
  constexpr std::uint32_t kBatch = 512;
  RayCaster caster(plan.scene);
  LightTracer tracer(plan, caster, 1);
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> values_at;  // by photon and branch
  tracer.set_layer_sink([&](std::uint32_t photon, const FilmPoint&, const ContributionInfo& of,
                            std::span<const double> values) {
    values_at[{photon, of.branch}] += magnitude_of(values) / photons;
  });
  Branches branches;
  for (std::uint32_t first = 0; first < photons; first += kBatch) {
    std::vector<Sampler> batch;
    for (std::uint32_t i = first; i < first + kBatch; ++i) batch.emplace_back(9, Purpose::light, 0, 0, i);
    tracer.trace(batch, [](std::uint32_t, const FilmPoint&, std::span<const double>) {});
    for (const auto& [from, value] : values_at) {
      branches[from.second].sum += value;
      branches[from.second].squares += value * value;
    }
    values_at.clear();
  }
  return branches;
}

struct NamedText {
  const char* name;
  const char* text;
};

constexpr const char* kMaterials = R"("glass": {"dielectric": {"ior": 1.5}},
    "pane": {"thin_glass": {"ior": 1.5}}, "mirror": {"mirror": {"reflectance": 0.9}},
    "dark_mirror": {"mirror": {"reflectance": 0.03}}, "white": {"diffuse": {"reflectance": 0.8}})";

constexpr NamedText kCasters[] = {
    {"ball", R"({"sphere": {"center": [0, 0, 1.5], "radius": 0.7}, "material": "glass"})"},
    {"two balls of unequal size",
     R"({"sphere": {"center": [-1, 0, 1.4], "radius": 0.9}, "material": "glass"},
        {"sphere": {"center": [1.3, 0.4, 0.7], "radius": 0.12}, "material": "glass"})"},
    {"gem",
     R"({"mesh": {"vertices": [[0.8, 0, 1.5], [-0.8, 0, 1.5], [0, 0.8, 1.5], [0, -0.8, 1.5], [0, 0, 2.3],
               [0, 0, 0.6]], "triangles": [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5],
               [3, 1, 5], [0, 3, 5]]}, "material": "glass"})"},
    {"lens", R"({"sphere": {"center": [0, 0, 1.2], "radius": 0.6}, "material": "glass"},
        {"quad": {"corner": [-1, -1, 2], "edge_u": [2, 0, 0], "edge_v": [0, 2, 0.2]}, "material": "pane"})"},
    {"mirrors that show images of each other",
     R"({"quad": {"corner": [-1.2, -1, 0.2], "edge_u": [0, 2, 0], "edge_v": [0.1, 0, 1.5]}, "material": "mirror"},
        {"quad": {"corner": [1.2, -1, 0.2], "edge_u": [0, 2, 0], "edge_v": [-0.2, 0, 1.5]}, "material": "mirror"})"},
    {"mirrors of unequal power",
     R"({"quad": {"corner": [-1.2, -1, 0.2], "edge_u": [0, 2, 0], "edge_v": [-0.5, 0, 1.5]}, "material": "mirror"},
        {"quad": {"corner": [1.4, 0, 0.3], "edge_u": [0, 0.2, 0], "edge_v": [0.1, 0, 0.2]}, "material": "dark_mirror"})"},
    {"a ball beside a small dark mirror",
     R"({"sphere": {"center": [-0.6, 0, 1.5], "radius": 0.8}, "material": "glass"},
        {"quad": {"corner": [1.2, 0, 0.5], "edge_u": [0, 0.2, 0], "edge_v": [0.2, 0, 0.1]}, "material": "dark_mirror"})"},
};

constexpr NamedText kLights[] = {
    {"point", R"({"point": {"at": [0.4, 0.3, 6]}, "emission": {"illuminant": "E", "intensity": 1}})"},
    {"sun",
     R"({"directional": {"towards": [-0.2, -0.1, 1]}, "emission": {"illuminant": "E", "irradiance": 1}})"},
    {"spot", R"({"spot": {"at": [-0.5, 0.2, 5], "direction": [0.1, 0, -1], "half_angle_deg": 30},
              "emission": {"illuminant": "E", "intensity": 1}})"},
};

struct BranchCase {
  NamedText casters;
  NamedText light;
};
void PrintTo(const BranchCase& of, std::ostream* out) {
  *out << of.casters.name << " under a " << of.light.name;
}
std::vector<BranchCase> branch_cases() {
  std::vector<BranchCase> cases;
  std::size_t number = 0;
  for (const NamedText& casters : kCasters)
    for (const NamedText& light : kLights)
      if (test::nightly() || number++ % 5 == 1) cases.push_back({casters, light});
  return cases;
}

Scene scene_of_case(const BranchCase& of) {
  return test::load_text(R"({"abbe": 1, "sensor": {"resolution": [4, 4], "observer": "1931"},
    "camera": {"pinhole": {"fov_deg": 50}, "from": [0, -7, 5], "to": [0, 0, 0], "up": [0, 0, 1]},
    "materials": {)" + std::string(kMaterials) +
                         R"(},
    "lights": [)" + of.light.text +
                         R"(], "shapes": [{"quad": {"corner": [-3, -3, 0], "edge_u": [6, 0, 0],
    "edge_v": [0, 6, 0]}, "material": "white"}, )" +
                         of.casters.text + R"(]})");
}

class GuidedBranches : public ::testing::TestWithParam<BranchCase> {};

// A branch that even photons show by a hundred is brought by guided ones as well, as bright, and by many.
TEST_P(GuidedBranches, AreThoseOfUnguidedPhotons) {
  constexpr double kShown = 100;
  constexpr double kFew = 25;
  const std::uint32_t photons = test::nightly() ? 1U << 20 : 1U << 17;
  const Scene scene = scene_of_case(GetParam());
  const Plan even = make_plan(scene);
  const Plan guided = make_trained_plan(scene, 2);
  ASSERT_TRUE(traces(guided.techniques, TracedPaths::light));
  const Branches expected = trace_branches(even, photons);
  Branches found = trace_branches(guided, photons);
  int compared = 0;
  for (const auto& [branch, sum] : expected) {
    if (sum.photons() < kShown) continue;
    const BranchSum& by_guide = found[branch];
    const double error = std::sqrt(sum.squares + by_guide.squares);
    EXPECT_NEAR(by_guide.sum, sum.sum, 4.5 * error) << "branch " << branch;
    EXPECT_GT(by_guide.photons(), kFew) << "branch " << branch;
    ++compared;
  }
  EXPECT_GE(compared, 1);
}
INSTANTIATE_TEST_SUITE_P(Scenes, GuidedBranches, ::testing::ValuesIn(branch_cases()));

// A drop of water of 10 mm under a sun of three lines, and a disc of 1 mm half a metre away in the direction
// of the bow. The ball's front reflects light there as a mirror does, all wavelengths alike: of the
// irradiance E of one line, with i = 17.5 degrees the angle of incidence and d the distance from the ball's
// center, (R/2)^2 F(i) / d^2 E per line, but for what d >> R leaves out. The bow is brighter by far.
std::string bow(const std::string& depth) {
  return R"({"abbe": 1, "units": "mm",
    "materials": {"water": {"dielectric": {"ior": {"wavelength_nm": [486.1327, 587.5618, 656.2725],
                                                   "n": [1.3371, 1.333, 1.3312]}}}},
    "lights": [{"directional": {"towards": [-1, 0, 0]}, "emission": {"lines": [
      {"nm": 486.1327, "width_nm": 0.01, "power": 1}, {"nm": 587.5618, "width_nm": 0.01, "power": 1},
      {"nm": 656.2725, "width_nm": 0.01, "power": 1}]}}],
    "shapes": [{"sphere": {"center": [0, 0, 0], "radius": 10}, "material": "water"}],
    "meters": {"disc": {"disc": {"center": [-409.5760221444959, 286.788218175523, 0],
                                 "normal": [0.8191520442889918, -0.573576436351046, 0], "radius": 1},
                        "spectrum": {"from_nm": 400, "to_nm": 710, "step_nm": 10}}},
    "render": {"max_depth": )" +
         depth + R"(, "seed": 6, "samples": 32768}})";
}

TEST(GuidedBranches, KeepTheReflectionOfADropBesideItsBow) {
  const test::OnlyMeter all = test::only_meter(bow("3"));
  const test::OnlyMeter reflected = test::only_meter(bow("1"));
  const Branches alone = trace_branches(make_trained_plan(reflected.scene, 2), 1 << 15);
  ASSERT_EQ(alone.size(), 1U);
  const auto& [branch, reflection] = *alone.begin();
  const Plan plan = make_trained_plan(all.scene, 2);
  Branches found = trace_branches(plan, 1 << 17);
  for (const auto& [b, sum] : found)
    std::printf("branch %08x: %.4g +- %.2g, %.1f photons\n", b, sum.sum, std::sqrt(sum.squares),
                sum.photons());
  std::printf("alone %.5g +- %.2g\n", reflection.sum, std::sqrt(reflection.squares));
  EXPECT_NEAR(found[branch].sum, reflection.sum, 4.5 * std::sqrt(found[branch].squares + reflection.squares));
  EXPECT_GT(found[branch].photons(), 50);
  // The bow comes through two spots of some cells each, over which its grid is smoothed no farther.
  for (const auto& [b, sum] : found) EXPECT_TRUE(b == branch || sum.photons() > 100) << sum.photons();
  if (!test::nightly()) return;
  RenderOptions how;
  how.guides = std::make_shared<const GuidingData>(plan.guides);
  const Film::Average read =
      read_meter(all.meter, render(all.scene, how).film, all.scene.exposure_s).whole.radiant;
  EXPECT_NEAR(read.mean, 9.9418e-5, 4.5 * read.standard_error);
  EXPECT_LT(read.standard_error, 0.02 * read.mean);
}

}  // namespace
}  // namespace abbe
