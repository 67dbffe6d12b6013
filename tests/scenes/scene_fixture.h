#pragma once

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "description/load.h"
#include "io/data_directory.h"
#include "transport/render/render.h"

namespace abbe::test {

inline Scene load_file(const std::filesystem::path& path, const std::vector<Override>& settings) {
  Diagnostics diagnostics;
  std::optional<Scene> scene = load_scene(path, settings, diagnostics);
  if (!scene) throw Error(ErrorCode::internal, path.string(), diagnostics.text());
  return std::move(*scene);
}

/// A scene of `data/scenes` with some settings replaced.
inline Scene load(const std::string& name, const std::vector<Override>& settings = {}) {
  return load_file(data_directory() / "scenes" / name, settings);
}

/// A scene as written, with some settings replaced.
inline Scene load_text(const std::string& text, const std::vector<Override>& settings = {}) {
  const std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("abbe_scene_" + std::to_string(::getpid()) + ".json");
  std::ofstream(path) << text;
  Scene scene = load_file(path, settings);
  std::filesystem::remove(path);
  return scene;
}

/// Mean of a channel over pixels [x0, x1) x [y0, y1), and the variance of that mean.
struct Region {
  double mean = 0;
  double variance = 0;
};
inline Region region(const Film& film, int channel, int x0, int y0, int x1, int y1) {
  Region sum;
  for (int y = y0; y < y1; ++y)
    for (int x = x0; x < x1; ++x) {
      const auto pixel = static_cast<std::size_t>(y * film.width() + x);
      sum.mean += film.mean(pixel, channel);
      sum.variance += film.variance(pixel, channel);
    }
  const double n = static_cast<double>(x1 - x0) * (y1 - y0);
  return {sum.mean / n, sum.variance / (n * n)};
}

/// Over the whole film.
inline Region whole(const Film& film, int channel = 0) {
  return region(film, channel, 0, 0, film.width(), film.height());
}

/// Of `Comparison::largest_z`: family significance 1e-6 over 3 channels x 16 regions by Sidak's correction.
inline constexpr double kLargestZ = 5.6;

/// Statistic of the difference of two independent films over a grid of regions: the largest |z|, and the mean
/// ratio b/a.
struct Comparison {
  double largest_z = 0;
  double ratio = 0;
};
inline Comparison compare_regions(const Film& a, const Film& b, int grid) {
  Comparison result;
  double total_a = 0;
  double total_b = 0;
  for (int channel = 0; channel < a.channels(); ++channel)
    for (int j = 0; j < grid; ++j)
      for (int i = 0; i < grid; ++i) {
        const int x0 = i * a.width() / grid;
        const int x1 = (i + 1) * a.width() / grid;
        const int y0 = j * a.height() / grid;
        const int y1 = (j + 1) * a.height() / grid;
        const Region ra = region(a, channel, x0, y0, x1, y1);
        const Region rb = region(b, channel, x0, y0, x1, y1);
        total_a += ra.mean;
        total_b += rb.mean;
        const double deviation = std::sqrt(ra.variance + rb.variance);
        if (deviation > 0)
          result.largest_z = std::max(result.largest_z, std::abs(ra.mean - rb.mean) / deviation);
      }
  result.ratio = total_b / total_a;
  return result;
}

/// Expects that two renders of a scene agree over a grid of regions: one by camera paths alone, one with
/// photons for every light.
inline void expect_same_from_either_end(const std::string& text) {
  const auto rendered = [&text](const char* integrator, int samples) {
    Scene scene =
        load_text(text, {{"/render/integrator", integrator}, {"/render/samples", std::to_string(samples)}});
    scene.features.light_tracing = true;
    scene.features.light_is_traced.assign(scene.lights.size(), true);
    return render(scene, {}).film;
  };
  const Comparison c = compare_regions(rendered("path", 1024), rendered("auto", 512), 4);
  std::printf("largest z %.2f, ratio of the means %.5f\n", c.largest_z, c.ratio);
  EXPECT_LT(c.largest_z, 5.5);  // 1e-6 over 2 channels x 16 regions
  EXPECT_NEAR(c.ratio, 1, 0.01);
}

}  // namespace abbe::test
