#pragma once

#include <filesystem>
#include <optional>

#include "io/image.h"

namespace abbe::cli {

/// CIEDE2000 over the pixels of two images.
struct ColorDifference {
  double mean, p95, max;
};

/// How far an image is from a reference, over their common channels except `Variance.*`.
struct Comparison {
  double
      rel_mse;  ///< Mean of (x - r)^2/(r^2 + 0.01 m^2), m the reference's mean over all pixels and channels.
  double rmse;  ///< Root mean square of x - r.
  double mean_ratio;  ///< Mean of x over mean of r.
  /// For images with X, Y, Z (the observer), or R, G, B taken as linear sRGB: both scaled so that the 99th
  /// percentile of the reference's Y is 100, and seen against a D65 white of Y = 100.
  std::optional<ColorDifference> color;
};

/// Throws Error{input} for images of different size, without a common channel, or with a value that is not
/// finite.
[[nodiscard]] Comparison compare_images(const Image& image, const Image& reference);

/// What `abbe compare` was asked for.
struct CompareOptions {
  std::filesystem::path image;
  std::filesystem::path reference;
  bool json = false;
};

/// Compares two EXR files and prints the figures. Returns the exit code.
int compare(const CompareOptions& options);

}  // namespace abbe::cli
