#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace abbe {

/// How many wavelengths one path carries.
inline constexpr int kLanes = 8;

/// One value per wavelength of a packet.
struct SampledSpectrum {
  alignas(32) std::array<float, kLanes> values{};

  SampledSpectrum() = default;
  explicit SampledSpectrum(float value) { values.fill(value); }

  [[nodiscard]] float operator[](int lane) const { return values[static_cast<std::size_t>(lane)]; }
  [[nodiscard]] float& operator[](int lane) { return values[static_cast<std::size_t>(lane)]; }

  SampledSpectrum& operator+=(const SampledSpectrum& o) {
    return *this = map(*this, o, [](float a, float b) { return a + b; });
  }
  SampledSpectrum& operator*=(const SampledSpectrum& o) {
    return *this = map(*this, o, [](float a, float b) { return a * b; });
  }
  SampledSpectrum& operator*=(float s) { return *this *= SampledSpectrum(s); }
  friend SampledSpectrum operator+(SampledSpectrum a, const SampledSpectrum& b) { return a += b; }
  friend SampledSpectrum operator*(SampledSpectrum a, const SampledSpectrum& b) { return a *= b; }
  friend SampledSpectrum operator*(SampledSpectrum a, float s) { return a *= s; }
  friend SampledSpectrum operator*(float s, SampledSpectrum a) { return a *= s; }
  friend SampledSpectrum operator-(const SampledSpectrum& a, const SampledSpectrum& b) {
    return map(a, b, [](float x, float y) { return x - y; });
  }
  friend SampledSpectrum operator/(const SampledSpectrum& a, const SampledSpectrum& b) {
    return map(a, b, [](float x, float y) { return x / y; });
  }

  [[nodiscard]] float sum() const {
    float total = 0;
    for (float v : values) total += v;
    return total;
  }
  [[nodiscard]] float mean() const { return sum() / kLanes; }
  [[nodiscard]] float max() const { return *std::max_element(values.begin(), values.end()); }
  [[nodiscard]] bool is_zero() const {
    return std::all_of(values.begin(), values.end(), [](float v) { return v == 0.0F; });
  }

  /// `f` applied lane by lane.
  template <typename F>
  [[nodiscard]] static SampledSpectrum map(const SampledSpectrum& a, const SampledSpectrum& b, F f) {
    SampledSpectrum r;
    for (std::size_t i = 0; i < kLanes; ++i) r.values[i] = f(a.values[i], b.values[i]);
    return r;
  }
  template <typename F>
  [[nodiscard]] static SampledSpectrum map(const SampledSpectrum& a, F f) {
    SampledSpectrum r;
    for (std::size_t i = 0; i < kLanes; ++i) r.values[i] = f(a.values[i]);
    return r;
  }
};

/// The wavelengths a path carries, each with the density it was drawn from.
struct SampledWavelengths {
  SampledSpectrum lambda_nm;  ///< [nm], in standard air.
  SampledSpectrum pdf;        ///< [1/nm], positive.
};

}  // namespace abbe
