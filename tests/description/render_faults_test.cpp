#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "description.h"

namespace abbe {
namespace {

using RenderFaultsTest = test::DescriptionTest;
using test::Fault;

TEST_F(RenderFaultsTest, OfSamplingAreExplained) {
  const std::vector<Fault> faults{
      {"settings of another integrator", R"({"render": {"lights": "light"}})", ErrorCode::scene,
       "/render/lights: error: is an option of the integrator \"path\" (got it with \"auto\")"},
      {"settings of another integrator", R"({"render": {"integrator": "bdpt", "directions": "cosine"}})",
       ErrorCode::scene,
       "/render/directions: error: is an option of the integrator \"path\" (got it with \"bdpt\")"},
      {"settings of another integrator", R"({"render": {"integrator": "vcm", "heuristic": "power"}})",
       ErrorCode::scene,
       "/render/heuristic: error: is an option of the integrator \"path\" (got it with \"vcm\")"},
      {"settings of another integrator", R"({"render": {"integrator": "path", "consistent": true}})",
       ErrorCode::scene,
       "/render/consistent: error: is an option of the integrator \"auto\" (got it with \"path\")"},
      {"weights of one way", R"({"render": {"integrator": "path", "lights": "bsdf", "heuristic": "power"}})",
       ErrorCode::scene,
       "/render/heuristic: error: combines two sampling techniques, of which \"lights\" uses only one "
       "(allowed with "
       "\"mis\")"},
  };
  expect_refused(faults);
}

}  // namespace
}  // namespace abbe
