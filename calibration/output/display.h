#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/chart/matrix3.h"
#include "calibration/fit/matrix.h"
#include "io/image.h"
#include "sensor/response/channel.h"
#include "spectral/curve.h"

namespace abbe {

/// A film made fit for a display.
struct DisplayPicture {
  Image image;       ///< Channels R, G, B (or Y for a film of one channel): sRGB code values in [0, 1].
  double scale = 1;  ///< What the film values were multiplied by.
  double clipped_share = 0;  ///< Share of pixels with a code value outside [0, 1] before clipping.
};

/// From the linear values of one sensor to the code values of an sRGB display, through OpenColorIO.
class DisplayTransform {
 public:
  /// `channels` names the film channels in order, one or three of them; `to_xyz_d65` takes their values to
  /// XYZ relative to D65. For one channel only its first column counts. Throws Error{usage} for another
  /// number of channels.
  DisplayTransform(std::vector<std::string> channels, const Matrix3& to_xyz_d65,
                   std::optional<MatrixFit> fit = {});

  /// Multiplies by `scale`, or else by the automatic one, and applies the configuration; only the result is
  /// clipped, to [0, 1], so negative film values and colours outside the display's gamut pass through all
  /// linear steps. A pixel that is not a number becomes black and counts as clipped. Throws Error{input} when
  /// the film lacks a channel.
  [[nodiscard]] DisplayPicture operator()(const Image& film, std::optional<double> scale = {}) const;

  /// The scale that brings the 99th percentile of luminance over all pixels to 1; where that is not positive,
  /// the brightest pixel; 1 for a film without any light.
  [[nodiscard]] double automatic_scale(const Image& film) const;

  /// Film values to XYZ relative to D65.
  [[nodiscard]] const Matrix3& to_xyz_d65() const { return to_xyz_d65_; }
  /// How the matrix was fitted; nothing where it follows from the channels themselves.
  [[nodiscard]] const std::optional<MatrixFit>& fit() const { return fit_; }

 private:
  struct Processor;
  std::vector<std::string> channels_;
  Matrix3 to_xyz_d65_;
  std::optional<MatrixFit> fit_;
  std::shared_ptr<const Processor> processor_;
};

/// The display transform of a sensor in the light of a scene. Three channels named X, Y, Z are the observer:
/// only the light's white is adapted to D65 (Bradford). Other three channels are white balanced on the light
/// and corrected by the white-preserving matrix fitted on the ColorChecker (BabelColor average) in that
/// light, then adapted; luminance is in units of the second channel's value of a neutral. One channel is
/// shown as grey. Throws Error{usage} for another number, Error{input} when the light or the channels do not
/// determine the colours.
[[nodiscard]] DisplayTransform make_display(const std::vector<Channel>& channels, const Curve& illuminant);

}  // namespace abbe
