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

/// `value` in units of 2^`unit_exponent`, rounded to the nearest; the caller keeps |value| below
/// 2^(unit_exponent + 126).
[[nodiscard]] Int128 to_fixed(double value, int unit_exponent);
[[nodiscard]] double from_fixed(Int128 fixed, int unit_exponent);
/// Adds to a sum. Whether it holds that; else it stays as it is.
[[nodiscard]] inline bool add_exactly(Int128& sum, Int128 more) {
  if (__builtin_add_overflow(sum, more, &more)) return false;
  sum = more;
  return true;
}

/// How large a film is and in what unit it counts; films of equal shape can be added.
struct FilmShape {
  int width;
  int height;
  int channels;
  int replicates;
  int unit_exponent;  ///< Sums are multiples of 2^unit_exponent.
  /// Of each sample, camera paths among them whose lanes a lens takes to several pixels. One may add to many
  /// pixels, so that these are not independent; 0 where none are traced.
  std::uint64_t photons = 0;
  std::uint32_t path_interval = 1;  ///< A pixel has a camera path in one of so many samples.
  std::optional<Crop> crop = {};    ///< Whose pixels alone have sums, the others being 0; absent for all.

  bool operator==(const FilmShape&) const = default;
};

/// The pixels that a film of this shape has sums of.
[[nodiscard]] Crop pixels_of(const FilmShape& shape);
/// Memory of those sums.
[[nodiscard]] std::size_t bytes_of_sums(const FilmShape& shape);

/// Sums of film values per pixel, channel and replicate, in 128-bit fixed point: integer addition is
/// associative, so the sums do not depend on the order, the threads or the partition that made them.
/// Replicates are slices of one sample sequence (`sampling/sampler.h`); the spread of their means bounds the
/// variance of the pixel from above.
class Film {
 public:
  /// `nominal` is the order of magnitude of a film value: values up to 2^44 times it are kept, each rounded
  /// to 2^-67 of it, and 2^16 of the greatest in a sum.
  Film(int width, int height, int channels, int replicates, double nominal, std::uint64_t photons = 0,
       std::uint32_t path_interval = 1, std::optional<Crop> crop = {});
  /// A crop of all pixels is none. Throws Error{resource} when there is no memory for the sums.
  explicit Film(const FilmShape& shape);

  /// Adds one sample's or splat's values, of the channels from `first` on, to a pixel of the crop; any thread
  /// may, at any time. Throws Error{scene} where a sum would be more than it can hold.
  void add(std::size_t pixel, int replicate, std::span<const double> values, std::size_t first = 0);
  /// Whether a value is finite and within what the film can hold.
  [[nodiscard]] bool holds(double value) const { return std::abs(value) < limit_; }

  /// Sets how many samples per pixel each replicate has received.
  void set_samples(std::vector<std::uint64_t> per_replicate);
  /// Adds the sums of a film that differs in its crop at most, of the pixels that both have; its samples are
  /// for the caller to add. Throws Error{scene} where a sum would be more than it can hold.
  void add(const Film& other);
  /// A copy of some replicates, in that order; and they put back, in place of what is there.
  [[nodiscard]] Film only(std::span<const int> replicates) const;
  void put_back(std::span<const int> replicates, const Film& kept);
  /// The sums themselves, for processes that add theirs up.
  [[nodiscard]] std::span<Int128> sums() { return sums_; }
  /// The sums as bytes, 16 a sum, little-endian two's complement, in an order of their own; and the film that
  /// had these, or nothing if there are more or fewer than its shape needs.
  [[nodiscard]] std::string_view bytes() const;
  [[nodiscard]] static std::optional<Film> from_bytes(const FilmShape& shape, std::string_view bytes);

  /// Sum of a pixel's channel over its samples, 0 beyond the crop.
  [[nodiscard]] double total(std::size_t pixel, int channel) const;
  /// Mean of a pixel's channel, and the variance of that mean (0 with fewer than two replicates).
  [[nodiscard]] double mean(std::size_t pixel, int channel) const;
  [[nodiscard]] double variance(std::size_t pixel, int channel) const;
  /// Mean of a channel over some pixels, and its standard error with the degrees of freedom it is estimated
  /// with: Student's t of that many is the law of the mean's deviation in standard errors. Pixels that share
  /// photons count as one, whose replicates tell its error; else each tells its own, and the degrees are
  /// those of the sum [Satterthwaite1946]. Without two replicates the error is 0, of 0 degrees.
  struct Average {
    double mean;
    double standard_error;
    double degrees_of_freedom;
  };
  [[nodiscard]] Average average(int channel) const;
  /// Over x0 <= x < x1, y0 <= y < y1; each pixel divided by its own of `divisors`, where there are any.
  [[nodiscard]] Average average(int channel, int x0, int y0, int x1, int y1,
                                std::span<const double> divisors = {}) const;
  /// Samples per pixel, of all replicates together.
  [[nodiscard]] double samples() const;
  /// How many replicates have samples.
  [[nodiscard]] int filled_replicates() const;

  /// The film as an image: one channel per name, and `Variance.<name>` beside each.
  [[nodiscard]] Image image(std::span<const std::string> names) const;
  /// Of such an image the pixels of an area that has received other samples than `set_samples` tells.
  void develop(Image& image, const Crop& area, std::span<const std::uint64_t> samples) const;

  [[nodiscard]] const FilmShape& shape() const { return shape_; }
  [[nodiscard]] Crop crop() const { return pixels_of(shape_); }
  /// The number of a pixel, whatever the crop.
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
  std::vector<Int128> sums_;  // pixel-major, then replicate, then channel
  std::vector<std::uint64_t> samples_;
  double limit_;  // of what a sum holds
  static constexpr std::size_t kLocks = 4096;
  std::unique_ptr<std::atomic_flag[]> locks_;  // pixels share locks by remainder
};

}  // namespace abbe
