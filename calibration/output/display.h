#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/fit/correction_fit.h"
#include "calibration/output/color_spaces.h"
#include "io/image.h"
#include "sensor/response/channel.h"
#include "spectral/curve.h"
#include "spectral/matrix3.h"

namespace abbe {

/// The attribute of films and pictures with the film value that is shown as white.
inline constexpr const char* kDisplayExposureKey = "display_exposure";

/// A film made fit for a display.
struct DisplayPicture {
  /// Channels R, G, B (or Y for a film of one channel): code values in [0, 1]. Its attributes `kColorSpace`
  /// and `kPrimariesKey` tell how Abbe's own displays read them; those of a user's configuration it does not
  /// know. `kDisplayExposureKey` is 1/scale to seven digits, those of a float.
  Image image;
  Image outside;             ///< Channel Y: 1 where the colour lay outside the gamut, 0 elsewhere.
  double scale = 1;          ///< What the film values were multiplied by.
  double outside_share = 0;  ///< Share of pixels whose colour lay outside the gamut, whatever its brightness.
  double clipped_share = 0;  ///< Share of pixels that were too bright for the display, or not numbers.
};

/// Through which view a film is shown. Empty: Abbe's own configuration, its first display and that one's
/// first view.
struct ViewOptions {
  std::filesystem::path config;  ///< A user's OpenColorIO configuration.
  std::string display;
  std::string view;
};

/// The configuration that $OCIO names; empty when it names none.
[[nodiscard]] std::filesystem::path users_configuration();

/// The views of the display that the options choose, theirs first. Throws Error{usage} for an unknown display
/// or view, Error{input} for a configuration that cannot be read.
[[nodiscard]] std::vector<std::string> view_names(const ViewOptions& options);

/// Takes the linear values of one sensor to the code values of a display, through OpenColorIO.
class DisplayTransform {
 public:
  /// `channels` names the film channels in order, one or three of them; `to_xyz_d65` takes their values to
  /// XYZ relative to D65. For one channel only its first column counts. A user's configuration is given
  /// ACES2065-1: it needs the role `aces_interchange`, or that space by name. Throws Error{usage} for another
  /// number of channels and for an unknown display or view, Error{input} for a configuration that cannot be
  /// used.
  DisplayTransform(std::vector<std::string> channels, const Matrix3& to_xyz_d65,
                   std::optional<CorrectionFit> fit = {}, const ViewOptions& options = {});

  /// Multiplies by `scale`, or else by the automatic one; brings every colour into the gamut (`map_into`):
  /// that of the display for the plain view, AP1 without an upper end for any other, which does its own tone
  /// mapping; then applies the view. Only what still exceeds code values of [0, 1] is clipped. A pixel that
  /// is not a number becomes black and counts as clipped. Throws Error{input} when the film lacks a channel.
  [[nodiscard]] DisplayPicture operator()(const Image& film, std::optional<double> scale = {}) const;

  /// The scale that brings the 99th percentile, over the pixels that the film has (`recorded_areas`), of the
  /// brightest primary of Rec.709 to 1, colours having been brought into its gamut; where that is not
  /// positive, the brightest pixel; 1 for a film without any light. No display or view changes it.
  [[nodiscard]] double automatic_scale(const Image& film) const;

  /// Film values to XYZ relative to D65.
  [[nodiscard]] const Matrix3& to_xyz_d65() const { return to_xyz_d65_; }
  /// The user's configuration and the tables of it that are used; none of Abbe's own.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }
  /// How the matrix was fitted; nothing where it follows from the channels themselves.
  [[nodiscard]] const std::optional<CorrectionFit>& fit() const { return fit_; }

 private:
  struct Processor;
  std::vector<std::string> channels_;
  Matrix3 to_xyz_d65_;
  std::optional<CorrectionFit> fit_;
  std::vector<std::filesystem::path> files_;
  std::shared_ptr<const Processor> processor_;
};

/// Adaptation of a white to D65 (Bradford); none for one of spectral lines or of no light that is seen, to
/// whose colour no eye adapts: it is shown as it looks beside daylight.
[[nodiscard]] Matrix3 white_adaptation(const Chromaticity& white);

/// The display transform of a sensor in a light. Three channels named X, Y, Z are the observer: only the
/// white is adapted to D65 (Bradford). Other three channels are white balanced on the light and corrected by
/// the white-preserving matrix fitted on the ColorChecker (BabelColor average) in that light; then the white,
/// which is the light's unless another is given, is adapted. Luminance is in units of the second channel's
/// value of a neutral. One channel is shown as grey. Throws Error{usage} for another number, and for
/// channels that in the light do not determine colours.
[[nodiscard]] DisplayTransform make_display(const std::vector<Channel>& channels, const Curve& illuminant,
                                            const ViewOptions& options = {},
                                            std::optional<Chromaticity> white = {});

}  // namespace abbe
