#pragma once

#include <string>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/scenes.h"

namespace abbe::test {

/// Renders a scene file.
inline Outcome run_render(const std::string& scene, const std::string& output,
                          const std::string& options = "") {
  return abbe("render " + scene + " --quiet -o " + output + " " + options);
}

/// File of a render that succeeds.
inline std::string rendered_file(const std::string& scene, const std::string& path,
                                 const std::string& options) {
  const Outcome run = run_render(scene, path, options);
  EXPECT_EQ(run.code, 0) << run.err;
  return path;
}
inline std::string film_of(const std::string& scene, const std::string& name,
                           const std::string& options = "") {
  return rendered_file(scene, file(name + ".exr"), options);
}
/// Partial film of a scene with these options.
inline std::string part_of(const std::string& scene, const std::string& name, const std::string& options) {
  return rendered_file(scene, file(name + ".abbepart"), options);
}

inline Outcome merged(const std::string& parts, const std::string& output) {
  return abbe("merge " + parts + " -o " + output);
}

/// Answer of `develop --json`, which must succeed.
inline nlohmann::json developed(const std::string& arguments, int code = 0) {
  const Outcome run = abbe("develop " + arguments + " --json");
  EXPECT_EQ(run.code, code) << arguments << '\n' << run.err;
  return run.code == 0 ? run.json() : nlohmann::json();
}

}  // namespace abbe::test
