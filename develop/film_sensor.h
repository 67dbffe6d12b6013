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

/// The attribute of a film of no scene: what its camera saw, "bias", "dark" or "flat", in what is developed
/// of it with the share of saturation.
inline constexpr const char* kFrameKey = "frame";
inline constexpr const char* kBiasFrame = "bias";
inline constexpr const char* kFlatFrame = "flat";
/// Where a film's description has the ISO speed.
inline constexpr const char* kIsoPointer = "/readout/iso";

/// What a film's file tells of the sensor behind it: all that it takes to go on without its scene.
struct FilmSensor {
  std::vector<std::string> planes;
  double shared_exposure_s = 1;    ///< The sensor's,
  std::vector<double> exposure_s;  ///< and that of each channel.
  std::optional<Mosaic> mosaic;
  std::vector<std::string> channels;  ///< The planes that count light, or the channels of the mosaic.
  double gathering_area_m2 = 0;       ///< Film values times this are what a pixel counts.
  std::optional<Readout> readout;
  std::optional<double> electrons_per_lx_s;  ///< Of a pixel of the most sensitive channel, in daylight.
  std::optional<double> f_number;
  std::string description;  ///< What a scene would say of it, overrides included; empty where none is known.
  std::string camera;       ///< Name of its model, else of the measured camera; empty where it has none.
  std::string measured_camera;  ///< That whose curves it has; empty where its channels are of its own.
  std::optional<DisplayTransform> display;
  std::string camera_space;  ///< Of the configuration of its pictures; empty for its own colours.
  std::string no_picture;    ///< Why there is no display; empty where no reason is known.
  std::optional<double> display_exposure;  ///< Film value shown as white.
  std::optional<Chromaticity> white;       ///< Shown as white: what was asked for, else the film's own.
  std::optional<WhiteField> white_field;   ///< Of filters that depend on the angle; else none.
  bool flattens_field = false;             ///< True if pictures are divided by it.
  std::string white_name;                  ///< Of what was asked for; empty for the film's own.
  std::vector<RawLight> lights;            ///< Of a calibration, for raw converters; else none.
};

/// A film and the sensor it was exposed on.
struct ExposedFilm {
  Image film;
  FilmSensor sensor;
};

/// The sensor that the metadata of a film tell of, after `overrides` of its description's `/readout`; its
/// pictures, made by `view`, show `white` as white if one is given. Reports what is wrong with the read-out
/// and then returns nothing. Throws Error{input} naming `path` when something is missing, Error{usage} for an
/// override of what the render has used already.
[[nodiscard]] std::optional<FilmSensor> film_sensor(const Image& film, const std::filesystem::path& path,
                                                    std::span<const Override> overrides,
                                                    const ViewOptions& view,
                                                    std::optional<Chromaticity> white,
                                                    Diagnostics& diagnostics);

/// The film value that the film read from `path` tells to be shown as white. Throws Error{input} for one that
/// makes no sense.
[[nodiscard]] std::optional<double> recorded_display_exposure(const Image& film,
                                                              const std::filesystem::path& path);

/// The exposure time of all channels [s]; nothing where they differ.
[[nodiscard]] std::optional<double> common_exposure(const FilmSensor& sensor);

/// Exposes the film anew for `seconds`, without rendering: light, and with the square its variance, grow with
/// the time. That is the time of all channels, or where they differ the sensor's, to which theirs keep their
/// ratio. What moved stays blurred as it is: films do not tell that something did, but where their shutter
/// takes its time, they warn of it. Throws Error{usage} for a film that tells no exposure, such as what the
/// eye sees of a spectral one, and for a bias frame, which has none.
void expose_for(ExposedFilm& exposed, double seconds, Diagnostics& diagnostics);

/// What a camera sees without a scene: nothing, in no time, for its read-out alone; nothing in the film's own
/// time; or light that lets every pixel expect the same share of saturation.
struct BiasFrame {};
struct DarkFrame {};
struct FlatFrame {
  double share = 0.5;
};
using CalibrationFrame = std::variant<BiasFrame, DarkFrame, FlatFrame>;
/// Puts that in the place of the film, without variance. Throws Error{usage} for a sensor without a read-out.
void expose_to(ExposedFilm& exposed, const CalibrationFrame& frame);

/// Throws Error{usage} unless displays can show what the sensor sees, with the reason that the film tells.
void require_display(const FilmSensor& sensor);

/// Throws Error{input} naming `path` unless the film has each plane of the sensor, and its variance.
void require_planes(const Image& film, const FilmSensor& sensor, const std::filesystem::path& path);

}  // namespace abbe
