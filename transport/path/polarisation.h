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

/// Polarisation of a path, per wavelength. For a light path it is the Stokes vector. For a camera path it is
/// the set of rows with which the sensor measures Stokes vectors that arrive at the path's end. Both are
/// relative to the first element of the first row, which is part of the path's throughput. Their frame is
/// perpendicular to the direction in which light travels along the path's ray. Its first axis is a unit
/// vector, its second one is travels x axis.
///
/// With the Mueller matrices M_1, M_2 ... of a path's events, each in the direction of the light, this is the
/// row
///     r M_1 M_2 ...           of a camera path, r being (1, 0, 0, 0) if only power is measured, and
///     ... M_2 M_1 s           of a light path with the emission s.
/// The value measured of a connected path is the product of the row of one, the matrix of the connecting
/// event, and the vector of the other. [Born1999, sec. 10.9]
class Polarisation {
 public:
  /// Unpolarised light, or a sensor that measures power alone.
  Polarisation() = default;
  /// Allocation from a per-thread free list; see `FreeList`.
  static void* operator new(std::size_t size, std::align_val_t alignment);
  static void operator delete(void* memory, std::align_val_t alignment);
  /// Stokes vector or single row in the frame of the unit vector `axis`, per wavelength, relative to the
  /// throughput.
  Polarisation(const Imath::V3f& axis, const StokesSpectrum& values)
      : axis_(axis), neutral_(false), rows_{values} {}
  /// Rows of a sensor that measures all four elements.
  Polarisation(const Imath::V3f& axis, const std::array<StokesSpectrum, 4>& rows)
      : axis_(axis), count_(4), neutral_(false), rows_(rows) {}
  /// Rows of a sensor that measures I, Q, U and V in the frame of `axis`.
  [[nodiscard]] static Polarisation all_elements(const Imath::V3f& axis);

  /// Applies an event. `travels` is the unit direction of the light before the event for a light path, after
  /// it for a camera path. `matrix` is empty if the event depolarises. Returns, per wavelength, the first
  /// element of the result, which is at least 0: the factor between it and that of unpolarised light. All
  /// elements are divided by that factor.
  SampledSpectrum pass(const std::optional<MuellerMatrix>& matrix, const Imath::V3f& travels,
                       TransportMode mode);
  /// Polarisation after an event, relative to the current throughput: `pass` without the division.
  [[nodiscard]] Polarisation through(const std::optional<MuellerMatrix>& matrix, const Imath::V3f& travels,
                                     TransportMode mode) const;

  /// Stokes vector that the rows measure of unpolarised light; unused elements are 0.
  [[nodiscard]] StokesSpectrum of_unpolarised() const;
  /// Stokes vector that the rows measure of the polarisation `light`, which travels along the unit vector
  /// `travels`. `light` must be a Stokes vector, not the rows of a sensor.
  [[nodiscard]] StokesSpectrum of(const Polarisation& light, const Imath::V3f& travels) const;

 private:
  // Stokes vector in the frame of another axis.
  [[nodiscard]] StokesSpectrum in_frame(const Imath::V3f& axis, const Imath::V3f& travels) const;
  void turn_to(const Imath::V3f& axis, const Imath::V3f& travels);
  void multiply(const std::optional<MuellerMatrix>& matrix, const Imath::V3f& travels, TransportMode mode);

  Imath::V3f axis_{0, 0, 0};  // undefined if neutral
  int count_ = 1;             // number of rows
  bool neutral_ = true;       // true if all elements but the first are zero
  std::array<StokesSpectrum, 4> rows_{StokesSpectrum{.i = SampledSpectrum(1.0F)}};
};

/// Optional polarisation of a packet, on the heap: few scenes need it, and packets of other scenes stay
/// small. Copies are deep. Access to an empty one is undefined.
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
