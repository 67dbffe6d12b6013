#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/image.h"
#include "sensor/film/crop.h"

namespace abbe {

__extension__ using Int128 = __int128;

/// Conversion between doubles and fixed point in units of 2^`unit_exponent`, rounded to nearest. `value` must
/// be finite and |value| < 2^(unit_exponent + 126).
[[nodiscard]] Int128 to_fixed(double value, int unit_exponent);
[[nodiscard]] double from_fixed(Int128 fixed, int unit_exponent);
/// Adds to a sum. Returns false on overflow, and then leaves the sum unchanged.
[[nodiscard]] inline bool add_exactly(Int128& sum, Int128 more) {
  if (__builtin_add_overflow(sum, more, &more)) return false;
  sum = more;
  return true;
}

/// Size and unit of a film. Films of equal shape can be added.
struct FilmShape {
  int width;
  int height;
  int channels;
  int replicates;
  int unit_exponent;  ///< Sums are multiples of 2^unit_exponent.
  /// Photons per sample, including camera paths whose wavelengths a lens images to several pixels. One photon
  /// can contribute to many pixels, so these are not independent. 0 if none are traced.
  std::uint64_t photons = 0;
  std::uint32_t path_interval = 1;  ///< Each pixel has a camera path in one of this many samples.
  std::optional<Crop> crop = {};    ///< Pixels that have sums; the others are 0. Absent if all have.

  bool operator==(const FilmShape&) const = default;
};

/// Pixels for which a film of this shape has sums.
[[nodiscard]] Crop pixels_of(const FilmShape& shape);
/// Memory of the sums of such a film.
[[nodiscard]] std::size_t bytes_of_sums(const FilmShape& shape);

/// Sums of film values per pixel, channel and replicate in 128-bit fixed point. Integer addition is
/// associative, so the sums do not depend on the order, the threads or the partition of the work. Replicates
/// are slices of one sample sequence (`sampling/sampler.h`). The spread of their means is an upper bound on
/// the variance of the pixel. Except for adding samples, methods that change a film need exclusive access.
class Film {
 public:
  /// Creates a film for values of the order of magnitude `nominal`; 0 or less counts as 1. It holds values up
  /// to 2^44 times that, rounded to 2^-67 of it, and sums of 2^16 of the largest values. The other parameters
  /// are members of `FilmShape`. Throws Error{resource} if memory does not suffice.
  Film(int width, int height, int channels, int replicates, double nominal, std::uint64_t photons = 0,
       std::uint32_t path_interval = 1, std::optional<Crop> crop = {});
  /// Creates a film of this shape. A crop of all pixels is equivalent to none. Throws Error{resource} if
  /// memory does not suffice.
  explicit Film(const FilmShape& shape);

  /// Adds the values of one sample or splat to the pixel of this index (`pixel_at`) in the crop, for the
  /// channels from `first` on. The caller ensures that the film `holds` the values. Thread-safe. Throws
  /// Error{scene} if a sum overflows.
  void add(std::size_t pixel, int replicate, std::span<const double> values, std::size_t first = 0);
  /// True if a value is finite and small enough for the film.
  [[nodiscard]] bool holds(double value) const { return std::abs(value) < limit_; }

  /// Sets the number of samples per pixel of each replicate, 0 in a new film.
  void set_samples(std::vector<std::uint64_t> per_replicate);
  /// Adds the sums of a film that differs at most in its crop, for the pixels that both have; not the numbers
  /// of samples. Throws Error{scene} if a sum overflows.
  void add(const Film& other);
  /// `only` copies the sums of some replicates, without numbers of samples. It throws Error{resource} if
  /// memory does not suffice. `put_back` restores the sums from such a copy.
  [[nodiscard]] Film only(std::span<const int> replicates) const;
  void put_back(std::span<const int> replicates, const Film& saved);
  /// The sums in the internal order of the film, for processes that add them up.
  [[nodiscard]] std::span<Int128> sums() { return sums_; }
  /// Conversion between the sums and bytes: 16 per sum, little-endian two's complement, in the film's
  /// internal order. `from_bytes` gives nothing if their number does not fit the shape, and throws
  /// Error{resource} if memory does not suffice. Its film has no numbers of samples.
  [[nodiscard]] std::string_view bytes() const;
  [[nodiscard]] static std::optional<Film> from_bytes(const FilmShape& shape, std::string_view bytes);

  /// Sum over the samples of a pixel; 0 outside the crop.
  [[nodiscard]] double total(std::size_t pixel, int channel) const;
  /// Mean of a channel over the samples of a pixel, and the variance of that mean. Both are 0 outside the
  /// crop and without samples. The variance is also 0 with fewer than two filled replicates.
  [[nodiscard]] double mean(std::size_t pixel, int channel) const;
  [[nodiscard]] double variance(std::size_t pixel, int channel) const;
  /// Mean of a channel over some pixels, in units of the channel, with its standard error and degrees of
  /// freedom. The deviation of the mean in standard errors follows Student's t with these degrees. If photons
  /// are traced, pixels are correlated and the replicates of their sum give the error. Otherwise the
  /// variances of the pixels add up, with the degrees of their sum [Satterthwaite1946]. Error and degrees are
  /// 0 without two filled replicates.
  struct Average {
    double mean;
    double standard_error;
    double degrees_of_freedom;
  };
  [[nodiscard]] Average average(int channel) const;  ///< Average over the whole film.
  /// Average over x0 <= x < x1, y0 <= y < y1, where pixels outside the crop count as 0. `divisors`, one per
  /// pixel of the film if any, divide each pixel by a number of its own.
  [[nodiscard]] Average average(int channel, int x0, int y0, int x1, int y1,
                                std::span<const double> divisors = {}) const;
  [[nodiscard]] double samples() const;         ///< Samples per pixel, summed over the replicates.
  [[nodiscard]] int filled_replicates() const;  ///< Number of replicates that have samples.

  /// The means of all channels under their `names`, at least one each, then their variances under
  /// `Variance.<name>`. Pixels outside the crop are 0.
  [[nodiscard]] Image image(std::span<const std::string> names) const;
  /// Updates the pixels of an area within the crop in such an image for samples per replicate that differ
  /// from those of `set_samples`.
  void develop(Image& image, const Crop& area, std::span<const std::uint64_t> samples) const;

  [[nodiscard]] const FilmShape& shape() const { return shape_; }
  [[nodiscard]] Crop crop() const { return pixels_of(shape_); }  ///< Pixels that have sums.
  /// Index of a pixel in the whole film.
  [[nodiscard]] std::size_t pixel_at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(shape_.width) + static_cast<std::size_t>(x);
  }
  [[nodiscard]] int width() const { return shape_.width; }
  [[nodiscard]] int height() const { return shape_.height; }
  [[nodiscard]] int channels() const { return shape_.channels; }
  [[nodiscard]] int replicates() const { return shape_.replicates; }
  [[nodiscard]] std::size_t memory_bytes() const { return sums_.size() * sizeof(Int128); }

 private:
  [[nodiscard]] bool has(std::size_t pixel) const;
  [[nodiscard]] std::size_t index(std::size_t pixel, int replicate) const;
  [[nodiscard]] double value(std::size_t pixel, int replicate, int channel) const;

  FilmShape shape_;
  std::vector<Int128> sums_;  // by pixel, then replicate, then channel
  std::vector<std::uint64_t> samples_;
  double limit_;  // largest value
  static constexpr std::size_t kLocks = 4096;
  std::unique_ptr<std::atomic_flag[]> locks_;  // pixel i uses lock i modulo kLocks
};

}  // namespace abbe
