#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "calibration/output/display.h"
#include "develop/white_field.h"
#include "io/diagnostics.h"
#include "io/image.h"
#include "io/json.h"
#include "io/raw_picture.h"
#include "sensor/readout/readout.h"
#include "sensor/response/mosaic.h"

namespace abbe {

/// Attribute of a calibration frame: `kBiasFrame`, "dark" or `kFlatFrame`. Developed files append the
/// fraction of saturation to `kFlatFrame`.
inline constexpr const char* kFrameKey = "frame";
inline constexpr const char* kBiasFrame = "bias";
inline constexpr const char* kFlatFrame = "flat";
/// JSON pointer to the ISO speed in a film's sensor description.
inline constexpr const char* kIsoPointer = "/readout/iso";

/// Properties of the sensor that a film file records, which suffice to develop the film.
struct FilmSensor {
  std::vector<std::string> planes;  ///< Planes of the film that the sensor records, in order.
  double shared_exposure_s = 1;     ///< Exposure time of the sensor [s]; 0 for a bias frame.
  std::vector<double> exposure_s;   ///< Exposure time of each of `channels` [s]; empty for radiances.
  /// Present if the film has one plane, whose pixels record different channels.
  std::optional<Mosaic> mosaic;
  std::vector<std::string> channels;  ///< The planes that count light, or the channels of the mosaic.
  /// Light-collecting area of a pixel; film values times it are quantities per pixel.
  double gathering_area_m2 = 0;
  std::optional<Readout> readout;
  /// Electrons per lx s in a pixel of the most sensitive channel, in daylight; empty if unknown.
  std::optional<double> electrons_per_lx_s;
  std::optional<double> f_number;
  std::string description;  ///< Sensor description as in a scene, with overrides applied; empty if unknown.
  std::string camera;  ///< Name of the camera model, else of the measured camera; empty if neither is known.
  std::string measured_camera;  ///< Camera of its curves; empty if the scene defines the channels.
  /// Transform to pictures; empty if none can be made (`no_picture`).
  std::optional<DisplayTransform> display;
  std::string camera_space;  ///< Colour space of its pictures in the OCIO configuration; else empty.
  std::string no_picture;    ///< Reason for a missing display transform; empty if unknown.
  std::optional<double> display_exposure;  ///< Film value to display as white; empty for an automatic one.
  std::optional<Chromaticity> white;       ///< The requested white, else the film's own.
  std::optional<WhiteField> white_field;   ///< Present if filters depend on the angle of incidence.
  bool flattens_field = false;  ///< True if pictures are divided by `white_field`; set by the caller.
  std::string white_name;       ///< Name of the requested white, set by the caller; empty for the film's own.
  std::vector<RawLight> lights;  ///< Illuminants of a calibration, for raw converters; set by the caller.
};

/// A film with the sensor it was exposed on.
struct ExposedFilm {
  Image film;
  FilmSensor sensor;
};

/// Reads the sensor from the metadata of the film read from `path`. `overrides` change `/readout` in its
/// description. Its pictures are made by `view`, and show `white` as white if that is given. Reports errors
/// of the readout; the result is empty if `diagnostics` has errors.
/// Throws Error{input} if an attribute is missing or invalid, or if a sensor with a readout has channels that
/// do not count electrons. Throws Error{usage}
/// - for an override of a value that the render has already used, and for both the gain and the ISO speed;
/// - for a `white` if the film records none;
/// - as `camera_matrix`.
[[nodiscard]] std::optional<FilmSensor> read_film_sensor(const Image& film, const std::filesystem::path& path,
                                                         std::span<const Override> overrides,
                                                         const ViewOptions& view,
                                                         std::optional<Chromaticity> white,
                                                         Diagnostics& diagnostics);

/// The film value to show as white that the film read from `path` records; empty if none. Throws Error{input}
/// if it is not a number above 0.
[[nodiscard]] std::optional<double> recorded_display_exposure(const Image& film,
                                                              const std::filesystem::path& path);

/// The exposure time of all channels [s]; empty if they differ or there are none.
[[nodiscard]] std::optional<double> common_exposure(const FilmSensor& sensor);

/// Changes the exposure time of a film to `seconds` [s], also in its metadata and description. Film values
/// scale with the time, variances with its square. `seconds` applies to all channels, or to the sensor if
/// channels differ; their ratios are then preserved. Motion blur does not change, with a warning if the
/// shutter has a shape. Throws Error{usage} for a film without an exposure time, and for a bias frame.
void expose_for(ExposedFilm& exposed, double seconds, Diagnostics& diagnostics);

/// No light, in no exposure time: the readout alone.
struct BiasFrame {};
/// No light, in the exposure time of the film.
struct DarkFrame {};
/// Uniform light that fills every pixel to the same fraction of saturation.
struct FlatFrame {
  double saturation_fraction = 0.5;  ///< Expected electrons divided by those at saturation.
};
using CalibrationFrame = std::variant<BiasFrame, DarkFrame, FlatFrame>;
/// Replaces the planes of the film by a frame, with variance 0. A bias frame also sets all exposure times to
/// 0. Throws Error{usage} for a sensor without a readout.
void replace_with_frame(ExposedFilm& exposed, const CalibrationFrame& frame);

/// Throws Error{usage} if the sensor has no display transform, with the reason that the film records.
void require_display(const FilmSensor& sensor);

/// Throws Error{input} unless the film read from `path` has each plane of the sensor and its variance.
void require_planes(const Image& film, const FilmSensor& sensor, const std::filesystem::path& path);

}  // namespace abbe
