#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/image.h"
#include "sensor/film/relative_error.h"
#include "spectral/colorimetry.h"

namespace abbe {

/// Formulas of colour difference, as `calibration/chart/delta_e.h` and `calibration/judge/` have them.
enum class DeltaE { cie2000, cie94, cie76, cam16_ucs, itp };
/// Colour difference by one of the formulas; `standard` is the reference of the one that is not symmetric.
/// For CAM16-UCS and ITP the colours are relative to a white D65: for the one seen as surfaces in a booth
/// (`ViewingConditions`), for the other shown with a white of `kReferenceWhite`.
/// NaN where a colour is not finite.
[[nodiscard]] double delta_e(DeltaE formula, const Lab& standard, const Lab& sample);

/// Colour differences over the pixels of two images.
struct ColorDifference {
  double mean, p95, max;
  std::vector<double> pixels;
};

/// How far an image is from a reference, over their common channels of intensities.
struct Comparison {
  double rel_mse;                        ///< As `rel_mse` with its defaults.
  double rmse;                           ///< Root mean square of x - r.
  double mean_ratio;                     ///< Mean of x over mean of r.
  std::optional<ColorDifference> color;  ///< CIEDE2000.
};

/// Colours as by `color_difference`. Throws Error{input} for images of different size, without a common
/// channel, with one of which they tell different units, or with a value that is not finite.
[[nodiscard]] Comparison compare_images(const Image& image, const Image& reference,
                                        std::optional<Chromaticity> white = {});

/// The first common channel whose unit only one of the images tells, so that their values may be of
/// different ones; files of other renderers tell none.
[[nodiscard]] std::optional<std::string> channel_of_untold_unit(const Image& image, const Image& reference);

/// That channels are not compared since only one of the images has them, as a sentence with their names;
/// nothing where there are none. Variances, what films have beside their planes, and alpha do not count.
[[nodiscard]] std::optional<std::string> uncompared_channels(const Image& image, const Image& reference);

/// Colour differences of images with X, Y, Z or R, G, B, each read as `film_colors` has it: both scaled so
/// that the 99th percentile of the reference's Y is 100, and seen against a D65 white of Y = 100, to which
/// `white` is adapted: in images that tell a white the reference's or else the image's, or in both that which
/// is given. Nothing for images whose colours are not known, and for a black reference. Throws Error{input}
/// for a white given to a camera's film that tells none.
[[nodiscard]] std::optional<ColorDifference> color_difference(const Image& image, const Image& reference,
                                                              DeltaE formula = DeltaE::cie2000,
                                                              std::optional<Chromaticity> white = {});

/// XYZ of every pixel of such an image, in its own scale; nothing where its colours are not known. A camera's
/// are relative to D65 for its film's white, all others as they are.
[[nodiscard]] std::vector<XYZ> tristimuli(const Image& image);

/// The smallest value that at least a share `quantile` in (0, 1] of `values`, of which there is one or more,
/// does not exceed.
[[nodiscard]] double percentile(std::vector<double> values, double quantile);

/// The root, pixel by pixel, of what `rel_mse` with its defaults takes the mean of, over the channels. Throws
/// as `compare_images`.
[[nodiscard]] std::vector<double> relative_errors(const Image& image, const Image& reference);

/// What `rel_mse` takes the mean of.
struct ErrorMeasure {
  double relative = 1;             ///< Weight of r^2 in the denominator.
  double floor = kUsualFloor;      ///< Weight of m^2 there. A floor of 1 alone gives (RMSE/m)^2.
  double trim = 0;                 ///< Share of the values left out, those of the largest quotient.
  bool subtract_variance = false;  ///< Take `Variance.*` of the reference from the square: with independent
                                   ///< noise, what is left is unbiased, and may be negative.
};

/// Mean over pixels and common channels of ((x - r)^2 - v)/(relative r^2 + floor m^2), m the reference's mean
/// over all of them, v its variance or 0. Throws as `compare_images`, and Error{input} where a variance is
/// missing.
[[nodiscard]] double rel_mse(const Image& image, const Image& reference, const ErrorMeasure& measure = {});

}  // namespace abbe
