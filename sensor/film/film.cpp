#include "sensor/film/film.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

#include "io/error.h"

namespace abbe {
namespace {

// Division of the 127 bits of a sum: above the nominal value, for the number of values, and below the nominal
// value.
constexpr int kHeadroomBits = 44;
constexpr int kCountBits = 16;
constexpr int kFractionBits = 127 - kHeadroomBits - kCountBits;

std::size_t sums_of(const FilmShape& shape) {
  return pixel_count(pixels_of(shape)) * static_cast<std::size_t>(shape.channels) *
         static_cast<std::size_t>(shape.replicates);
}

FilmShape without_needless_crop(FilmShape shape) {
  if (shape.crop == Crop{0, 0, shape.width, shape.height}) shape.crop.reset();
  return shape;
}

/// Holds a spin lock during its lifetime.
class Locked {
 public:
  explicit Locked(std::atomic_flag& lock) : lock_(lock) {
    while (lock_.test_and_set(std::memory_order_acquire)) {
    }
  }
  ~Locked() { lock_.clear(std::memory_order_release); }
  Locked(const Locked&) = delete;
  Locked& operator=(const Locked&) = delete;

 private:
  std::atomic_flag& lock_;
};

// Compensated summation [Kahan1965]: as accurate as a double, and without the limit that integer sums over
// many pixels have.
struct CompensatedSum {
  double value = 0;
  double lost = 0;  // amount that was added in excess

  void add(double term) {
    const double rest = term - lost;
    const double next = value + rest;
    lost = (next - value) - rest;
    value = next;
  }
};

void add_to(Int128& sum, Int128 more) {
  if (!add_exactly(sum, more))
    throw Error(ErrorCode::scene, "film",
                "a pixel is far brighter than the lights of the scene suggest, and the sum of its samples "
                "exceeds the range of the film: check for a light very close to a surface or a meter");
}

template <typename SumOf>
double total_of(std::size_t replicates, SumOf sum_of) {
  double total = 0;
  for (std::size_t r = 0; r < replicates; ++r) total += sum_of(static_cast<int>(r));
  return total;
}

// Mean, or variance of the mean, of replicates with the sums `sum_of(replicate)` over `samples[replicate]`
// samples.
template <typename SumOf>
double mean_of(std::span<const std::uint64_t> samples, SumOf sum_of) {
  const double total = total_of(samples.size(), sum_of);
  const std::uint64_t count = std::accumulate(samples.begin(), samples.end(), std::uint64_t{0});
  return count == 0 ? 0 : total / static_cast<double>(count);
}

template <typename SumOf>
double sample_variance(std::span<const std::uint64_t> samples, SumOf sum_of) {
  const double center = mean_of(samples, sum_of);
  const auto count = static_cast<double>(std::accumulate(samples.begin(), samples.end(), std::uint64_t{0}));
  double spread = 0;
  int filled = 0;
  for (std::size_t r = 0; r < samples.size(); ++r) {
    const auto n = static_cast<double>(samples[r]);
    if (n == 0) continue;
    ++filled;
    const double m = sum_of(static_cast<int>(r)) / n;
    spread += n / count * (m - center) * (m - center);
  }
  return filled < 2 ? 0 : spread / (filled - 1);
}

}  // namespace

Crop pixels_of(const FilmShape& shape) {
  return shape.crop.value_or(Crop{0, 0, shape.width, shape.height});
}

std::size_t bytes_of_sums(const FilmShape& shape) {
  return sums_of(shape) * sizeof(Int128);
}

Int128 to_fixed(double value, int unit_exponent) {
  // value = mantissa 2^exponent, read from its bits; subnormal numbers have no leading 1.
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const auto field = static_cast<int>(bits >> 52) & 0x7ff;
  const std::uint64_t digits = (bits & 0xfffffffffffffU) | (field > 0 ? 0x10000000000000U : 0U);
  const auto mantissa = static_cast<std::int64_t>(bits >> 63 ? -digits : digits);
  const int shift = std::max(field, 1) - 1075 - unit_exponent;
  if (shift >= 0) return static_cast<Int128>(mantissa) * (static_cast<Int128>(1) << shift);
  if (shift < -62) return 0;
  const std::int64_t half = std::int64_t{1} << (-shift - 1);
  return mantissa >= 0 ? (mantissa + half) >> -shift : -((-mantissa + half) >> -shift);
}

// Writes a normal power of two directly into the exponent bits, because films convert millions of values.
double from_fixed(Int128 fixed, int unit_exponent) {
  const auto mantissa = static_cast<double>(fixed);
  if (unit_exponent < -1022 || unit_exponent > 1023) return std::ldexp(mantissa, unit_exponent);
  return mantissa * std::bit_cast<double>(static_cast<std::uint64_t>(unit_exponent + 1023) << 52);
}

Film::Film(int width, int height, int channels, int replicates, double nominal, std::uint64_t photons,
           std::uint32_t path_interval, std::optional<Crop> crop)
    : Film(FilmShape{width, height, channels, replicates,
                     (nominal > 0 ? std::ilogb(nominal) : 0) - kFractionBits, photons, path_interval, crop}) {
}

Film::Film(const FilmShape& shape)
    : shape_(without_needless_crop(shape)),
      samples_(static_cast<std::size_t>(shape.replicates), 0),
      limit_(std::ldexp(1.0, shape.unit_exponent + kFractionBits + kHeadroomBits)),
      locks_(std::make_unique<std::atomic_flag[]>(kLocks)) {
  try {
    sums_.assign(sums_of(shape), 0);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::resource, "film", "not enough memory for its sums");
  }
}

