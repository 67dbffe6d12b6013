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
       "/render/lights: error: says how the integrator \"path\" draws its paths (got it with \"auto\")"},
      {"settings of another integrator", R"({"render": {"integrator": "bdpt", "directions": "cosine"}})",
       ErrorCode::scene,
       "/render/directions: error: says how the integrator \"path\" draws its paths (got it with \"bdpt\")"},
      {"settings of another integrator", R"({"render": {"integrator": "vcm", "heuristic": "power"}})",
       ErrorCode::scene,
       "/render/heuristic: error: says how the integrator \"path\" draws its paths (got it with \"vcm\")"},
      {"settings of another integrator", R"({"render": {"integrator": "path", "consistent": true}})",
       ErrorCode::scene,
       "/render/consistent: error: lets the integrator \"auto\" choose among more (got it with \"path\")"},
      {"weights of one way", R"({"render": {"integrator": "path", "lights": "bsdf", "heuristic": "power"}})",
       ErrorCode::scene,
       "/render/heuristic: error: weighs two ways to a light, of which \"lights\" leaves one (allowed with "
       "\"mis\")"},
  };
  expect_refused(faults);
}

}  // namespace
}  // namespace abbe
