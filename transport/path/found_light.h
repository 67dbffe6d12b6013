#pragma once

#include <cstddef>
#include <vector>

#include "transport/path/polarised_ends.h"

namespace abbe {

/// What each of some paths has found for the film: power, or Stokes vectors where the sensor tells how light
/// is polarised.
class FoundLight {
 public:
  explicit FoundLight(const Scene& scene) : measures_(measures_polarisation(scene)) {}

  void reset(std::size_t paths) {
    if (measures_)
      vectors_.assign(paths, {});
    else
      powers_.assign(paths, {});
  }
  /// Adds a contribution to what a path has found; see `with_seen`.
  void add(std::size_t path, const SampledSpectrum& contribution, const StokesSpectrum* seen) {
    with_seen(measures_, contribution, seen, Adder{*this, path});
  }
  /// Tells `use` of a contribution as the film takes it.
  template <typename Use>
  void tell(const SampledSpectrum& contribution, const StokesSpectrum* seen, Use use) const {
    with_seen(measures_, contribution, seen, use);
  }
  /// Tells `use` of all that a path has found.
  template <typename Use>
  void tell(std::size_t path, Use use) const {
    if (measures_)
      use(vectors_[path]);
    else
      use(powers_[path]);
  }

 private:
  struct Adder {
    FoundLight& to;
    std::size_t path;
    void operator()(const SampledSpectrum& power) const { to.powers_[path] += power; }
    void operator()(const StokesSpectrum& vector) const { to.vectors_[path] += vector; }
  };

  bool measures_;
  std::vector<SampledSpectrum> powers_;
  std::vector<StokesSpectrum> vectors_;
};

}  // namespace abbe
