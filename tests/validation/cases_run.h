#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "validation/cases/case.h"

namespace abbe {

inline void PrintTo(const Case& item, std::ostream* out) {
  *out << item.id << ": " << item.title;
}

namespace test {

/// The cases that are measured by one of the methods.
template <typename... Methods>
std::vector<Case> cases_by() {
  std::vector<Case> chosen;
  std::copy_if(all_cases().begin(), all_cases().end(), std::back_inserter(chosen),
               [](const Case& item) { return (std::holds_alternative<Methods>(item.method) || ...); });
  return chosen;
}

/// Runs a case and expects it to pass. Skips a case whose integrator cannot sample its light. `result`
/// receives the measurement.
inline void expect_passes(const Case& item, const CaseSettings& settings, CaseResult& result) {
  result = run_case(item, settings);
  if (!result.measured()) GTEST_SKIP() << result.unsampled.front();
  ASSERT_FALSE(result.figures.empty());
  const Figure& worst = result.figures[result.worst];
  const std::string line =
      fmt::format("{} {}: {} figures, worst {} {:.10g} against {:.10g} +- {:.2g} ({} samples, {:.1f} CPU s)",
                  item.id, item.title, result.figures.size(), worst.what, worst.measured.mean,
                  worst.reference, worst.measured.standard_error, result.samples, result.cpu_s);
  fmt::print("{}\n", line);
  EXPECT_TRUE(result.passed()) << line << "; margin " << result.allowed(worst) << ", " << item.source;
  for (const Figure& figure : result.figures)
    if (!result.passed() && std::abs(figure.deviation()) > result.allowed(figure))
      ADD_FAILURE() << fmt::format("{}: {:.10g} against {:.10g}", figure.what, figure.measured.mean,
                                   figure.reference);
}

inline void expect_passes(const Case& item, const CaseSettings& settings) {
  CaseResult result{};
  expect_passes(item, settings, result);
}

/// Name of a case in the characters that GoogleTest allows.
inline std::string case_name(const testing::TestParamInfo<Case>& info) {
  std::string name = info.param.id;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

}  // namespace test
}  // namespace abbe
