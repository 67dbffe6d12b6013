#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "calibration/output/camera_profile.h"
#include "spectral/matrix3.h"
#include "spectral/rgb.h"

namespace abbe {

/// Names in the configuration.
inline constexpr const char* kReferenceSpace = "Linear XYZ-D65";
inline constexpr const char* kSrgbDisplay = "sRGB - Display";
inline constexpr const char* kRec1886Display = "Rec.1886 Rec.709 - Display";
inline constexpr const char* kP3Display = "P3-D65 - Display";
inline constexpr const char* kCameraPrefix = "Camera ";  ///< Of camera spaces, before their light.
inline constexpr const char* kPlainView = "Un-tone-mapped";
inline constexpr const char* kAcesView = "ACES 1.0 - SDR Video";

/// How the code values of a display of the configuration are to be read.
struct DisplayCodes {
  std::string color_space;  ///< In the words of `kColorSpace`.
  RgbSpace space;           ///< Their primaries and the white of equal codes.
};
/// Throws Error{internal} for another display.
[[nodiscard]] const DisplayCodes& codes_of_display(const std::string& display);

/// The colour space of a profile, e.g. "Camera D65".
[[nodiscard]] std::string camera_space(const CameraProfile& profile);
/// The name of a file of the camera's space: `camera_D65` and an extension; characters a file name should not
/// have become '_'.
[[nodiscard]] std::string camera_file(const CameraProfile& profile, const std::string& extension);

/// An OpenColorIO version 2 configuration. Reference space: linear XYZ, white D65. Colour spaces: one for
/// each profile (file transform of its `.spi1d` if there is a linearisation, then a matrix, or the cube root
/// and the `.cube` of a root polynomial). A cube holds linear values from 0 to 1 after a linearisation and
/// where those that were calibrated are shares of full scale, which reach an eighth of it at least; other
/// values are divided first by the next power of two above the brightest of them, where the cube then ends.
/// Further spaces: ACES2065-1, ACEScg, linear Rec.709, sRGB texture, Raw.
/// Displays sRGB, Rec.1886 and P3-D65, each with a view that neither tone-maps nor clips and with the
/// ACES 1.0 view, from OpenColorIO's built-in transforms. Throws Error{internal} with OpenColorIO's words.
[[nodiscard]] std::string ocio_config_text(std::span<const CameraProfile> profiles);

/// A camera's colour space in a configuration that `write_ocio_config` wrote.
struct OcioCameraSpace {
  std::string name;  ///< E.g. "Camera D65".
  /// Matrix from linear values of R, G and B to XYZ relative to D65; empty for a root polynomial. It does not
  /// include the response curve that precedes it.
  std::optional<Matrix3> to_xyz_d65;
};
/// The camera spaces of a configuration; none for one of another origin. Throws Error{input} for a file that
/// OpenColorIO cannot read.
[[nodiscard]] std::vector<OcioCameraSpace> camera_spaces(const std::filesystem::path& config);

/// Creates a folder unless it is there. Throws Error{output}.
void make_folder(const std::filesystem::path& folder);

/// What was written.
struct WrittenConfig {
  /// What a root polynomial's cube costs: the largest CIEDE2000 between OpenColorIO's interpolation and the
  /// polynomial, over camera values from 0.2 % of the cube's end on: in the middle between points of the cube
  /// and at them, all of dark ones and some of the others; 0 for a matrix.
  double bake_error = 0;
  std::vector<std::filesystem::path> files;
};

/// Writes into `folder`, creating it: curves and cubes of the profiles; for each one `camera_<light>.clf` to
/// XYZ and the ACES input transform `camera_<light>_to_aces.clf`, both made by OpenColorIO from the
/// configuration itself; `config.ocio` last, after OpenColorIO has validated it. Throws Error{output} when
/// the folder cannot be written or OpenColorIO objects, as it does when $OCIO_ACTIVE_DISPLAYS names displays
/// of another configuration.
WrittenConfig write_ocio_config(const std::filesystem::path& folder, std::span<const CameraProfile> profiles);

}  // namespace abbe
