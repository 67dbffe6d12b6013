#include "materials/index/refractive_index.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "spectral/air.h"

namespace abbe {
namespace {

bool is_sellmeier(const DispersionFormula& f) {
  return f.id == 1 || f.id == 2;
}

SampledSpectrum clamped(const SampledSpectrum& wavelengths_nm, double low_nm, double high_nm) {
  const auto low = static_cast<float>(low_nm);
  const auto high = static_cast<float>(high_nm);
  return SampledSpectrum::map(wavelengths_nm, [=](float nm) { return std::min(std::max(nm, low), high); });
}

// Formulas 1 and 2, term by term over the whole packet: exact, and faster than a table.
SampledSpectrum sellmeier_index(const DispersionFormula& f, const SampledSpectrum& wavelengths_nm) {
  const SampledSpectrum l2 =
      SampledSpectrum::map(wavelengths_nm, [](float nm) { return nm * 1e-3F * (nm * 1e-3F); });
  SampledSpectrum n2(static_cast<float>(1 + f.c[0]));
  for (std::size_t i = 1; i + 1 < static_cast<std::size_t>(f.terms); i += 2) {
    const auto strength = static_cast<float>(f.c[i]);
    const auto pole = static_cast<float>(f.id == 1 ? f.c[i + 1] * f.c[i + 1] : f.c[i + 1]);
    n2 += SampledSpectrum::map(l2, [=](float x) { return strength * x / (x - pole); });
  }
  return SampledSpectrum::map(n2, [](float x) { return std::sqrt(x); });
}

// 1/n of air over wavelength, the factor from values relative to vacuum to values relative to air.
Curve per_index_of_air() {
  return each_nm([](double nm) { return 1 / air_index(nm); });
}

}  // namespace

std::optional<std::string> index_fault(const Curve& n, const Curve& k) {
  if (n.min() > 0 && k.min() >= 0) return std::nullopt;
  return fmt::format(
      "an index must be positive and its extinction not negative (got n down to {}, k down to {})", n.min(),
      k.min());
}

RefractiveIndex::RefractiveIndex(double n, double k)
    : n_(Constant{n}), k_(k), low_nm_(0), high_nm_(std::numeric_limits<double>::infinity()) {
  k_range_ = {low_nm_, high_nm_};
}

RefractiveIndex::RefractiveIndex(const DispersionFormula& formula, std::optional<Extinction> k,
                                 IndexMedium medium, double low_nm, double high_nm)
    : n_(formula), medium_(medium), low_nm_(low_nm), high_nm_(high_nm) {
  take(std::move(k));
  bake();
}

RefractiveIndex::RefractiveIndex(Curve n, std::optional<Extinction> k, IndexMedium medium, double low_nm,
                                 double high_nm)
    : n_(std::move(n)), medium_(medium), low_nm_(low_nm), high_nm_(high_nm) {
  take(std::move(k));
  bake();
}

RefractiveIndex::RefractiveIndex(Curve n, Curve k, IndexMedium medium, double low_nm, double high_nm)
    : RefractiveIndex(std::move(n), Extinction{std::move(k), {low_nm, high_nm}}, medium, low_nm, high_nm) {}

RefractiveIndex RefractiveIndex::with_k(Curve k) const {
  RefractiveIndex index = *this;
  if (medium_ == IndexMedium::vacuum) k = product(k, each_nm(air_index));
  index.take(Extinction{std::move(k), {0, std::numeric_limits<double>::infinity()}});
  index.bake();
  return index;
}

// Replaces k and its range, if k is given.
void RefractiveIndex::take(std::optional<Extinction> k) {
  if (!k) return;
  k_ = std::move(k->k);
  k_range_ = k->range;
}

// Tabulates n and k relative to air for the packet functions, unless these evaluate the data directly.
void RefractiveIndex::bake() {
  if (medium_ == IndexMedium::vacuum && absorbing()) baked_k_ = product(k_, per_index_of_air());
  const auto* formula = std::get_if<DispersionFormula>(&n_);
  if (medium_ == IndexMedium::air && (!formula || (is_sellmeier(*formula) && !formula->vacuum_wavelengths)))
    return;
  const auto* table = std::get_if<Curve>(&n_);
  baked_n_ = table ? product(*table, per_index_of_air()) : each_nm([this](double nm) { return n(nm); });
}

double RefractiveIndex::catalogued_n(double wavelength_nm) const {
  if (const auto* constant = std::get_if<Constant>(&n_)) return constant->n;
  const double nm = std::clamp(wavelength_nm, low_nm_, high_nm_);
  if (const auto* formula = std::get_if<DispersionFormula>(&n_))
    return dispersion_index(*formula, (formula->vacuum_wavelengths ? air_to_vacuum(nm) : nm) * 1e-3);
  return std::get<Curve>(n_)(nm);
}

double RefractiveIndex::n(double wavelength_nm) const {
  const double catalogued = catalogued_n(wavelength_nm);
  return medium_ == IndexMedium::vacuum ? catalogued / air_index(wavelength_nm) : catalogued;
}

SampledSpectrum RefractiveIndex::n(const SampledSpectrum& wavelengths_nm) const {
  if (const auto* constant = std::get_if<Constant>(&n_))
    return SampledSpectrum(static_cast<float>(constant->n));
  if (baked_n_) return (*baked_n_)(wavelengths_nm);
  if (const auto* formula = std::get_if<DispersionFormula>(&n_))
    return sellmeier_index(*formula, clamped(wavelengths_nm, low_nm_, high_nm_));
  return std::get<Curve>(n_)(wavelengths_nm);
}

double RefractiveIndex::catalogued_k(double wavelength_nm) const {
  return k_(wavelength_nm);
}

double RefractiveIndex::k(double wavelength_nm) const {
  const double catalogued = catalogued_k(wavelength_nm);
  return medium_ == IndexMedium::vacuum ? catalogued / air_index(wavelength_nm) : catalogued;
}

SampledSpectrum RefractiveIndex::k(const SampledSpectrum& wavelengths_nm) const {
  return (baked_k_ ? *baked_k_ : k_)(wavelengths_nm);
}

double RefractiveIndex::absorption_per_m(double wavelength_nm) const {
  return 4 * std::numbers::pi * k(wavelength_nm) / (wavelength_nm * 1e-9);
}

SampledSpectrum RefractiveIndex::absorption_per_m(const SampledSpectrum& wavelengths_nm) const {
  constexpr auto kScale = static_cast<float>(4e9 * std::numbers::pi);
  return SampledSpectrum::map(k(wavelengths_nm), wavelengths_nm,
                              [](float k, float nm) { return kScale * k / nm; });
}

bool RefractiveIndex::dispersive() const {
  if (const auto* curve = std::get_if<Curve>(&n_))
    return medium_ == IndexMedium::vacuum || !curve->is_constant();
  return std::holds_alternative<DispersionFormula>(n_);
}

bool RefractiveIndex::absorbing() const {
  return k_.max() > 0;
}

}  // namespace abbe
