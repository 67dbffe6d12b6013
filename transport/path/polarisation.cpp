#include "transport/path/polarisation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <new>
#include <vector>

namespace abbe {
namespace {

[[maybe_unused]] bool is_across(const Imath::V3f& axis, const Imath::V3f& travels) {
  constexpr float kSlack = 1e-3F;
  return std::abs(axis.length() - 1) < kSlack && std::abs(axis.dot(travels)) < kSlack;
}

// Product of a row and the matrix, or of the matrix and a column; they differ only in the sign of s.
StokesSpectrum product(const StokesSpectrum& x, const MuellerMatrix& m, TransportMode mode) {
  const SampledSpectrum s = mode == TransportMode::radiance ? m.s : SampledSpectrum(0.0F) - m.s;
  return {x.i + x.q * m.d, x.i * m.d + x.q * m.p, x.u * m.c + x.v * s, x.v * m.c - x.u * s};
}

float ratio(float part, float whole) {
  return whole > 0 ? part / whole : 0.0F;
}

// Free list of one thread. Allocating memory with vector alignment takes as long as an event of a path.
class FreeList {
 public:
  explicit FreeList(std::align_val_t alignment) : alignment_(alignment) { spare_.reserve(kMaxSpare); }
  FreeList(const FreeList&) = delete;
  FreeList& operator=(const FreeList&) = delete;
  ~FreeList() {
    for (void* memory : spare_) ::operator delete(memory, alignment_);
  }

  void* take(std::size_t size) {
    if (spare_.empty()) return ::operator new(size, alignment_);
    void* memory = spare_.back();
    spare_.pop_back();
    return memory;
  }
  void give_back(void* memory) {
    if (spare_.size() < kMaxSpare)
      spare_.push_back(memory);
    else
      ::operator delete(memory, alignment_);
  }

 private:
  static constexpr std::size_t kMaxSpare = 256;  // bounded, as a thread may destroy objects of other threads
  std::align_val_t alignment_;
  std::vector<void*> spare_;
};

FreeList& free_list() {
  thread_local FreeList spare{std::align_val_t{alignof(Polarisation)}};
  return spare;
}

}  // namespace

void* Polarisation::operator new(std::size_t size, std::align_val_t /*alignment*/) {
  return free_list().take(size);
}

void Polarisation::operator delete(void* memory, std::align_val_t /*alignment*/) {
  free_list().give_back(memory);
}

Polarisation Polarisation::all_elements(const Imath::V3f& axis) {
  const SampledSpectrum one(1.0F);
  return {axis,
          {StokesSpectrum{.i = one}, StokesSpectrum{.q = one}, StokesSpectrum{.u = one},
           StokesSpectrum{.v = one}}};
}

void Polarisation::turn_to(const Imath::V3f& axis, const Imath::V3f& travels) {
  if (!neutral_) {
    assert(is_across(axis_, travels) && is_across(axis, travels));
    const float cosine = axis_.dot(axis);
    const float sine = travels.cross(axis_).dot(axis);
    const float both = cosine * cosine + sine * sine;
    const float cos_twice = (cosine - sine) * (cosine + sine) / both;
    const float sin_twice = 2 * cosine * sine / both;
    for (int k = 0; k < count_; ++k) {
      StokesSpectrum& row = rows_[static_cast<std::size_t>(k)];
      row = turned(row, cos_twice, sin_twice);
    }
  }
  axis_ = axis;
}

void Polarisation::multiply(const std::optional<MuellerMatrix>& matrix, const Imath::V3f& travels,
                            TransportMode mode) {
  if (matrix) turn_to(matrix->axis, travels);
  for (int k = 0; k < count_; ++k) {
    StokesSpectrum& row = rows_[static_cast<std::size_t>(k)];
    row = matrix ? product(row, *matrix, mode) : StokesSpectrum{.i = row.i};
  }
  neutral_ = !matrix;
}

Polarisation Polarisation::through(const std::optional<MuellerMatrix>& matrix, const Imath::V3f& travels,
                                   TransportMode mode) const {
  Polarisation next = *this;
  next.multiply(matrix, travels, mode);
  return next;
}

SampledSpectrum Polarisation::pass(const std::optional<MuellerMatrix>& matrix, const Imath::V3f& travels,
                                   TransportMode mode) {
  if (neutral_ && !matrix) return SampledSpectrum(1.0F);
  multiply(matrix, travels, mode);
  const SampledSpectrum preserved =
      SampledSpectrum::map(rows_[0].i, [](float i) { return std::max(i, 0.0F); });
  const SampledSpectrum over = SampledSpectrum::map(preserved, [](float i) { return ratio(1.0F, i); });
  for (int k = 0; k < count_; ++k) rows_[static_cast<std::size_t>(k)] *= over;
  return preserved;
}

StokesSpectrum Polarisation::of_unpolarised() const {
  return {rows_[0].i, rows_[1].i, rows_[2].i, rows_[3].i};
}

StokesSpectrum Polarisation::of(const Polarisation& light, const Imath::V3f& travels) const {
  if (neutral_ || light.neutral_) {
    StokesSpectrum measured_values = of_unpolarised();
    measured_values *= light.rows_[0].i;
    return measured_values;
  }
  const StokesSpectrum vector = light.in_frame(axis_, travels);
  return {measured(rows_[0], vector), measured(rows_[1], vector), measured(rows_[2], vector),
          measured(rows_[3], vector)};
}

StokesSpectrum Polarisation::in_frame(const Imath::V3f& axis, const Imath::V3f& travels) const {
  Polarisation there = *this;
  there.turn_to(axis, travels);
  return there.rows_[0];
}

}  // namespace abbe
