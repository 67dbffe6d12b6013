#pragma once

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "calibration/chart/patches.h"
#include "calibration/fit/correction.h"
#include "io/error.h"
#include "spectral/library.h"
#include "tests/spectral/illuminant.h"

namespace abbe::test {

inline Chart chart(const std::string& name = "colorchecker24_babelcolor_average") {
  Diagnostics diagnostics;
  auto loaded = load_chart(name, {}, diagnostics);
  EXPECT_TRUE(loaded.has_value()) << diagnostics.text();
  return loaded.value_or(Chart{});
}

inline std::vector<Channel> camera(const std::string& name = "Nikon_D5100") {
  Diagnostics diagnostics;
  auto loaded = load_camera(name, {}, diagnostics);
  EXPECT_TRUE(loaded.has_value()) << diagnostics.text();
  return loaded.value_or(std::vector<Channel>{});
}

/// Values of the chart's patches in a light for the Nikon D5100.
inline PatchColors nikon(const std::string& light) {
  return integrate(chart(), camera(), illuminant(light));
}

/// A root polynomial with all six terms, to be planted and exported.
inline const ColorCorrection kRootPolynomial{CorrectionModel::root_polynomial_2,
                                             {{0.5, 0.2, 0.05},
                                              {0.1, 0.6, -0.1},
                                              {0.1, -0.1, 0.9},
                                              {0.15, 0.25, -0.05},
                                              {0.05, 0.1, 0.05},
                                              {0.05, -0.05, 0.25}}};

inline void expect_near(const std::array<double, 3>& a, const std::array<double, 3>& b, double margin) {
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(a[k], b[k], margin) << testing::PrintToString(a) << " and " << testing::PrintToString(b);
}

/// Expects `f` to throw an Error with this code and with this text in its message.
template <typename F>
void expect_error(const F& f, ErrorCode code, const std::string& text) {
  try {
    f();
    ADD_FAILURE() << "nothing thrown; expected: " << text;
  } catch (const Error& e) {
    EXPECT_EQ(e.code, code);
    EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
  }
}

}  // namespace abbe::test
