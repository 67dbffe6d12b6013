#pragma once

#include <optional>

#include "io/image.h"

namespace abbe {

/// CIEDE2000 over the pixels of two images.
struct ColorDifference {
  double mean, p95, max;
};

/// How far an image is from a reference, over their common channels except `Variance.*`.
struct Comparison {
  double rel_mse;     ///< As `rel_mse` with its defaults.
  double rmse;        ///< Root mean square of x - r.
  double mean_ratio;  ///< Mean of x over mean of r.
  std::optional<ColorDifference> color;
};

/// Throws Error{input} for images of different size, without a common channel, or with a value that is not
/// finite.
[[nodiscard]] Comparison compare_images(const Image& image, const Image& reference);

/// For images with X, Y, Z (the observer), or R, G, B taken as linear sRGB: both scaled so that the 99th
/// percentile of the reference's Y is 100, and seen against a D65 white of Y = 100. Nothing for other images,
/// and for a black reference.
[[nodiscard]] std::optional<ColorDifference> color_difference(const Image& image, const Image& reference);

/// What `rel_mse` takes the mean of.
struct ErrorMeasure {
  double relative = 1;             ///< Weight of r^2 in the denominator.
  double floor = 0.01;             ///< Weight of m^2 there. A floor of 1 alone gives (RMSE/m)^2.
  double trim = 0;                 ///< Share of the values left out, those of the largest quotient.
  bool subtract_variance = false;  ///< Take `Variance.*` of the reference from the square: with independent
                                   ///< noise, what is left is unbiased, and may be negative.
};

/// Mean over pixels and common channels of ((x - r)^2 - v)/(relative r^2 + floor m^2), m the reference's mean
/// over all of them, v its variance or 0. Throws as `compare_images`, and Error{input} where a variance is
/// missing.
[[nodiscard]] double rel_mse(const Image& image, const Image& reference, const ErrorMeasure& measure = {});

}  // namespace abbe