bool Film::has(std::size_t pixel) const {
  if (!shape_.crop) return true;
  const auto x = static_cast<int>(pixel % static_cast<std::size_t>(shape_.width));
  const auto y = static_cast<int>(pixel / static_cast<std::size_t>(shape_.width));
  const Crop& c = *shape_.crop;
  return x >= c.x0 && x < c.x1 && y >= c.y0 && y < c.y1;
}

std::size_t Film::index(std::size_t pixel, int replicate) const {
  if (const std::optional<Crop>& c = shape_.crop) {
    const auto width = static_cast<std::size_t>(shape_.width);
    pixel = (pixel / width - static_cast<std::size_t>(c->y0)) * static_cast<std::size_t>(c->x1 - c->x0) +
            pixel % width - static_cast<std::size_t>(c->x0);
  }
  return (pixel * static_cast<std::size_t>(shape_.replicates) + static_cast<std::size_t>(replicate)) *
         static_cast<std::size_t>(shape_.channels);
}

void Film::add(std::size_t pixel, int replicate, std::span<const double> values, std::size_t first) {
  const Locked locked(locks_[pixel % kLocks]);
  Int128* sum = &sums_[index(pixel, replicate) + first];
  for (const double value : values) {
    if (value != 0) add_to(*sum, to_fixed(value, shape_.unit_exponent));  // most values of a dark pixel are 0
    ++sum;
  }
}

void Film::set_samples(std::vector<std::uint64_t> per_replicate) {
  samples_ = std::move(per_replicate);
}

void Film::add(const Film& other) {
  const Crop own = crop();
  const Crop of = other.crop();
  const int x0 = std::max(own.x0, of.x0);
  const auto row =
      std::max(std::min(own.x1, of.x1) - x0, 0) * std::ptrdiff_t{shape_.channels} * shape_.replicates;
  for (int y = std::max(own.y0, of.y0); row > 0 && y < std::min(own.y1, of.y1); ++y) {
    const Int128* more = &other.sums_[other.index(pixel_at(x0, y), 0)];
    Int128* sums = &sums_[index(pixel_at(x0, y), 0)];
    for (std::ptrdiff_t i = 0; i < row; ++i) add_to(sums[i], more[i]);
  }
}

Film Film::only(std::span<const int> replicates) const {
  FilmShape shape = shape_;
  shape.replicates = static_cast<int>(replicates.size());
  Film some(shape);
  auto to = some.sums_.begin();
  const std::ptrdiff_t pixel = std::ptrdiff_t{shape_.replicates} * shape_.channels;
  for (auto from = sums_.begin(); from != sums_.end(); from += pixel)
    for (const int r : replicates)
      to = std::copy_n(from + std::ptrdiff_t{r} * shape_.channels, shape_.channels, to);
  return some;
}

void Film::put_back(std::span<const int> replicates, const Film& saved) {
  auto from = saved.sums_.begin();
  const std::ptrdiff_t pixel = std::ptrdiff_t{shape_.replicates} * shape_.channels;
  for (auto to = sums_.begin(); to != sums_.end(); to += pixel)
    for (const int r : replicates) {
      std::copy_n(from, shape_.channels, to + std::ptrdiff_t{r} * shape_.channels);
      from += shape_.channels;
    }
}

