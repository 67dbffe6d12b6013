#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "sensor/film/relative_error.h"
#include "spectral/colorimetry.h"

namespace abbe {

/// Formulas of colour difference, implemented in `calibration/chart/delta_e.h` and `calibration/metrics/`.
enum class DeltaE { cie2000, cie94, cie76, cam16_ucs, itp };
/// Colour difference by one of the formulas. `standard` is the reference colour of CIE94, which is not
/// symmetric. NaN if a colour is not finite.
/// The formulas CAM16-UCS and ITP take colours relative to a D65 white. CAM16-UCS assumes surfaces in a booth
/// (the default `ViewingConditions`), ITP a display with a white of `kReferenceWhite`.
[[nodiscard]] double delta_e(DeltaE formula, const Lab& standard, const Lab& sample);

/// Colour differences over the pixels of two images.
struct ColorDifference {
  double mean, p95, max;
  std::vector<double> pixels;
};

/// Differences of an image x from a reference r over their common intensity channels.
struct Comparison {
  double rel_mse;                        ///< Result of `rel_mse` with default settings.
  double rmse;                           ///< Root mean square of x - r.
  double mean_ratio;                     ///< Mean of x divided by the mean of r.
  std::optional<ColorDifference> color;  ///< CIEDE2000.
};

/// Compares two images; `color_difference` computes the colours. Throws Error{input} if the images differ in
/// size, have no common channel, record different units for one, or contain a value that is not finite.
[[nodiscard]] Comparison compare_images(const Image& image, const Image& reference,
                                        std::optional<Chromaticity> white = {});

/// First common channel whose unit is recorded in only one of the images. Its values may have different
/// units; files of other renderers record none.
[[nodiscard]] std::optional<std::string> channel_with_undeclared_unit(const Image& image,
                                                                      const Image& reference);

/// Note that names the channels which only one of the images has and which are therefore not compared. Empty
/// if there is none. Variances, auxiliary films and alpha are ignored.
[[nodiscard]] std::optional<std::string> uncompared_channels(const Image& image, const Image& reference);

/// Colour differences of images with X, Y, Z or R, G, B, interpreted by `film_colors`.
/// Both images are scaled so that the 99th percentile of the reference's Y is 100, and viewed against a D65
/// white of Y = 100. An image that records a white is adapted to D65 from the reference's recorded white, or
/// from that of the image. A given `white` replaces both.
/// Empty for images of unknown colours and for a black reference. Throws Error{input} if a `white` is given
/// for a camera film that records none.
[[nodiscard]] std::optional<ColorDifference> color_difference(const Image& image, const Image& reference,
                                                              DeltaE formula = DeltaE::cie2000,
                                                              std::optional<Chromaticity> white = {});

/// XYZ of every pixel in the scale of the image; empty if its colours are unknown. XYZ of a camera film are
/// adapted from its white to D65, others are not.
[[nodiscard]] std::vector<XYZ> tristimuli(const Image& image);

/// Smallest of `values` that is not less than a fraction `quantile` in (0, 1] of them. There must be at least
/// one value.
[[nodiscard]] double percentile(std::vector<double> values, double quantile);

/// Relative error of each pixel: the square root of the mean over channels of the terms of `rel_mse` with
/// default settings. Throws the errors of `compare_images`.
[[nodiscard]] std::vector<double> relative_errors(const Image& image, const Image& reference);

/// Terms that `rel_mse` averages.
struct ErrorMeasure {
  double relative = 1;  ///< Weight of r^2 in the denominator.
  /// Weight of m^2 in the denominator. With a floor of 1 alone the result is (RMSE/m)^2.
  double floor = kUsualFloor;
  double trim =
      0;  ///< Fraction of the values that is omitted, those with the largest (x - r)^2 per denominator.
  /// Subtract `Variance.*` of the reference from the squared differences. The result is unbiased for
  /// independent noise and may be negative.
  bool subtract_variance = false;
};

/// Mean over pixels and common channels of ((x - r)^2 - v)/(relative r^2 + floor m^2). Here m is the mean of
/// the reference over all of them, and v its variance or 0. Throws the errors of `compare_images`, and
/// Error{input} if a required variance is missing.
[[nodiscard]] double rel_mse(const Image& image, const Image& reference, const ErrorMeasure& measure = {});

}  // namespace abbe
