#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "develop/film_sensor.h"

namespace abbe {

/// Attributes of raw files: what their numbers are, the code that pixels expect without light, as
/// `black_level` has it, that which saturated ones reach, and electrons per digital number.
inline constexpr const char* kCodesKey = "codes";
inline constexpr const char* kBlackLevelKey = "black_level_dn";
inline constexpr const char* kWhiteLevelKey = "white_level_dn";
inline constexpr const char* kGainKey = "gain_e_per_dn";

/// The planes of a film, one image for each step from light to numbers.
struct DevelopedFilm {
  Image exposure;
  Image variance;
  Image electrons;   ///< Expected, from light; empty without a read-out, as the next.
  Image codes;       ///< Digital numbers, and `Saturated.` planes of 0 and 1.
  Image calibrated;  ///< What the codes say of the exposure; the exposure itself without a read-out.
};

/// Reads the film out once, its noise a function of `seed`, `frame`, plane and pixel. Throws Error{input} for
/// a pixel that expects more electrons than can be counted.
[[nodiscard]] DevelopedFilm develop(const ExposedFilm& exposed, std::uint64_t seed, std::uint32_t frame = 0);

/// The code that every pixel expects without light, on the straight line that is left where a response curve
/// is undone: offset and dark signal; the offset alone where channels have exposure times of their own, and
/// so dark signals of their own. For sensors with a read-out.
[[nodiscard]] double black_level(const FilmSensor& sensor);
/// That there are such channels, as a sentence, since what is measured above that level has their dark
/// signals in it; nothing where there are none.
[[nodiscard]] std::optional<std::string> own_dark_signals(const FilmSensor& sensor);

/// The seed of the render that made the film; 0 for one that does not tell.
[[nodiscard]] std::uint64_t render_seed(const Image& film);

/// Image for the display transform: every channel in every pixel, divided by the `WhiteField` if the sensor
/// has one, with saturated pixels set to white.
[[nodiscard]] Image display_planes(const FilmSensor& sensor, const Image& calibrated);

/// The film value that pictures of the planes of `display_planes` show as white: the sensor's if it has one,
/// else the automatic one. Where pixels saturated in all three channels, the automatic value is no more than
/// theirs, so that they are white. Throws what `require_display` does.
[[nodiscard]] double shown_as_white(const FilmSensor& sensor, const Image& planes);

/// A plane's mean over the pixels that have been rendered, and errors as the roots of their mean squares: in
/// electrons with a read-out, else in film values.
struct PlaneFigures {
  double mean = 0;
  /// Nothing where the film does not know it, or a variance is infinite.
  std::optional<double> render_error;
  TemporalNoise noise{};  ///< The sensor's noise at the mean; none without a read-out.
  double saturated_share = 0;
};
/// The figures of each plane of a developed film, in the order of its planes.
[[nodiscard]] std::vector<PlaneFigures> plane_figures(const FilmSensor& sensor,
                                                      const DevelopedFilm& developed);

}  // namespace abbe
