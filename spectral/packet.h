#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace abbe {

/// How many wavelengths one path carries, a power of two.
inline constexpr int kLanes = 8;
static_assert((kLanes & (kLanes - 1)) == 0);

/// One value per wavelength of a packet, held as one vector of the machine: an array would be copied in
/// pieces, and loading the whole after storing its pieces waits for memory.
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
  [[nodiscard]] bool is_zero() const { return !any(lanes_ != Lanes{}); }
  [[nodiscard]] bool has_nan() const { return any(lanes_ != lanes_); }

  /// `f` applied lane by lane.
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

  // Whether a comparison, which leaves all bits of a lane set or none, holds in any: there is an instruction
  // for eight.
  template <typename Verdicts>
  [[nodiscard]] static bool any(const Verdicts& verdicts) {
    if constexpr (sizeof(Verdicts) == 8 * sizeof(float)) {
      return __builtin_ia32_movmskps256(std::bit_cast<Lanes>(verdicts)) != 0;
    } else {
      bool found = false;
      for (int lane = 0; lane < kLanes; ++lane) found = found || verdicts[lane] != 0;
      return found;
    }
  }

  // `f` over all lanes, halves upon halves: three steps that each wait for the one before, instead of seven.
  template <typename F>
  [[nodiscard]] float fold(F f) const {
    Values v = values();
    for (std::size_t half = kLanes / 2; half > 0; half /= 2)
      for (std::size_t i = 0; i < half; ++i) v[i] = f(v[i], v[i + half]);
    return v[0];
  }

  Lanes lanes_{};
};

/// What is left of light after a distance [m], perhaps an infinite one, lane by lane: e^-(a d) by Beer's law,
/// to a few float steps, and 0 where that is below the least normal float. Where nothing is lost an infinite
/// distance makes no difference. With n the integer nearest to x/ln 2, e^x = 2^n e^r, the latter by its
/// series.
[[nodiscard]] inline SampledSpectrum transmittance(const SampledSpectrum& extinction_per_m, float distance) {
  using Lanes = SampledSpectrum::Lanes;
  using Integers [[gnu::vector_size(sizeof(Lanes))]] = std::int32_t;
  constexpr float kLeast = -87;
  constexpr float kLog2e = std::numbers::log2e_v<float>;
  constexpr float kLn2Head = 0x1.62e4p-1F;  // short enough for n times it to be exact
  constexpr auto kLn2Tail = static_cast<float>(std::numbers::ln2 - static_cast<double>(kLn2Head));
  const Lanes a = extinction_per_m.lanes_;
  const Lanes x = -a * (a > 0 ? distance - Lanes{} : Lanes{});
  const Lanes bounded = x > kLeast ? x : kLeast - Lanes{};
  const auto n = __builtin_convertvector(bounded * kLog2e - 0.5F, Integers);
  const auto whole = __builtin_convertvector(n, Lanes);
  const Lanes r = bounded - whole * kLn2Head - whole * kLn2Tail;
  const Lanes series =
      1 + r * (1 + r * (1.0F / 2 + r * (1.0F / 6 + r * (1.0F / 24 + r * (1.0F / 120 + r * (1.0F / 720))))));
  return SampledSpectrum(x > kLeast ? series * std::bit_cast<Lanes>((n + 127) << 23) : Lanes{});
}

/// The wavelengths a path carries, each with the density it was drawn from.
struct SampledWavelengths {
  SampledSpectrum lambda_nm;  ///< [nm], in standard air.
  SampledSpectrum pdf;        ///< [1/nm], positive.
};

}  // namespace abbe
