#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "materials/index/dispersion.h"
#include "spectral/curve.h"

namespace abbe {

/// A value of k larger than that of any glass or varnish, smaller than that of any metal.
inline constexpr double kLargestGlassK = 1e-3;

/// Tabulates a function of the wavelength [nm] every 1 nm from 300 to 1100 nm.
template <typename F>
[[nodiscard]] Curve each_nm(F quantity) {
  std::vector<Knot> knots;
  for (double nm = kMinWavelengthNm; nm <= kMaxWavelengthNm; nm += 1) knots.push_back({nm, quantity(nm)});
  return Curve(std::move(knots));
}

/// The medium relative to which a tabulated index holds.
enum class IndexMedium { air, vacuum };

/// An error message if `n` and `k` cannot be a refractive index: n <= 0 or k < 0 somewhere in [300, 1100] nm.
/// Empty otherwise.
[[nodiscard]] std::optional<std::string> index_fault(const Curve& n, const Curve& k);

/// A range of wavelengths [nm] with measured data, including both ends.
struct DataRange {
  double low_nm, high_nm;
  [[nodiscard]] bool contains(double nm) const { return low_nm <= nm && nm <= high_nm; }
};

/// The extinction coefficient k, 0 or more, and the range in which it was measured.
struct Extinction {
  Curve k;
  DataRange range;
};

/// A complex refractive index n + ik over wavelength, with the medium and the range of its data. Wavelengths
/// are in standard air. The constructors do not check values; no function throws. Outside [low_nm, high_nm] n
/// has the value at the nearer end; so does k outside `k_range`. If k was never measured, it is 0. The packet
/// functions hold for 300-1100 nm, where they agree with the double functions to 1e-5.
class RefractiveIndex {
 public:
  /// A constant, non-dispersive n + ik relative to air, valid at all wavelengths; its k counts as measured.
  explicit RefractiveIndex(double n, double k = 0);
  /// A dispersion formula, valid on [low_nm, high_nm], with k if it was measured; both are relative to
  /// `medium`.
  RefractiveIndex(const DispersionFormula& formula, std::optional<Extinction> k, IndexMedium medium,
                  double low_nm, double high_nm);
  /// Tabulated n, valid on [low_nm, high_nm], with k if it was measured; both are relative to `medium`.
  RefractiveIndex(Curve n, std::optional<Extinction> k, IndexMedium medium, double low_nm, double high_nm);
  /// Tabulated n and k, both valid on [low_nm, high_nm] and relative to `medium`.
  RefractiveIndex(Curve n, Curve k, IndexMedium medium, double low_nm, double high_nm);

  /// A copy with `k`, relative to air and valid at all wavelengths, in place of its own k.
  [[nodiscard]] RefractiveIndex with_k(Curve k) const;

  /// Catalogued n and k at a wavelength [nm], relative to `medium()`.
  [[nodiscard]] double catalogued_n(double wavelength_nm) const;
  [[nodiscard]] double catalogued_k(double wavelength_nm) const;

  /// n and k relative to air, as the renderer uses them. Values relative to vacuum are divided by the index
  /// of air.
  [[nodiscard]] double n(double wavelength_nm) const;
  [[nodiscard]] double k(double wavelength_nm) const;
  [[nodiscard]] SampledSpectrum n(const SampledSpectrum& wavelengths_nm) const;
  [[nodiscard]] SampledSpectrum k(const SampledSpectrum& wavelengths_nm) const;

  /// Power absorption coefficient 4 pi k / lambda [1/m].
  [[nodiscard]] double absorption_per_m(double wavelength_nm) const;
  [[nodiscard]] SampledSpectrum absorption_per_m(const SampledSpectrum& wavelengths_nm) const;

  [[nodiscard]] bool dispersive() const;  ///< True if n depends on wavelength.
  [[nodiscard]] bool absorbing() const;   ///< True if k > 0 somewhere in [300, 1100] nm.
  [[nodiscard]] IndexMedium medium() const { return medium_; }  ///< That of the catalogued values.
  /// The range in which n is valid [nm]; 0 to infinity for a constant.
  [[nodiscard]] double low_nm() const { return low_nm_; }
  [[nodiscard]] double high_nm() const { return high_nm_; }
  /// Range in which k was measured; empty if k was never measured.
  [[nodiscard]] const std::optional<DataRange>& k_range() const { return k_range_; }
  /// True if k was measured at a wavelength [nm].
  [[nodiscard]] bool has_measured_k(double wavelength_nm) const {
    return k_range_ && k_range_->contains(wavelength_nm);
  }

 private:
  struct Constant {
    double n;
  };
  void take(std::optional<Extinction> k);
  void bake();

  std::variant<Constant, DispersionFormula, Curve> n_;
  Curve k_;
  std::optional<DataRange> k_range_;
  std::optional<Curve> baked_n_;  // n relative to air every 1 nm, for formulas with powers and vacuum tables
  std::optional<Curve> baked_k_;  // k relative to air, for vacuum tables
  IndexMedium medium_ = IndexMedium::air;
  double low_nm_;
  double high_nm_;
};

}  // namespace abbe
