#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace abbe {

/// A relation between two quantities, strictly increasing and linear between its points (at least two).
class MonotoneCurve {
 public:
  struct Point {
    double in;
    double out;
  };
  /// Throws Error{internal} unless both coordinates increase strictly.
  explicit MonotoneCurve(std::vector<Point> points);

  /// Beyond the ends the first and last pieces go on.
  [[nodiscard]] double operator()(double in) const;
  [[nodiscard]] double inverse(double out) const;

 private:
  std::vector<Point> points_;
};

/// The electronics of a sensor: how the electrons of a pixel become a digital number. Names and their units
/// are those of the scene file.
struct Readout {
  double gain_e_per_dn = 1;  ///< K, electrons per digital number.
  int bits = 16;             ///< Of the converter, 1 to 16: codes are 0 to 2^bits - 1.
  double offset_dn = 0;      ///< Code of a pixel without electrons.
  double full_well_e = std::numeric_limits<double>::infinity();    ///< Electrons a pixel can hold.
  double saturation_dn = std::numeric_limits<double>::infinity();  ///< Where codes end, if below 2^bits - 1.
  double read_noise_e = 0;                                         ///< Standard deviation.
  double row_noise_e = 0;         ///< Standard deviation of what all pixels of a row share in one exposure.
  double dark_e_per_s = 0;        ///< Mean dark current.
  double prnu_percent = 0;        ///< Standard deviation of the pixels' sensitivity, relative to its mean.
  double dsnu_e = 0;              ///< Standard deviation of the pixels' offsets.
  double hot_pixels_percent = 0;  ///< Share of pixels that have a dark current of their own besides,
  double hot_pixel_e_per_s = 0;   ///< exponentially distributed over them with this mean.
  bool blooming = false;          ///< Whether what a full well cannot hold flows along its column.
  std::uint64_t serial = 0;       ///< Which specimen of the sensor: each has its own fixed patterns.
  /// The curve from signal to code, both as shares of the codes above the offset; linear when absent. Goes
  /// from (0, 0) to (1, 1).
  std::optional<MonotoneCurve> response_curve = {};

  [[nodiscard]] double highest_code() const {
    return std::floor(std::min(static_cast<double>((1U << bits) - 1), saturation_dn));
  }
};

/// The area that gathers light [m^2]: electrons per pixel are film values [electrons/m^2] times this.
[[nodiscard]] double gathering_area(double pixel_pitch_m, double fill_factor);

/// One exposure of a sensor: those of another seed or frame have independent noise and the same fixed
/// patterns.
struct Exposure {
  double seconds = 1;
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  std::size_t width = 0;  ///< Pixels in a row, along which there is row noise; 0 where all are one row.
  /// Of each pixel, where filters over them have exposures of their own; else all have `seconds`.
  std::span<const double> own_seconds = {};

  [[nodiscard]] double seconds_of(std::size_t pixel) const {
    return own_seconds.empty() ? seconds : own_seconds[pixel];
  }
};

/// What the converter gives, pixel by pixel.
struct RawFrame {
  std::vector<std::uint16_t> dn;
  std::vector<std::uint8_t> saturated;  ///< 1 where the well was full or the code is the highest.
};

/// Reads out pixels that expect these electrons from light (negative ones count as none):
///
///     electrons = min(Poisson(e (1 + PRNU) + (dark + hot) t), full well)
///     DN = floor(curve((electrons + DSNU + row + N(0, read noise)) / K) + offset + 1/2), cut to the codes
///
/// with fixed Gaussian patterns PRNU and DSNU [EMVA1288], `hot` in the hot pixels only and `row` one Gaussian
/// number for each row. With blooming, half of what a well cannot hold flows down its column and half up,
/// into the first wells that have room, and off the end. A pure function of readout, exposure and each
/// pixel's own number and electrons, with blooming those of its column. Throws Error{input} for electrons
/// that are no number or above 1e15, of light alone or with the dark signal.
[[nodiscard]] RawFrame read_out(const Readout& readout, std::span<const float> expected_e,
                                const Exposure& exposure);

/// Electrons that a code stands for, by offset, curve and gain alone: what calibration makes of raw data.
[[nodiscard]] double electrons_of(const Readout& readout, double dn);

/// The code that a pixel expects without light after such an exposure, were the response a straight line:
/// offset + dark t/K; the offset where the dark signal alone saturates, so that nothing of light is told.
[[nodiscard]] double black_level(const Readout& readout, double exposure_s);

/// For each code from 0 to the highest the whole number that a sensor without the response curve would have
/// given; nothing without a curve.
[[nodiscard]] std::vector<std::uint16_t> linear_codes(const Readout& readout);

/// The code that saturated pixels reach: the highest, or that of a full well less six standard deviations of
/// what is added to it (read and row noise, DSNU), below which one in 1e9 falls; where that is less than half
/// the well, that of half of it.
[[nodiscard]] double white_level(const Readout& readout);

/// Standard deviations of what makes two exposures of one pixel differ [electrons].
struct TemporalNoise {
  double photon_e;
  double dark_e;
  double read_e;
  double row_e;
  double quantisation_e;  ///< K/sqrt(12)
  double total_e;
};
/// Temporal noise of a pixel that expects `mean_e` electrons from light; exact for a linear response below
/// saturation.
[[nodiscard]] TemporalNoise temporal_noise(const Readout& readout, double mean_e, double exposure_s);

}  // namespace abbe
