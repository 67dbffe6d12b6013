// Every film with a closed form, rendered by techniques that start at lights or wait for photons.
#include <array>
#include <set>

#include "scene/unreached.h"
#include "tests/scenes/scene_fixture.h"
#include "tests/validation/cases_run.h"

namespace abbe {
namespace {

struct Technique {
  const char* integrator;
  int patience = 1;   // by which the samples are multiplied
  double margin = 0;  // where larger than that of the case: of photons that find the meter by themselves
};

struct Rendered {
  Case item;
  Technique by;
};

void PrintTo(const Rendered& rendered, std::ostream* out) {
  *out << rendered.item.id << " by " << rendered.by.integrator;
}

constexpr std::array<Technique, 6> kTechniques{
    {{"bdpt"}, {"sppm", 2}, {"vcm"}, {"photon-map", 2}, {"adjoint-brute", 32}, {"photon-brute", 16, 0.05}}};

// The rest is for the nights: enclosures whose paths have hundreds of events, every two of which are joined,
// and most of what others than `bdpt` do.
bool is_affordable(const Case& item, const Technique& by) {
  const std::set<std::string> few{"T9-outer", "T12-white", "T13-60", "T15-T"};
  const std::string integrator = by.integrator;
  if (integrator == "photon-brute") return false;  // these meters are points
  return integrator == "bdpt" ? item.id != "T1-0.95" && item.id != "T8" : few.contains(item.id);
}

std::vector<Rendered> renders(bool affordable) {
  std::vector<Rendered> chosen;
  for (const Case& item : test::cases_by<FilmMean>())
    for (const Technique& technique : kTechniques)
      if (is_affordable(item, technique) == affordable) chosen.push_back({item, technique});
  return chosen;
}

std::string name_of(const testing::TestParamInfo<Rendered>& info) {
  std::string name = test::case_name({info.param.item, info.index}) + "_by_" + info.param.by.integrator;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class TechniqueCase : public testing::TestWithParam<Rendered> {};

TEST_P(TechniqueCase, AgreesWithItsReference) {
  Case item = GetParam().item;
  auto& film = std::get<FilmMean>(item.method);
  film.settings.push_back({"/render/integrator", GetParam().by.integrator});
  const Scene scene = test::load("validation/" + film.scene, film.settings);
  if (const auto lost = unreached(scene, scene.needs, false); !lost.empty()) GTEST_SKIP() << lost.front();
  film.samples *= GetParam().by.patience;
  if (GetParam().by.margin > 0) item.margin = {GetParam().by.margin, Margin::Kind::relative};
  test::expect_passes(item, {});
}

INSTANTIATE_TEST_SUITE_P(Cases, TechniqueCase, testing::ValuesIn(renders(true)), name_of);
INSTANTIATE_TEST_SUITE_P(Nightly, TechniqueCase, testing::ValuesIn(renders(false)), name_of);

}  // namespace
}  // namespace abbe
