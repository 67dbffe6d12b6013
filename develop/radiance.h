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

/// Metadata that a film of spectral bins has and others have not.
inline constexpr const char* kSpectralBinsKey = "spectral_bins";
/// How the radiances of a spectral film were seen: the irradiance on the axis that a unit of radiance gives
/// [sr], the distance from lens to film in pixels, which a meter has not, and the `opening_tangent` of a thin
/// lens that is in focus at a finite distance.
inline constexpr const char* kAxisKey = "irradiance_per_radiance_sr";
inline constexpr const char* kDistanceKey = "image_distance_px";
inline constexpr const char* kOpeningKey = "opening_tangent";
/// Mean transmission of the shutter over the exposure, of one that does not let all light through.
inline constexpr const char* kShutterKey = "shutter_transmission";

/// Warns of a channel that responds beyond the bands of the image read from `path`: light that the image does
/// not have cannot be counted. Throws Error{input} for one that sees nothing of them.
void check_coverage(const SpectralImage& image, const Channel& channel, const std::filesystem::path& path,
                    Diagnostics& diagnostics);

/// Linear Rec.709, channels R, G, B, of the first three planes, which `to_xyz` takes to XYZ of one scale, or
/// of the only one, whose colour is its first column.
[[nodiscard]] Image rec709_image(const Image& planes, const Matrix3& to_xyz);

/// Linear Rec.709 [cd/m^2] of radiances, channels R, G, B, as the CIE 1931 observer sees them.
[[nodiscard]] Image observed(const SpectralImage& image);

/// Takes that to pictures; without a white, colours are shown as they look beside daylight.
[[nodiscard]] DisplayTransform display_of_radiance(const ViewOptions& view,
                                                   std::optional<Chromaticity> white);

/// What shows radiances as the eye sees them, of what the spectral film read from `path` tells of its
/// exposure and, where no other white is asked for, its white. Throws Error{input} for what makes no sense.
[[nodiscard]] FilmSensor observer_of(const Image& film, const std::filesystem::path& path,
                                     const ViewOptions& view, std::optional<Chromaticity> white);

/// Radiances as the eye sees them: `observed`, with `observer_of` their film.
[[nodiscard]] ExposedFilm observed_film(const SpectralImage& image, const std::filesystem::path& path,
                                        const ViewOptions& view, std::optional<Chromaticity> white);

/// A sensor that looks at radiances, pixel for pixel.
struct RadianceSensor {
  std::vector<Channel> channels;
  std::optional<Mosaic> mosaic;
  std::vector<double> exposure_per_radiance;    ///< Of each pixel [s sr].
  std::map<std::string, std::string> metadata;  ///< What its films tell of it.
};

/// Drops what is said of the channels of the sensor that a film was exposed on.
void forget_channels(std::map<std::string, std::string>& metadata);

/// Drops what is said of the sensor that a film was exposed on, of its colours and their white, from what is
/// told of a picture made for displays, which has colours of its own.
void forget_sensor(std::map<std::string, std::string>& metadata);

/// Drops what is said of layers and features, which films have beside their planes.
void forget_layers_and_features(std::map<std::string, std::string>& metadata);

/// Drops what is said of the layout of a spectral film, and of its preview.
void forget_layout(std::map<std::string, std::string>& metadata);

/// The film of a sensor that looks at the radiances read from `path`, with the metadata of both, of
/// which what is told of the sensor and its camera is the new one's; with a mosaic, its one plane. Warns of
/// channels that respond beyond the image's bands. Throws Error{input} for one that sees nothing of them.
[[nodiscard]] Image exposed_film(const SpectralImage& image, const RadianceSensor& sensor,
                                 const std::filesystem::path& path, Diagnostics& diagnostics);

}  // namespace abbe
