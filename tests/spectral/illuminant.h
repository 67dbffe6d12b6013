#pragma once

#include <gtest/gtest.h>

#include <string>

#include "spectral/library.h"

namespace abbe::test {

/// Loads an illuminant by name, which must exist.
inline Curve illuminant(const std::string& name) {
  Diagnostics diagnostics;
  const auto curve = load_illuminant(name, {}, diagnostics);
  EXPECT_TRUE(curve.has_value()) << diagnostics.text();
  return curve ? curve->curve : Curve();
}

}  // namespace abbe::test
