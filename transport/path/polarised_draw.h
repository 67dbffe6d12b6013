#pragma once

#include "materials/medium/phase.h"
#include "transport/path/vertex.h"

namespace abbe {

/// Drawing events as polarised light has them. Were they drawn as of unpolarised light, each would multiply
/// what a path carries by a factor f up to 2, of the mean 1, and the variance of a long path would grow
/// exponentially: light that is reflected again and again within glass, or scattered in a cloud. Where
/// nothing is absorbed the density that unpolarised light has, times f of the hero, is a density too, and is
/// drawn from instead: f of lane k over f of the hero is then left, in the throughput and, as that lane would
/// have drawn likewise, in its density.

/// Whether the model's events are drawn so: smooth glass reflects or refracts.
[[nodiscard]] bool draws_polarised(const Bsdf& bsdf);

/// With which probability such a model would reflect what the packet carries, come along the unit vector
/// `along`, were that lane the hero.
[[nodiscard]] float polarised_reflectance(const PathPacket& packet, const SurfaceVertex& vertex,
                                          const Imath::V3f& along, TransportMode mode, int lane);

/// For a number `u` in [0, 1) that would let such a model choose as of unpolarised light the one that lets it
/// choose as of what the packet carries, come along the unit vector `along`.
[[nodiscard]] float polarised_choice(const PathPacket& packet, const SurfaceVertex& vertex,
                                     const Imath::V3f& along, TransportMode mode, float u);

/// A direction drawn by the phase function likewise, in the world, and the density with which unpolarised
/// light would be turned there [1/sr]. The angle by which it is turned is as of unpolarised light; with f = 1
/// + A cos 2 phi + B sin 2 phi of the azimuth phi, this is where phi + [A sin 2 phi + B (1 - cos 2 phi)]/2 is
/// 2 pi u.
struct TurnedDirection {
  Imath::V3f direction;
  float pdf;
};
[[nodiscard]] TurnedDirection polarised_turn(const PathPacket& packet, const PhaseFunction& phase,
                                             const Imath::V3f& along, TransportMode mode,
                                             const Imath::V2f& u);

/// `polarise` for what has been drawn so; returns f of the hero.
float polarise_drawn(PathPacket& packet, const std::optional<MuellerMatrix>& matrix,
                     const Imath::V3f& travels, TransportMode mode);

}  // namespace abbe
