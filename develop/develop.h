#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "develop/film_sensor.h"

namespace abbe {

/// Attribute of raw files: the code expected without light (`black_level`) [DN].
inline constexpr const char* kBlackLevelKey = "black_level_dn";
/// Attribute of raw files: the lowest code of saturated pixels (`white_level`) [DN].
inline constexpr const char* kWhiteLevelKey = "white_level_dn";

/// The planes of a film at each step from exposure to digital numbers, in the order of `FilmSensor::planes`.
/// Film values are exposures, in the unit that the attribute `channel.<name>` states.
struct DevelopedFilm {
  Image exposure;  ///< Film values.
  /// `Variance.` planes of the film: that of `exposure` due to the render; no planes if the film has none.
  Image variance;
  Image electrons;   ///< Expected photoelectrons per pixel; no planes without a readout, like `codes`.
  Image codes;       ///< Digital numbers, and a `Saturated.` plane of 0 and 1 for each plane.
  Image calibrated;  ///< Film values estimated from the codes; without a readout, those of `exposure`.
};

/// Reads the film out once; without a readout in the sensor, only copies its planes. The noise is a function
/// of `seed`, `frame` (the number of the exposure), plane and pixel. The film must have every plane of the
/// sensor (`require_planes`). Throws Error{input} if a pixel expects more electrons than can be counted.
[[nodiscard]] DevelopedFilm develop(const ExposedFilm& exposed, std::uint64_t seed, std::uint32_t frame = 0);

/// The code [DN] that every pixel expects without light, after a response curve is inverted: offset plus dark
/// signal. If channels have different exposure times, their dark signals differ, and the result is the offset
/// alone. The sensor must have a readout.
[[nodiscard]] double black_level(const FilmSensor& sensor);
/// A warning if channels have different dark signals, which `black_level` does not include; else empty.
[[nodiscard]] std::optional<std::string> unequal_dark_signals_warning(const FilmSensor& sensor);

/// The seed of the render that made the film; 0 if the film does not record it.
[[nodiscard]] std::uint64_t render_seed(const Image& film);

/// The image for the display transform, made of `DevelopedFilm::calibrated`: a mosaic is demosaicked,
/// channels are divided by the `WhiteField` if `sensor.flattens_field`, and saturated pixels of three
/// channels become white.
[[nodiscard]] Image display_planes(const FilmSensor& sensor, const Image& calibrated);

/// The luminance, in the unit of film values of `DisplayTransform`, that pictures of `display_planes` show as
/// white: the sensor's own if it has one, else an automatic value. If pixels are saturated in all three
/// channels, the automatic value is at most theirs, so that they are white. Throws Error{usage} as
/// `require_display`.
[[nodiscard]] double display_white(const FilmSensor& sensor, const Image& planes);

/// Mean, root mean square errors and saturation of a plane over the rendered pixels, in electrons with a
/// readout, else in film values.
struct PlaneFigures {
  double mean = 0;
  /// Root mean square error due to the render; empty if the film does not record it or a variance is
  /// infinite.
  std::optional<double> render_error;
  TemporalNoise noise{};          ///< Sensor noise at the mean; zero without a readout.
  double saturated_fraction = 0;  ///< Fraction of the pixels that are saturated; 0 without a readout.
};
/// Figures of a developed film, in the order of `sensor.planes`.
[[nodiscard]] std::vector<PlaneFigures> plane_figures(const FilmSensor& sensor,
                                                      const DevelopedFilm& developed);

}  // namespace abbe
