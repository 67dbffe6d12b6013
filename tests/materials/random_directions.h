#pragma once

#include <random>

#include "materials/bsdf/event.h"
#include "materials/bsdf/warp.h"

namespace abbe {

/// Random numbers in [0, 1) with 24 bits, like those of samplers.
class Uniform {
 public:
  explicit Uniform(unsigned seed) : rng_(seed) {}
  float operator()() { return static_cast<float>(rng_() >> 8U) * 0x1p-24F; }
  BsdfRandom event() { return {(*this)(), {(*this)(), (*this)()}}; }

 private:
  std::mt19937 rng_;
};

inline Imath::V3f direction(double cos_theta, double phi) {
  return direction_at(cos_theta, phi);
}

}  // namespace abbe
