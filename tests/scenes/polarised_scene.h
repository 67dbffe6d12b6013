#pragma once

#include <cmath>
#include <string>

#include <fmt/format.h>

#include "tests/scenes/scene_fixture.h"

namespace abbe::test {

inline std::string text_of(const Imath::V3d& v) {
  return fmt::format("[{}, {}, {}]", v.x, v.y, v.z);
}

/// A square of that half side around a point, facing along `normal`.
inline std::string square(const Imath::V3d& center, const Imath::V3d& normal, double half) {
  const Imath::V3d u =
      normal.cross(std::abs(normal.y) < 0.9 ? Imath::V3d(0, 1, 0) : Imath::V3d(1, 0, 0)).normalized() * half;
  const Imath::V3d v = normal.cross(u);
  return fmt::format(R"({{"corner": {}, "edge_u": {}, "edge_v": {}}})", text_of(center - u - v),
                     text_of(u * 2.0), text_of(v * 2.0));
}

/// The mean of a channel over the whole film.
inline double mean_of(const Film& film, int channel = 0) {
  return whole(film, channel).mean;
}

/// The Stokes vector of a film of X, Y and Z with `stokes`: that of Y.
struct StokesMean {
  double i, q, u, v;
};
inline StokesMean stokes_of(const Film& film) {
  return {mean_of(film, 1), mean_of(film, 4), mean_of(film, 7), mean_of(film, 10)};
}

}  // namespace abbe::test
