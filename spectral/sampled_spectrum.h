#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace abbe {

/// Number of wavelengths of one path (lanes of a register), a power of two.
inline constexpr int kLanes = 8;
static_assert((kLanes & (kLanes - 1)) == 0);

/// One value per wavelength of a path, in one SIMD register. The default is 0, and arithmetic acts on each
/// lane. An array would be copied in pieces, and reloading it as a whole would stall on the stores.
class SampledSpectrum {
 public:
  using Values = std::array<float, kLanes>;

  SampledSpectrum() = default;
  explicit SampledSpectrum(float value) : lanes_(value - Lanes{}) {}
  explicit SampledSpectrum(const Values& values) : lanes_(std::bit_cast<Lanes>(values)) {}
  /// `value` in one lane, 0 in the others.
  [[nodiscard]] static SampledSpectrum only(int lane, float value) {
    Values values{};
    values[static_cast<std::size_t>(lane)] = value;
    return SampledSpectrum(values);
  }

  [[nodiscard]] float operator[](int lane) const { return lanes_[lane]; }
  [[nodiscard]] Values values() const { return std::bit_cast<Values>(lanes_); }

  SampledSpectrum& operator+=(const SampledSpectrum& o) { return *this = *this + o; }
  SampledSpectrum& operator*=(const SampledSpectrum& o) { return *this = *this * o; }
  SampledSpectrum& operator*=(float s) { return *this = *this * s; }
  friend SampledSpectrum operator+(const SampledSpectrum& a, const SampledSpectrum& b) {
    return SampledSpectrum(a.lanes_ + b.lanes_);
  }
  friend SampledSpectrum operator-(const SampledSpectrum& a, const SampledSpectrum& b) {
    return SampledSpectrum(a.lanes_ - b.lanes_);
  }
  friend SampledSpectrum operator*(const SampledSpectrum& a, const SampledSpectrum& b) {
    return SampledSpectrum(a.lanes_ * b.lanes_);
  }
  friend SampledSpectrum operator/(const SampledSpectrum& a, const SampledSpectrum& b) {
    return SampledSpectrum(a.lanes_ / b.lanes_);
  }
  friend SampledSpectrum operator*(const SampledSpectrum& a, float s) {
    return SampledSpectrum(a.lanes_ * s);
  }
  friend SampledSpectrum operator*(float s, const SampledSpectrum& a) { return a * s; }
  friend SampledSpectrum transmittance(const SampledSpectrum& extinction_per_m, float distance);

  [[nodiscard]] float sum() const {
    return fold([](float a, float b) { return a + b; });
  }
  [[nodiscard]] float mean() const { return sum() / kLanes; }
  [[nodiscard]] float max() const {
    return fold([](float a, float b) { return a < b ? b : a; });
  }
  [[nodiscard]] float min() const {
    return fold([](float a, float b) { return b < a ? b : a; });
  }
  /// True if all lanes are 0.
  [[nodiscard]] bool is_zero() const { return !any(lanes_ != Lanes{}); }
  /// True if any lane is NaN.
  [[nodiscard]] bool has_nan() const { return any(lanes_ != lanes_); }

  /// Result of `f` for each lane of one spectrum or of two.
  template <typename F>
  [[nodiscard]] static SampledSpectrum map(const SampledSpectrum& a, const SampledSpectrum& b, F f) {
    const Values x = a.values();
    const Values y = b.values();
    Values r;
    for (std::size_t i = 0; i < kLanes; ++i) r[i] = f(x[i], y[i]);
    return SampledSpectrum(r);
  }
  template <typename F>
  [[nodiscard]] static SampledSpectrum map(const SampledSpectrum& a, F f) {
    const Values x = a.values();
    Values r;
    for (std::size_t i = 0; i < kLanes; ++i) r[i] = f(x[i]);
    return SampledSpectrum(r);
  }

 private:
  using Lanes [[gnu::vector_size(kLanes * sizeof(float))]] = float;

  explicit SampledSpectrum(const Lanes& lanes) : lanes_(lanes) {}

  // True if a comparison, which sets all bits of a lane or none, holds in any lane. Eight lanes need one
  // instruction.
  template <typename Verdicts>
  [[nodiscard]] static bool any(const Verdicts& verdicts) {
    if constexpr (sizeof(Verdicts) == 8 * sizeof(float)) {
      return __builtin_ia32_movmskps256(std::bit_cast<Lanes>(verdicts)) != 0;
    } else {
      bool any_set = false;
      for (int lane = 0; lane < kLanes; ++lane) any_set = any_set || verdicts[lane] != 0;
      return any_set;
    }
  }

  // Reduces the lanes with `f` by repeated halving: three dependent steps instead of seven.
  template <typename F>
  [[nodiscard]] float fold(F f) const {
    Values v = values();
    for (std::size_t half = kLanes / 2; half > 0; half /= 2)
      for (std::size_t i = 0; i < half; ++i) v[i] = f(v[i], v[i + half]);
    return v[0];
  }

  Lanes lanes_{};
};

/// Transmittance e^-(a d) of each wavelength over a distance d >= 0 [m] by Beer's law, with a the extinction.
/// The distance may be infinite. An extinction of 0 or less gives 1. Accurate to a few float ulps, and 0
/// below the smallest normal float. Computes e^x = 2^n e^r, where x is -a d, n the integer nearest to x/ln 2,
/// and e^r a power series.
[[nodiscard]] inline SampledSpectrum transmittance(const SampledSpectrum& extinction_per_m, float distance) {
  using Lanes = SampledSpectrum::Lanes;
  using Integers [[gnu::vector_size(sizeof(Lanes))]] = std::int32_t;
  constexpr float kMinExponent = -87;
  constexpr float kLog2e = std::numbers::log2e_v<float>;
  constexpr float kLn2Head = 0x1.62e4p-1F;  // short, so that its product with n is exact
  constexpr auto kLn2Tail = static_cast<float>(std::numbers::ln2 - static_cast<double>(kLn2Head));
  const Lanes a = extinction_per_m.lanes_;
  const Lanes x = -a * (a > 0 ? distance - Lanes{} : Lanes{});
  const Lanes bounded = x > kMinExponent ? x : kMinExponent - Lanes{};
  const auto n = __builtin_convertvector(bounded * kLog2e - 0.5F, Integers);
  const auto whole = __builtin_convertvector(n, Lanes);
  const Lanes r = bounded - whole * kLn2Head - whole * kLn2Tail;
  const Lanes series =
      1 + r * (1 + r * (1.0F / 2 + r * (1.0F / 6 + r * (1.0F / 24 + r * (1.0F / 120 + r * (1.0F / 720))))));
  return SampledSpectrum(x > kMinExponent ? series * std::bit_cast<Lanes>((n + 127) << 23) : Lanes{});
}

/// Wavelengths of a path, and the pdf of each.
struct SampledWavelengths {
  SampledSpectrum lambda_nm;  ///< Wavelengths in standard air [nm].
  SampledSpectrum pdf;        ///< Their pdfs [1/nm], positive.
};

}  // namespace abbe
