#pragma once

#include <optional>
#include <string>
#include <variant>

#include "materials/index/dispersion.h"
#include "spectral/curve.h"

namespace abbe {

/// More k than any glass or varnish has, and less than any metal.
inline constexpr double kLargestGlassK = 1e-3;

/// What a catalogued index is relative to.
enum class IndexMedium { air, vacuum };

/// Why `n` and `k` cannot be an index: n <= 0 or k < 0 somewhere in [300, 1100] nm. Nothing when they can.
[[nodiscard]] std::optional<std::string> index_fault(const Curve& n, const Curve& k);

/// The wavelengths [nm] between which something is measured.
struct DataRange {
  double low_nm, high_nm;
  [[nodiscard]] bool contains(double nm) const { return low_nm <= nm && nm <= high_nm; }
};

/// An extinction k, 0 or more, with where it is measured.
struct Extinction {
  Curve k;
  DataRange range;
};

/// A complex refractive index n + ik over wavelength: catalogued numbers with what they are relative to and
/// where they hold. Outside [low_nm, high_nm] n keeps its value at the nearer end, as k does outside its
/// `k_range`; a k that is measured nowhere is 0. Packets agree with the double functions to 1e-5.
class RefractiveIndex {
 public:
  /// A constant, non-dispersive n + ik.
  explicit RefractiveIndex(double n, double k = 0);
  /// A dispersion formula, valid on [low_nm, high_nm], with the k that is measured beside it, if one is.
  RefractiveIndex(const DispersionFormula& formula, std::optional<Extinction> k, IndexMedium medium,
                  double low_nm, double high_nm);
  /// Tabulated n, valid on [low_nm, high_nm], with the k that is measured beside it, if one is.
  RefractiveIndex(Curve n, std::optional<Extinction> k, IndexMedium medium, double low_nm, double high_nm);
  /// Tabulated n and k, both valid on [low_nm, high_nm].
  RefractiveIndex(Curve n, Curve k, IndexMedium medium, double low_nm, double high_nm);

  /// The same n with that k relative to air in place of its own, at all wavelengths.
  [[nodiscard]] RefractiveIndex with_k(Curve k) const;

  /// The catalogued numbers at a wavelength [nm], relative to `medium()`.
  [[nodiscard]] double catalogued_n(double wavelength_nm) const;
  [[nodiscard]] double catalogued_k(double wavelength_nm) const;

  /// n and k relative to air, as the renderer uses them: the catalogued ones, divided by the index of air for
  /// a vacuum table.
  [[nodiscard]] double n(double wavelength_nm) const;
  [[nodiscard]] double k(double wavelength_nm) const;
  [[nodiscard]] SampledSpectrum n(const SampledSpectrum& wavelengths_nm) const;
  [[nodiscard]] SampledSpectrum k(const SampledSpectrum& wavelengths_nm) const;

  /// Power absorption coefficient 4 pi k / lambda [1/m].
  [[nodiscard]] double absorption_per_m(double wavelength_nm) const;
  [[nodiscard]] SampledSpectrum absorption_per_m(const SampledSpectrum& wavelengths_nm) const;

  [[nodiscard]] bool dispersive() const;
  [[nodiscard]] bool absorbing() const;  ///< k > 0 somewhere in [300, 1100] nm.
  [[nodiscard]] IndexMedium medium() const { return medium_; }
  [[nodiscard]] double low_nm() const { return low_nm_; }
  [[nodiscard]] double high_nm() const { return high_nm_; }
  /// Where k is measured; nothing when it is nowhere.
  [[nodiscard]] const std::optional<DataRange>& k_range() const { return k_range_; }
  /// Whether k is measured at a wavelength [nm].
  [[nodiscard]] bool knows_k(double wavelength_nm) const {
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
