#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "calibration/output/display.h"
#include "develop/film_sensor.h"
#include "io/diagnostics.h"
#include "io/spectral_exr.h"
#include "sensor/response/channel.h"
#include "sensor/response/mosaic.h"

namespace abbe {

/// Attribute of spectral films alone: their bins as "FROM_NM STEP_NM COUNT".
inline constexpr const char* kSpectralBinsKey = "spectral_bins";
/// Attribute of spectral films: irradiance at the centre of the film per unit of radiance [sr].
inline constexpr const char* kAxisKey = "irradiance_per_radiance_sr";
/// Attribute of spectral films: distance from lens to film [pixels]; absent for a probe.
inline constexpr const char* kDistanceKey = "image_distance_px";
/// Attribute of spectral films: radius of the lens opening divided by the distance of focus. Absent unless a
/// thin lens is focused at a finite distance.
inline constexpr const char* kOpeningKey = "opening_tangent";
/// Attribute with the mean transmission of the shutter over the exposure, if it is not 1.
inline constexpr const char* kShutterKey = "shutter_transmission";

/// Warns if a channel has more than 0.1 % of its response outside the bands of the image read from `path`,
/// because that light is missing. Throws Error{input} if it has more than 99.9 % there.
void check_coverage(const SpectralImage& image, const Channel& channel, const std::filesystem::path& path,
                    Diagnostics& diagnostics);

/// Linear Rec.709, channels R, G, B, of the first three planes, which `to_xyz` transforms to XYZ at the same
/// scale. A single plane has the colour of the first column of `to_xyz`. Values are neither clamped nor
/// encoded.
[[nodiscard]] Image rec709_image(const Image& planes, const Matrix3& to_xyz);

/// Radiances as the CIE 1931 observer sees them, in linear Rec.709 [cd/m^2], channels R, G, B.
[[nodiscard]] Image observed(const SpectralImage& image);

/// Transform of the result of `observed` to pictures by the options `view`. Colours are adapted from `white`
/// to D65; without `white` they are not adapted, so that D65 appears white.
[[nodiscard]] DisplayTransform display_of_radiance(const ViewOptions& view,
                                                   std::optional<Chromaticity> white);

/// A sensor that shows the result of `observed`, with the display exposure of the spectral film `film`, read
/// from `path`. It has no readout. The white is `white` if given, else that of the film. Throws Error{input}
/// if an attribute is invalid.
[[nodiscard]] FilmSensor observer_of(const Image& film, const std::filesystem::path& path,
                                     const ViewOptions& view, std::optional<Chromaticity> white);

/// The result of `observed` with the sensor `observer_of`.
[[nodiscard]] ExposedFilm observed_film(const SpectralImage& image, const std::filesystem::path& path,
                                        const ViewOptions& view, std::optional<Chromaticity> white);

/// A sensor exposed to radiances pixel for pixel.
struct RadianceSensor {
  std::vector<Channel> channels;
  std::optional<Mosaic> mosaic;
  /// Radiant exposure per radiance of each pixel [s sr], row by row from the top.
  std::vector<double> exposure_per_radiance;
  std::map<std::string, std::string> metadata;  ///< Attributes of its films.
};

/// Erases the attributes of the channels of a film's sensor.
void erase_channel_attributes(std::map<std::string, std::string>& metadata);

/// Erases the attributes of a film's sensor, its colours and their white.
void erase_sensor_attributes(std::map<std::string, std::string>& metadata);

/// Erases the attributes of layers and features.
void erase_layer_and_feature_attributes(std::map<std::string, std::string>& metadata);

/// Erases the attributes of the layout of a spectral film and of its preview.
void erase_layout_attributes(std::map<std::string, std::string>& metadata);

/// Exposes a sensor to the radiances read from `path`. The film has the metadata of both; attributes of
/// sensor and camera are those of the new sensor. With a mosaic it has one plane. Warns and throws as
/// `check_coverage` for each channel, and throws as `expose`.
[[nodiscard]] Image exposed_film(const SpectralImage& image, const RadianceSensor& sensor,
                                 const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace abbe
