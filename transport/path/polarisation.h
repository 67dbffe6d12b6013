#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <new>
#include <optional>

#include "materials/bsdf/event.h"
#include "materials/interface/mueller.h"
#include "spectral/stokes.h"

namespace abbe {

/// What a path carries of polarisation, lane by lane: of light from a lamp its Stokes vector, of a path from
/// the camera the rows with which the sensor measures the Stokes vectors that come in at the path's end. Both
/// are over the first element of the first, which is in the path's throughput, and told in a frame across the
/// direction in which light travels along the path's ray: the first axis is a unit vector perpendicular to
/// that, the second travels x axis.
///
/// With M_1, M_2 ... the Mueller matrices of a path's events, each in the direction of light, that is the row
///     r M_1 M_2 ...           of a path from the camera, r being (1, 0, 0, 0) where only power is measured,
///     and
///     ... M_2 M_1 s           of a path from a lamp that sends s,
/// so that what is measured of paths that are joined is the product of the row of one, the matrix of the
/// event that joins them, and the vector of the other. [Born1999, sec. 10.9]
class Polarisation {
 public:
  /// Unpolarised light, or a sensor that measures power alone.
  Polarisation() = default;
  /// Each path has one of its own: their memory is kept by threads, see `SpareMemory`.
  static void* operator new(std::size_t size, std::align_val_t alignment);
  static void operator delete(void* memory, std::align_val_t alignment);
  /// A Stokes vector, or row.
  Polarisation(const Imath::V3f& axis, const StokesSpectrum& values)
      : axis_(axis), neutral_(false), rows_{values} {}
  /// The rows of a sensor that measures all elements.
  Polarisation(const Imath::V3f& axis, const std::array<StokesSpectrum, 4>& rows)
      : axis_(axis), count_(4), neutral_(false), rows_(rows) {}
  /// The rows of a sensor that measures I, Q, U and V in the frame of that axis.
  [[nodiscard]] static Polarisation all_elements(const Imath::V3f& axis);

  /// Takes it through an event to which light travels, or from which it travels on where the path comes from
  /// the camera, along the unit vector `travels`; `matrix` is nothing where the event depolarises. Returns by
  /// how much more the event leaves than it would were all unpolarised, and is relative to that from now on.
  SampledSpectrum pass(const std::optional<MuellerMatrix>& matrix, const Imath::V3f& travels,
                       TransportMode mode);
  /// What it would become, relative to what it is now.
  [[nodiscard]] Polarisation through(const std::optional<MuellerMatrix>& matrix, const Imath::V3f& travels,
                                     TransportMode mode) const;

  /// What rows measure of unpolarised light, as a Stokes vector of those that there are.
  [[nodiscard]] StokesSpectrum of_unpolarised() const;
  /// What rows measure, likewise, of light of the Stokes vector `light` that travels along the unit vector.
  [[nodiscard]] StokesSpectrum of(const Polarisation& light, const Imath::V3f& travels) const;

 private:
  // The Stokes vector in the frame of another axis.
  [[nodiscard]] StokesSpectrum in_frame(const Imath::V3f& axis, const Imath::V3f& travels) const;
  void turn_to(const Imath::V3f& axis, const Imath::V3f& travels);
  void multiply(const std::optional<MuellerMatrix>& matrix, const Imath::V3f& travels, TransportMode mode);

  Imath::V3f axis_{0, 0, 0};  // unknown where all is neutral
  int count_ = 1;             // of the rows
  bool neutral_ = true;       // all but the first elements are zero
  std::array<StokesSpectrum, 4> rows_{StokesSpectrum{.i = SampledSpectrum(1.0F)}};
};

/// The polarisation of a packet, if it carries any: few scenes have it, and packets of others should stay
/// small.
class CarriedPolarisation {
 public:
  CarriedPolarisation() = default;
  CarriedPolarisation(const CarriedPolarisation& other) { *this = other; }
  CarriedPolarisation(CarriedPolarisation&&) noexcept = default;
  CarriedPolarisation& operator=(const CarriedPolarisation& other) {
    if (this != &other) carried_ = other.carried_ ? std::make_unique<Polarisation>(*other.carried_) : nullptr;
    return *this;
  }
  CarriedPolarisation& operator=(CarriedPolarisation&&) noexcept = default;
  ~CarriedPolarisation() = default;
  CarriedPolarisation& operator=(const Polarisation& polarisation) {
    carried_ = std::make_unique<Polarisation>(polarisation);
    return *this;
  }

  explicit operator bool() const { return carried_ != nullptr; }
  Polarisation* operator->() const { return carried_.get(); }
  Polarisation& operator*() const { return *carried_; }

 private:
  std::unique_ptr<Polarisation> carried_;
};

}  // namespace abbe
