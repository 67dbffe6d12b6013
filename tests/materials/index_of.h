#pragma once

#include <gtest/gtest.h>

#include <string>

#include "materials/index/library.h"

namespace abbe {

/// The refractive index of that name, which must load without errors.
inline RefractiveIndex index_of(const std::string& name) {
  Diagnostics diagnostics;
  const auto named = load_index(name, {}, diagnostics);
  EXPECT_TRUE(named && diagnostics.all().empty()) << name << ": " << diagnostics.text();
  return named ? named->index : RefractiveIndex(1.0);
}

}  // namespace abbe
