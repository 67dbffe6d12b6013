#pragma once

#include "spectral/packet.h"

namespace abbe {

/// The lane that makes the random choices of a path. Lanes are rotations of one another in the wavelength
/// distribution, so lane 0 of a uniformly drawn rotation is a lane chosen uniformly.
inline constexpr int kHero = 0;

/// The lanes of one path. With f the path's contribution, P its density of directions (by which lane were the
/// hero) and p the density of wavelengths, a technique's estimate is sum_j [f_j / p(lambda_j)] / sum_k P_k:
/// the balance heuristic over the lanes [Wilkie2014], the density of wavelengths standing in the numerator
/// only.
struct PathPacket {
  SampledWavelengths wavelengths;
  SampledSpectrum throughput{1.0F};  ///< f_j / P_hero.
  SampledSpectrum lane_pdf{1.0F};    ///< P_k / P_hero; 0 for a lane that cannot follow.

  /// The largest throughput of a lane, the same whichever lane is the hero.
  [[nodiscard]] float carried() const { return throughput.max() / lane_pdf.max(); }
};

}  // namespace abbe
