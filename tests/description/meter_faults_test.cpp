#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <fmt/format.h>

#include "description.h"

namespace abbe {
namespace {

using MeterFaultsTest = test::DescriptionTest;
using test::Fault;
using test::metered;

TEST_F(MeterFaultsTest, AreExplained) {
  const std::vector<Fault> faults{
      {"flux through a point", metered(R"("measures": "flux", "at": [0, 0, 0], "normal": [0, 0, 1])"),
       ErrorCode::scene, "/meters/m: error: a point has no area: its flux needs a quad, disc or sphere"},
      {"radiance from all sides", metered(R"("measures": "radiance", "at": [0, 0, 0], "normal": [0, 0, 1])"),
       ErrorCode::scene, "a meter of radiance needs an acceptance_deg, the half-angle of its cone"},
      {"cells of a disc",
       metered(R"("disc": {"center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1}, "cells": [2, 2])"),
       ErrorCode::scene, "/meters/m/cells: error: cells need a quad"},
      {"a meter nowhere", metered(""), ErrorCode::scene, "/meters/m: error: expected exactly one key"},
      {"a meter twice",
       metered(
           R"("at": [0, 0, 0], "normal": [0, 0, 1], "quad": {"corner": [0, 0, 0], "edge_u": [1, 0, 0], "edge_v": [0, 1, 0]})"),
       ErrorCode::scene, "/meters/m: error: expected exactly one key (got at, quad"},
      {"a meter without a normal", metered(R"("at": [0, 0, 0])"), ErrorCode::scene,
       "/meters/m: error: missing key \"normal\""},
      {"a moving meter",
       R"({"camera": {"irradiance_probe": {"at": [0, 0, 0], "normal": [0, 0, 1]},
           "motion": {"keyframes": [{"time_s": 0}, {"time_s": 1, "translate": [1, 0, 0]}]}}})",
       ErrorCode::scene, "an irradiance probe cannot move"},
  };
  expect_refused(faults);
}

TEST_F(MeterFaultsTest, AConeMayBeAllOfASide) {
  for (const char* measures : {"radiance", "intensity"})
    EXPECT_TRUE(
        load(metered(fmt::format(R"("measures": "{}", "acceptance_deg": 90, "disc": {{"center": [0, 0, 0],
          "normal": [0, 0, 1], "radius": 1}})",
                                 measures)))
            .scene)
        << measures;
}

}  // namespace
}  // namespace abbe
