#pragma once

#include "tests/scenes/only_meter.h"
#include "validation/statistics.h"

namespace abbe::test {

/// Expects a reading by equivalence, and where hardly anything is left to chance, to what sums by hand are
/// good for.
inline void expect_equal(const Film::Average& value, double expected, double margin = 0.01) {
  if (value.standard_error < 1e-5 * expected)
    EXPECT_NEAR(value.mean / expected, 1, 1e-4);
  else
    EXPECT_EQ(equivalence({value.mean, value.standard_error}, expected, margin), Verdict::pass)
        << value.mean << " +- " << value.standard_error << " for " << expected;
}

}  // namespace abbe::test
