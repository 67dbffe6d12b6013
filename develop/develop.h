#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "develop/film_sensor.h"

namespace abbe {

/// Attributes of raw files. They are the meaning of the numbers, the code expected without light
/// (`black_level`), the code of saturated pixels, and the gain.
inline constexpr const char* kCodesKey = "codes";
inline constexpr const char* kBlackLevelKey = "black_level_dn";
inline constexpr const char* kWhiteLevelKey = "white_level_dn";
inline constexpr const char* kGainKey = "gain_e_per_dn";

/// The planes of a film at each step from exposure to digital numbers.
struct DevelopedFilm {
  Image exposure;
  Image variance;
  Image electrons;   ///< Expected photoelectrons; empty without a readout, like `codes`.
  Image codes;       ///< Digital numbers, and `Saturated.` planes of 0 and 1.
  Image calibrated;  ///< Exposure estimated from the codes; the exposure itself without a readout.
};

/// Reads the film out once. The noise is a function of `seed`, `frame`, plane and pixel. Throws Error{input}
/// if a pixel expects more electrons than can be counted.
[[nodiscard]] DevelopedFilm develop(const ExposedFilm& exposed, std::uint64_t seed, std::uint32_t frame = 0);

/// The code [DN] that every pixel expects without light, after a response curve is inverted: offset plus dark
/// signal. If channels have different exposure times, their dark signals differ, and the result is the offset
/// alone. The sensor must have a readout.
[[nodiscard]] double black_level(const FilmSensor& sensor);
/// A warning if channels have different dark signals, which `black_level` then does not include; empty
/// otherwise.
[[nodiscard]] std::optional<std::string> unequal_dark_signals_warning(const FilmSensor& sensor);

/// The seed of the render that made the film; 0 if the film does not record it.
[[nodiscard]] std::uint64_t render_seed(const Image& film);

/// The image for the display transform: every channel in every pixel, divided by the `WhiteField` if the
/// sensor has one, with saturated pixels set to white.
[[nodiscard]] Image display_planes(const FilmSensor& sensor, const Image& calibrated);

/// The film value that pictures of `display_planes` show as white: the sensor's own if it has one, else an
/// automatic value. If pixels are saturated in all three channels, the automatic value is at most theirs, so
/// that they are white. Throws as `require_display`.
[[nodiscard]] double display_white(const FilmSensor& sensor, const Image& planes);

/// Mean and root mean square errors of a plane over the rendered pixels, in electrons with a readout, else in
/// film values.
struct PlaneFigures {
  double mean = 0;
  /// Error of the render; empty if the film does not record it or a variance is infinite.
  std::optional<double> render_error;
  TemporalNoise noise{};  ///< Sensor noise at the mean; zero without a readout.
  double saturated_fraction = 0;
};
/// Figures of a developed film, in the order of `sensor.planes`.
[[nodiscard]] std::vector<PlaneFigures> plane_figures(const FilmSensor& sensor,
                                                      const DevelopedFilm& developed);

}  // namespace abbe
