#pragma once

#include <cstddef>
#include <vector>

#include "transport/path/polarised_ends.h"

namespace abbe {

/// Sums of the contributions of several paths to the film, per wavelength: power, or Stokes vectors if the
/// sensor distinguishes polarisation. Paths are numbered from 0.
class PathRadiance {
 public:
  explicit PathRadiance(const Scene& scene) : measures_polarisation_(measures_polarisation(scene)) {}

  /// Sets the sums of `paths` paths to zero.
  void reset(std::size_t paths) {
    if (measures_polarisation_)
      vectors_.assign(paths, {});
    else
      powers_.assign(paths, {});
  }
  /// Adds a contribution to the sum of a path. `stokes` is as for `with_measurement`; it must be given if the
  /// sensor measures polarisation.
  void add(std::size_t path, const SampledSpectrum& contribution, const StokesSpectrum* stokes) {
    with_measurement(measures_polarisation_, contribution, stokes, Adder{*this, path});
  }
  /// Calls `use` with one contribution in the form in which the film takes it: a `SampledSpectrum` or a
  /// `StokesSpectrum`. `stokes` is as for `with_measurement`.
  template <typename Use>
  void visit(const SampledSpectrum& contribution, const StokesSpectrum* stokes, Use use) const {
    with_measurement(measures_polarisation_, contribution, stokes, use);
  }
  /// Calls `use` with the sum of a path, in the same form.
  template <typename Use>
  void visit(std::size_t path, Use use) const {
    if (measures_polarisation_)
      use(vectors_[path]);
    else
      use(powers_[path]);
  }

 private:
  struct Adder {
    PathRadiance& to;
    std::size_t path;
    void operator()(const SampledSpectrum& power) const { to.powers_[path] += power; }
    void operator()(const StokesSpectrum& vector) const { to.vectors_[path] += vector; }
  };

  bool measures_polarisation_;
  std::vector<SampledSpectrum> powers_;
  std::vector<StokesSpectrum> vectors_;
};

}  // namespace abbe