std::string_view Film::bytes() const {
  return {reinterpret_cast<const char*>(sums_.data()), memory_bytes()};
}

std::optional<Film> Film::from_bytes(const FilmShape& shape, std::string_view bytes) {
  static_assert(std::endian::native == std::endian::little);
  if (bytes.size() / sizeof(Int128) != sums_of(shape) || bytes.size() % sizeof(Int128) != 0)
    return std::nullopt;
  Film film(shape);
  std::memcpy(film.sums_.data(), bytes.data(), bytes.size());
  return film;
}

double Film::samples() const {
  return static_cast<double>(std::accumulate(samples_.begin(), samples_.end(), std::uint64_t{0}));
}

int Film::filled_replicates() const {
  return static_cast<int>(std::ranges::count_if(samples_, [](std::uint64_t n) { return n > 0; }));
}

double Film::value(std::size_t pixel, int replicate, int channel) const {
  return from_fixed(sums_[index(pixel, replicate) + static_cast<std::size_t>(channel)], shape_.unit_exponent);
}

double Film::total(std::size_t pixel, int channel) const {
  if (!has(pixel)) return 0;
  return total_of(samples_.size(), [&](int r) { return value(pixel, r, channel); });
}

double Film::mean(std::size_t pixel, int channel) const {
  return has(pixel) ? mean_of(samples_, [&](int r) { return value(pixel, r, channel); }) : 0;
}

double Film::variance(std::size_t pixel, int channel) const {
  return has(pixel) ? sample_variance(samples_, [&](int r) { return value(pixel, r, channel); }) : 0;
}

Film::Average Film::average(int channel) const {
  return average(channel, 0, 0, shape_.width, shape_.height);
}

Film::Average Film::average(int channel, int x0, int y0, int x1, int y1,
                            std::span<const double> divisors) const {
  std::vector<CompensatedSum> sums(static_cast<std::size_t>(shape_.replicates));
  const auto sum_of = [&sums](int r) { return sums[static_cast<std::size_t>(r)].value; };
  double variances = 0;
  double squares = 0;
  const Crop own = crop();
  for (int y = std::max(y0, own.y0); y < std::min(y1, own.y1); ++y)
    for (int x = std::max(x0, own.x0); x < std::min(x1, own.x1); ++x) {
      const std::size_t pixel = pixel_at(x, y);
      const double divisor = divisors.empty() ? 1 : divisors[pixel];
      for (int r = 0; r < shape_.replicates; ++r)
        sums[static_cast<std::size_t>(r)].add(value(pixel, r, channel) / divisor);
      const double of_pixel = shape_.photons > 0 ? 0 : variance(pixel, channel) / (divisor * divisor);
      variances += of_pixel;
      squares += of_pixel * of_pixel;
    }
  const double pixels = static_cast<double>(x1 - x0) * (y1 - y0);
  const double f = filled_replicates() - 1;
  if (shape_.photons > 0) {
    variances = sample_variance(samples_, sum_of);
    squares = variances * variances;
  }
  // The variance of a variance estimate V with d degrees of freedom is 2 V^2/d. The square of an estimate
  // with f degrees is too large by the factor 1 + 2/f on average.
  const double degrees = squares > 0 ? (f + 2) * variances * variances / squares - 2 : std::max(f, 0.0);
  return {mean_of(samples_, sum_of) / pixels, std::sqrt(variances) / pixels, degrees};
}

Image Film::image(std::span<const std::string> names) const {
  Image image{shape_.width, shape_.height, {}, {}};
  for (const bool variances : {false, true})
    for (const std::string& name : names.first(static_cast<std::size_t>(shape_.channels)))
      image.channels.push_back({variances ? "Variance." + name : name, std::vector<float>(image.pixels())});
  develop(image, crop(), samples_);
  return image;
}

void Film::develop(Image& image, const Crop& area, std::span<const std::uint64_t> samples) const {
  for (int channel = 0; channel < shape_.channels; ++channel) {
    std::vector<float>& means = image.channels[static_cast<std::size_t>(channel)].values;
    std::vector<float>& variances =
        image.channels[static_cast<std::size_t>(channel + shape_.channels)].values;
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x) {
        const std::size_t pixel = pixel_at(x, y);
        const auto sum_of = [&](int r) { return value(pixel, r, channel); };
        means[pixel] = static_cast<float>(mean_of(samples, sum_of));
        variances[pixel] = static_cast<float>(sample_variance(samples, sum_of));
      }
  }
}

}  // namespace abbe
