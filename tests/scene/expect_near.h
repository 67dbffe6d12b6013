#pragma once

#include <gtest/gtest.h>

namespace abbe::test {

/// Expects two vectors of two or three dimensions to be near.
template <typename V>
void expect_near(const V& a, const V& b, double tolerance) {
  EXPECT_LE(static_cast<double>((a - b).length()), tolerance) << a << " and " << b;
}

}  // namespace abbe::test
