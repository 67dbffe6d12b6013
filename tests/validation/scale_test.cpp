#include "validation/bench/scale.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "tests/validation/bench_runs.h"

namespace abbe {
namespace {

using test::BenchFolder;

TEST(Scale, GrowthIsThePowerOfTheCount) {
  const ScaleRow before{"shapes", 10, 2.0, 1.0, 1.0, 100.0, 8.0};
  const ScaleRow after{"shapes", 1000, 200.0, 1.0, 1e4, 100.0, 0.8};
  EXPECT_NEAR(growth(before, after, &ScaleRow::load_cpu_s), 1, 1e-12);
  EXPECT_NEAR(growth(before, after, &ScaleRow::build_cpu_s), 0, 1e-12);
  EXPECT_NEAR(growth(before, after, &ScaleRow::plan_cpu_s), 2, 1e-12);
  EXPECT_NEAR(growth(before, after, &ScaleRow::rays_per_cpu_s), -0.5, 1e-12);
}

TEST(Scale, EverySubjectIsMeasured) {
  const BenchFolder folder;
  const std::vector<ScaleRow> rows = measure_scale(folder.path(), 1, true);
  std::set<std::string> subjects;
  for (const ScaleRow& row : rows) {
    subjects.insert(row.subject);
    EXPECT_GT(row.load_cpu_s, 0) << row.subject;
    EXPECT_LE(row.build_cpu_s, row.load_cpu_s + 0.1) << row.subject;
    EXPECT_GT(row.bytes, 0) << row.subject;
    EXPECT_GT(row.rays_per_cpu_s, 1e4) << row.subject;
  }
  EXPECT_EQ(subjects, (std::set<std::string>{"triangles", "shapes", "instances", "lights", "channels"}));
  EXPECT_EQ(rows.size(), 10U);
  // An instance costs a transform, not another mesh of 8000 triangles.
  for (const ScaleRow& row : rows) {
    if (row.subject == "instances" && row.count == 100) {
      EXPECT_LT(row.bytes, 8000 * 40 / 10);
    }
  }
  EXPECT_NE(readable_text(rows).find("instances"), std::string::npos);
}

}  // namespace
}  // namespace abbe
