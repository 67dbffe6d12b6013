#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"
#include "sensor/film/crop.h"
#include "sensor/film/relative_error.h"
#include "spectral/colorimetry.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Pixels that both films contain, by the crops and areas that they record, as disjoint rectangles. A film
/// without a valid record contains all its pixels. Throws Error{input} for films of different size and for
/// films without a common pixel.
[[nodiscard]] std::vector<Crop> common_areas(const Image& image, const Image& reference);

/// Image of the pixels inside one or more `areas`, with the metadata of `image` except its crop and areas. A
/// single rectangle retains its shape; the pixels of several become one row, area by area.
[[nodiscard]] Image extract_areas(const Image& image, std::span<const Crop> areas);

/// Interpretation of an image's colours.
struct FilmColors {
  std::vector<std::string> channels;  ///< Names of the three channels; the image may lack some.
  /// Matrix from the channels, in their order, to XYZ in the scale of the image; nothing if the colours are
  /// unknown.
  std::optional<Matrix3> to_xyz;
  bool adapted = false;  ///< True if XYZ are adapted from the film's white to D65.
  /// White that the image records, else the white of its recorded primaries. Nothing if it records neither.
  std::optional<Chromaticity> white;
};

/// Interpretation of the channels of an image:
/// - X, Y, Z are tristimulus values, unless `channel.X` records another quantity than a photometric one.
/// - R, G, B with the attribute `channel.R`, and such other X, Y, Z, are sensor channels. The film's matrix
///   `to_xyz_d65` applies, in the order of `sensor_channels`, or of `mosaic_channels` under a mosaic. Without
///   a readable matrix the colours are unknown.
/// - R, G, B of any other image are linear, with the primaries that it records (`recorded_primaries`) or
///   those of Rec.709.
/// Throws Error{input} if the recorded white is malformed.
[[nodiscard]] FilmColors film_colors(const Image& image);

enum class DeltaE { cie2000, cie94, cie76, cam16_ucs, itp };
/// Colour difference by one of the formulas; NaN if a component of a colour is not finite. `standard` is the
/// reference of CIE94, which is not symmetric. L*a*b* are relative to D65. CAM16-UCS assumes surfaces in a
/// booth (the default `ViewingConditions`), ITP a display with a white of `kReferenceWhite` cd/m^2.
[[nodiscard]] double delta_e(DeltaE formula, const Lab& standard, const Lab& sample);

/// Colour differences over the pixels of two images.
struct ColorDifference {
  double mean, p95, max;       ///< Mean, 95th percentile (`percentile`) and maximum over the pixels.
  std::vector<double> pixels;  ///< Difference of each pixel, row by row.
};

/// Differences of an image x from a reference r over the planes of `plane_names` that both have, without the
/// Stokes components Q, U and V.
struct Comparison {
  double rel_mse;     ///< `rel_mse` with default settings.
  double rmse;        ///< Root mean square of x - r, in the unit of the channels.
  double mean_ratio;  ///< Mean of x divided by the mean of r; not finite if the latter is 0.
  std::optional<ColorDifference> color;  ///< CIEDE2000 by `color_difference`.
};

/// `white` [x, y] is that of `color_difference`. Throws Error{input} if the images differ in size, have no
/// common channel, record different units for one, or contain a value that is not finite. Also throws the
/// errors of `plane_names` and `color_difference`.
[[nodiscard]] Comparison compare_images(const Image& image, const Image& reference,
                                        std::optional<Chromaticity> white = {});

/// First common channel whose unit only one of the images records; files of other renderers record none.
[[nodiscard]] std::optional<std::string> channel_with_undeclared_unit(const Image& image,
                                                                      const Image& reference);

/// Note that names the channels which only one of the images has; nothing if there is none. Variances,
/// auxiliary films and alpha are ignored.
[[nodiscard]] std::optional<std::string> uncompared_channels(const Image& image, const Image& reference);

/// Colour differences of two images of equal size with X, Y, Z or R, G, B, interpreted by `film_colors`.
/// One factor scales both images so that the 99th percentile of the reference's Y is 100. They are viewed
/// against a D65 white of Y = 100. An image that records a white is adapted to D65 from the reference's
/// recorded white, or from its own if the reference records none. A given `white` [x, y] replaces the
/// recorded ones, and images without a record are adapted too.
/// Nothing for images of unknown colours, if only one image has X, Y, Z, and if the 99th percentile is not
/// positive. Throws Error{input} if a `white` is given for a camera film that records none, and the errors of
/// `film_colors`.
[[nodiscard]] std::optional<ColorDifference> color_difference(const Image& image, const Image& reference,
                                                              DeltaE formula = DeltaE::cie2000,
                                                              std::optional<Chromaticity> white = {});

/// XYZ of every pixel, row by row, in the scale of the image; empty if its colours are unknown. XYZ of a
/// camera film are adapted from its white to D65, others are not. Throws the errors of `film_colors`.
[[nodiscard]] std::vector<XYZ> tristimuli(const Image& image);

/// Smallest of one or more `values` that is not less than a fraction `quantile` in (0, 1] of them.
[[nodiscard]] double percentile(std::vector<double> values, double quantile);

/// Relative error of each pixel, row by row: the square root of the mean over channels of the terms of
/// `rel_mse` with default settings. Throws Error{input} as `compare_images` does.
[[nodiscard]] std::vector<double> relative_errors(const Image& image, const Image& reference);

/// Terms of `rel_mse`.
struct ErrorMeasure {
  double relative = 1;  ///< Weight of r^2 in the denominator.
  /// Weight of m^2 in the denominator. With `relative` 0 and a floor of 1 the result is (RMSE/m)^2.
  double floor = kUsualFloor;
  /// Fraction of the values in [0, 1) that is omitted: those with the largest (x - r)^2 per denominator. The
  /// number of omitted values is rounded down.
  double trim = 0;
  /// Subtract `Variance.*` of the reference from the squared differences, which removes the bias of its
  /// noise.
  bool subtract_variance = false;
};

/// Mean over pixels and common channels of ((x - r)^2 - v)/(relative r^2 + floor m^2). Here m is the mean of
/// the reference over all of them, and v its variance or 0. A numerator of 0 counts 0 even if the denominator
/// is 0. Throws Error{input} as `compare_images` does, and if a required variance is missing or not finite.
[[nodiscard]] double rel_mse(const Image& image, const Image& reference, const ErrorMeasure& measure = {});

/// Difference in polarisation of two films over the pixels of their common channels. Degrees are compared
/// where the reference's degree of polarisation exceeds `kPolarised`, angles where its degree of linear
/// polarisation does. Means and maxima are 0 if nothing is compared.
struct PolarisationDifference {
  double polarised_fraction = 0;  ///< Fraction of the pixels of all channels whose degrees are compared.
  double degree_mean = 0;         ///< Mean of |degree - reference degree|.
  double degree_max = 0;
  double angle_deg_mean = 0;  ///< Mean angle between the planes of vibration, in [0, 90].
  double angle_deg_max = 0;
};
/// Degree of polarisation above which a pixel of the reference counts as polarised.
inline constexpr double kPolarised = 0.05;

/// Polarisation difference of two films of the same size, which is not checked. Nothing unless both record
/// Stokes components of a common channel. Throws the errors of `stokes_planes`.
[[nodiscard]] std::optional<PolarisationDifference> polarisation_difference(const Image& image,
                                                                            const Image& reference);

}  // namespace abbe
