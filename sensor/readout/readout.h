#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace abbe {

/// Relation between two quantities, strictly increasing and linear between its points (at least two).
class MonotoneCurve {
 public:
  struct Point {
    double in;
    double out;
  };
  /// Throws Error{internal} unless there are two points or more, and both coordinates increase strictly.
  explicit MonotoneCurve(std::vector<Point> points);

  /// Value of the relation, or of its inverse. The first and last pieces extrapolate both.
  [[nodiscard]] double operator()(double in) const;
  [[nodiscard]] double inverse(double out) const;

 private:
  std::vector<Point> points_;
};

/// Electronics of a sensor, which convert the electrons of a pixel to a digital number. No function checks
/// the ranges.
struct Readout {
  double gain_e_per_dn = 1;  ///< K, electrons per digital number.
  int bits = 16;             ///< Bits of the converter, 1 to 16: codes are 0 to 2^bits - 1.
  double offset_dn = 0;      ///< Code of a pixel without electrons, below the highest code.
  double full_well_e = std::numeric_limits<double>::infinity();  ///< Largest number of electrons in a pixel.
  double saturation_dn = std::numeric_limits<double>::infinity();  ///< Highest code, if below 2^bits - 1.
  double read_noise_e = 0;                                         ///< Standard deviation of the read noise.
  double row_noise_e = 0;  ///< Standard deviation of the noise common to all pixels of a row in one exposure.
  double dark_e_per_s = 0;        ///< Mean dark current.
  double prnu_percent = 0;        ///< Standard deviation of the pixels' sensitivity, relative to its mean.
  double dsnu_e = 0;              ///< Standard deviation of the pixels' offsets.
  double hot_pixels_percent = 0;  ///< Percentage of pixels with an additional dark current.
  double hot_pixel_e_per_s = 0;   ///< Mean of that dark current, which is exponentially distributed.
  bool blooming = false;          ///< True if the excess charge of a full well flows along its column.
  std::uint64_t serial = 0;       ///< Number of the sensor specimen, which selects its fixed patterns.
  /// Curve from signal to code, both as fractions of the codes above the offset, from (0, 0) to (1, 1).
  /// Linear if absent.
  std::optional<MonotoneCurve> response_curve = {};

  /// Highest code of the converter, a whole number.
  [[nodiscard]] double highest_code() const {
    return std::floor(std::min(static_cast<double>((1U << bits) - 1), saturation_dn));
  }
};

/// Light-sensitive area of a pixel [m^2]; the fill factor is in (0, 1]. Times a film value [electrons/m^2] it
/// gives electrons per pixel.
[[nodiscard]] double gathering_area(double pixel_pitch_m, double fill_factor);

/// One exposure of a sensor. Another seed or frame gives independent noise and the same fixed patterns.
struct Exposure {
  double seconds = 1;
  std::uint64_t seed = 0;   ///< Seed of the noise.
  std::uint32_t frame = 0;  ///< Number of the exposure in a series.
  std::size_t width = 0;    ///< Pixels per row, for row noise; 0 if all pixels are one row.
  /// Exposure time of each pixel [s], if filters give them different ones; otherwise empty, and all have
  /// `seconds`.
  std::span<const double> own_seconds = {};

  [[nodiscard]] double seconds_of(std::size_t pixel) const {
    return own_seconds.empty() ? seconds : own_seconds[pixel];
  }
};

/// Output of the converter for each pixel.
struct RawFrame {
  std::vector<std::uint16_t> dn;        ///< Codes.
  std::vector<std::uint8_t> saturated;  ///< 1 if the well was full or the code is the highest.
};

/// Reads out pixels with the expected electrons e from light. Negative e count as 0.
///
///     electrons = min(Poisson(e (1 + PRNU) + (dark + hot) t), full well)
///     DN = floor(curve((electrons + DSNU + row + N(0, read noise)) / K) + offset + 1/2), clipped to codes.
///
/// PRNU and DSNU are fixed Gaussian patterns [EMVA1288]. `hot` applies to hot pixels only, `row` is one
/// Gaussian number per row, t the exposure time of the pixel. `curve` maps a signal above the offset to a
/// code above it. With blooming, half of the excess charge of a well flows down its column and half up. It
/// fills the first wells with room or leaves the sensor. The result is a pure function of readout, exposure,
/// pixel index and electrons; with blooming, of the electrons of the column. Throws Error{input} for
/// electrons that are not a number or exceed 1e15, with or without the dark signal.
[[nodiscard]] RawFrame read_out(const Readout& readout, std::span<const float> expected_e,
                                const Exposure& exposure);

/// Electrons of a code by offset, curve and gain alone. Codes below the offset give negative electrons;
/// nothing is clipped.
[[nodiscard]] double electrons_of(const Readout& readout, double dn);

/// Expected code without light after an exposure, for a linear response: offset + dark t/K. It is the offset
/// if the dark signal alone saturates, so that the codes contain no light.
[[nodiscard]] double black_level(const Readout& readout, double exposure_s);

/// Linearised code for each code from 0 to the highest: the rounded output of a sensor without the response
/// curve, clipped to the same codes. Empty without a curve.
[[nodiscard]] std::vector<std::uint16_t> linear_codes(const Readout& readout);

/// Lowest code of saturated pixels: the highest code, or that of a full well minus six standard deviations of
/// its noise, whichever is lower. The noise is read noise, row noise and DSNU; one pixel in 1e9 falls below.
/// The well counts with at least half of its capacity.
[[nodiscard]] double white_level(const Readout& readout);

/// Standard deviations of the temporal noise of a pixel [electrons], by source, and the root of the sum of
/// their squares.
struct TemporalNoise {
  double photon_e;
  double dark_e;
  double read_e;
  double row_e;
  double quantisation_e;  ///< K/sqrt(12)
  double total_e;
};
/// Temporal noise of a pixel that expects `mean_e` electrons from light. Exact for a linear response below
/// saturation. Negative `mean_e` counts as 0.
[[nodiscard]] TemporalNoise temporal_noise(const Readout& readout, double mean_e, double exposure_s);

/// Signal behind a code, in DN of a linear response.
struct CodeLevel {
  double signal_dn;     ///< Center of the signals that give the code.
  double rounding_dn2;  ///< Variance that rounding to the code adds: w^2/12 for signals of a width w.
};

/// Level of each of the 65536 codes after `linear_codes`, indexed by the code. Depending on the slope of the
/// response curve, one code of the readout covers more than 1 DN, or several cover less. Codes that
/// `linear_codes` does not produce, and all codes without a response curve, are their own level, with a width
/// of 1 DN.
[[nodiscard]] std::vector<CodeLevel> code_levels(const Readout& readout);

}  // namespace abbe
