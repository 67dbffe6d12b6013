#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/output/color_spaces.h"
#include "io/image.h"
#include "sensor/response/channel.h"
#include "spectral/colorimetry.h"
#include "spectral/curve.h"
#include "spectral/matrix3.h"

namespace abbe {

/// Attribute of films and pictures with the film value that is displayed as white.
inline constexpr const char* kDisplayExposureKey = "display_exposure";

/// A film converted for a display.
struct DisplayPicture {
  /// Channels R, G, B (or Y for a film of one channel) with code values in [0, 1]. The attributes
  /// `kColorSpace` and `kPrimariesKey` describe the codes of Abbe's own displays; the codes of a user's
  /// configuration are unknown. `kDisplayExposureKey` is 1/scale to seven digits, those of a float. Without
  /// pixels if the film has none.
  Image image;
  Image outside;  ///< Channel Y: 1 if the colour was outside the gamut, else 0.
  /// Factor applied to the film values; its inverse is the film value displayed as white.
  double scale = 1;
  /// Fraction of the recorded pixels whose colour was outside the gamut, whatever its brightness.
  double outside_fraction = 0;
  /// Fraction of the recorded pixels that were too bright for the display, or not a number.
  double clipped_fraction = 0;
};

/// OpenColorIO view through which a film is displayed. Empty members select Abbe's own configuration, its
/// first display and the first view of the display.
struct ViewOptions {
  /// A user's OpenColorIO configuration, or a name such as "ocio://default".
  std::filesystem::path config;
  std::string display;  ///< Name of a display in the configuration.
  std::string view;     ///< Name of a view of the display.
};

/// Value of $OCIO; empty if it is not set.
[[nodiscard]] std::filesystem::path users_configuration();

/// Views of the display that the options select; the selected view comes first. Throws Error{usage} for an
/// unknown display or view. Throws Error{input} for a configuration that cannot be read or has no display or
/// view.
[[nodiscard]] std::vector<std::string> view_names(const ViewOptions& options);

/// Converts linear values of one sensor to code values of a display, with OpenColorIO.
class DisplayTransform {
 public:
  /// `channels` names the film channels in order, one or three of them. `to_xyz_d65` converts their values to
  /// XYZ relative to D65; for one channel only its first column counts.
  /// A user's configuration receives ACES2065-1: it needs the role `aces_interchange`, or that space by name.
  /// Throws Error{usage} for another number of channels and for an unknown display or view, Error{input} for
  /// an unusable configuration.
  DisplayTransform(std::vector<std::string> channels, const Matrix3& to_xyz_d65,
                   const ViewOptions& options = {});

  /// Converts a film. The steps are:
  /// - multiply by `scale` > 0, by default `automatic_scale`;
  /// - map every colour into the gamut (`map_into`) of the display for the plain view;
  /// - map it into AP1 without an upper limit for any other view, which does its own tone mapping;
  /// - apply the view, and clip code values that still exceed [0, 1].
  ///
  /// A pixel that is not a number becomes black and counts as clipped. Throws Error{input} if the film lacks
  /// a channel.
  [[nodiscard]] DisplayPicture operator()(const Image& film, std::optional<double> scale = {}) const;

  /// Scale that maps the 99th percentile of the brightest Rec.709 primary to 1, over the recorded pixels that
  /// are finite, with colours mapped into that gamut. If the percentile is not positive, the brightest pixel
  /// counts; the scale is 1 for a film without light. Throws Error{input} if the film lacks a channel.
  [[nodiscard]] double automatic_scale(const Image& film) const;

  /// Matrix from film values to XYZ relative to D65.
  [[nodiscard]] const Matrix3& to_xyz_d65() const { return to_xyz_d65_; }
  /// Files of the user's configuration: itself and the tables that the view uses. Empty for Abbe's own.
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const { return files_; }

 private:
  struct Processor;
  std::vector<std::string> channels_;
  Matrix3 to_xyz_d65_;
  std::vector<std::filesystem::path> files_;
  std::shared_ptr<const Processor> processor_;
};

/// Bradford adaptation of a white to D65. It is the identity for spectral lines and for light that the
/// observer does not see, for which chromatic adaptation is impossible.
[[nodiscard]] Matrix3 white_adaptation(const Chromaticity& white);

/// Display transform of a sensor in a light with the spectral power `illuminant` on any scale.
/// - Three channels named X, Y, Z are an observer; only the white is adapted to D65 (Bradford).
/// - Other three channels are white balanced on the light. The white-preserving matrix fitted to the
///   ColorChecker (BabelColor average) in that light corrects them. Then `white`, by default that of the
///   light, is adapted.
/// - One channel is displayed as grey.
///
/// Y is in units of the second channel's value of a neutral, or of the single channel. Throws Error{usage}
/// for another number of channels, and for channels that do not determine colours in this light. Throws also
/// as the constructor of `DisplayTransform`.
[[nodiscard]] DisplayTransform make_display(const std::vector<Channel>& channels, const Curve& illuminant,
                                            const ViewOptions& options = {},
                                            std::optional<Chromaticity> white = {});

/// Film values t r_k, for channel k, of the brightest neutral below saturation. `to_xyz_d65` maps the film
/// values r to D65. The first channel saturates at t = min_k saturation_k / r_k, with the film value
/// `saturation` of each of three channels. Empty if no neutral is positive in every channel below saturation.
[[nodiscard]] std::optional<std::array<double, 3>> brightest_neutral(const Matrix3& to_xyz_d65,
                                                                     const std::vector<double>& saturation);

/// Clips every channel of `planes` at the `brightest_neutral`, so that saturated pixels become white.
/// Channels saturate at values that are not neutral, which would make bright white light look cyan or
/// magenta. `channels` are the three names in the order of `saturation`; planes of other names remain. Does
/// nothing if there is no such neutral.
void clip_to_white(Image& planes, const std::vector<std::string>& channels, const Matrix3& to_xyz_d65,
                   const std::vector<double>& saturation);

/// Matrix from a sensor's film values to colours, as a calibration gives it.
struct CameraMatrix {
  std::string space;  ///< Name of the camera space.
  /// Its columns are in the order of the channels. Scaled so that a neutral's Y is the value of its second
  /// channel, as in `make_display`.
  Matrix3 to_xyz_d65;
};

/// Matrix of the camera space, in the view's configuration, that belongs to a film with these channels and
/// this white. A single space is taken for any white. Among several, it takes that of the light named
/// `white_name`, else of the illuminant whose chromaticity is nearest to `white`. Empty for a configuration
/// without camera spaces, for Abbe's own configuration, for a number of channels other than three, and for an
/// observer's X, Y, Z. Throws Error{usage} if no space can be chosen, and for a root polynomial. Throws
/// Error{input} for a configuration that OpenColorIO cannot read.
[[nodiscard]] std::optional<CameraMatrix> camera_matrix(const ViewOptions& view,
                                                        std::span<const std::string> channels,
                                                        const std::string& white_name,
                                                        std::optional<Chromaticity> white);

}  // namespace abbe
