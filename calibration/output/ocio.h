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

/// Names of spaces, displays and views in the configuration.
inline constexpr const char* kReferenceSpace = "Linear XYZ-D65";
inline constexpr const char* kSrgbDisplay = "sRGB - Display";
inline constexpr const char* kRec1886Display = "Rec.1886 Rec.709 - Display";
inline constexpr const char* kP3Display = "P3-D65 - Display";
/// Prefix of camera spaces, followed by their light.
inline constexpr const char* kCameraPrefix = "Camera ";
inline constexpr const char* kPlainView = "Un-tone-mapped";
inline constexpr const char* kAcesView = "ACES 1.0 - SDR Video";

/// Encoding of the code values of a display.
struct DisplayCodes {
  std::string color_space;  ///< Value of the attribute `kColorSpace`.
  RgbSpace space;           ///< Primaries, and the white of equal codes.
};
/// Encoding of a display of Abbe's configuration. Throws Error{internal} for another display.
[[nodiscard]] const DisplayCodes& codes_of_display(const std::string& display);

/// Name of the colour space of a profile, such as "Camera D65".
[[nodiscard]] std::string camera_space(const CameraProfile& profile);
/// Name of a file of the camera's space: `camera_D65` and an extension such as ".clf". Characters of the
/// light other than ASCII letters, digits, '.' and '-' become '_'.
[[nodiscard]] std::string camera_file(const CameraProfile& profile, const std::string& extension);

/// Text of an OpenColorIO version 2 configuration with the reference space linear XYZ, white D65. It contains
/// - one space for each profile: a file transform of its `.spi1d` if there is a linearisation, then a matrix,
///   or the cube root and the `.cube` of a root polynomial;
/// - the spaces ACES2065-1, ACEScg, linear Rec.709 and Raw;
/// - the displays sRGB, Rec.1886 and P3-D65, each with a view that neither tone-maps nor clips and with the
///   ACES 1.0 view of OpenColorIO's built-in transforms.
///
/// A cube holds linear values from 0 to 1 after a linearisation. It does so too if the brightest calibrated
/// value is between 1/8 and 1, a fraction of full scale. Other values are divided by the next power of two
/// above the brightest of them, at which the cube ends. Throws Error{internal} for linearisation curves of
/// unequal sizes, of one entry or of more than 2^20, and with OpenColorIO's message.
[[nodiscard]] std::string ocio_config_text(std::span<const CameraProfile> profiles);

/// A camera's colour space in a configuration by `write_ocio_config`.
struct OcioCameraSpace {
  std::string name;  ///< E.g. "Camera D65".
  /// Matrix from linear values of R, G and B to XYZ relative to D65; empty for a root polynomial. It excludes
  /// the response curve that precedes it.
  std::optional<Matrix3> to_xyz_d65;
};
/// Camera spaces of a configuration; empty if it was not written by `write_ocio_config`. Throws Error{input}
/// for a file that OpenColorIO cannot read.
[[nodiscard]] std::vector<OcioCameraSpace> camera_spaces(const std::filesystem::path& config);

/// Creates a folder and its parents unless they exist. Throws Error{output} if that fails.
void make_folder(const std::filesystem::path& folder);

/// Files of a written configuration.
struct WrittenConfig {
  /// Error of a root polynomial's cube: the largest CIEDE2000 between OpenColorIO's interpolation and the
  /// polynomial; 0 for a matrix. It is taken over camera values from 0.2 % of the cube's end on, at the
  /// points of the cube and half way between them. All dark ones and some of the others are tested.
  double bake_error = 0;
  std::vector<std::filesystem::path> files;  ///< Paths of all files that were written.
};

/// Writes a configuration into `folder`, which it creates:
/// - curves and cubes of the profiles;
/// - for each profile `camera_<light>.clf` to XYZ and the ACES input transform `camera_<light>_to_aces.clf`,
///   both made by OpenColorIO from the configuration;
/// - `config.ocio` last, after OpenColorIO has validated it.
///
/// Files of these names are replaced. Throws Error{output} if the folder cannot be written or OpenColorIO
/// rejects the configuration, as if $OCIO_ACTIVE_DISPLAYS names other displays. Throws also as
/// `ocio_config_text`.
WrittenConfig write_ocio_config(const std::filesystem::path& folder, std::span<const CameraProfile> profiles);

}  // namespace abbe
