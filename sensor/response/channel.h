#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "spectral/colorimetry.h"
#include "spectral/curve.h"

namespace abbe {

/// What a response multiplies: the energy that arrives, or the photons that arrive.
enum class ResponseKind { energy, quantum };

/// One channel of a sensor. Its film value for a spectral irradiance E over an exposure t is t times the
/// integral of E(lambda) weight(lambda): J/m^2 weighted by the response for an energy channel, electrons per
/// m^2 for a quantum channel.
struct Channel {
  std::string name;
  ResponseKind kind = ResponseKind::energy;
  Curve weight;
};

/// A channel whose response multiplies energy.
[[nodiscard]] Channel energy_channel(std::string name, Curve response);

/// A channel whose response (quantum efficiency times filters, electrons per photon) multiplies photons:
/// weight = response lambda/(hc).
[[nodiscard]] Channel quantum_channel(std::string name, const Curve& response);

/// The channels of a measured camera or detector in `data/camera`, one per column (R, G, B or QE), or of a
/// user's table. Colour cameras are tabulated as energy responses ("to be multiplied by spectral power"),
/// columns named QE as quantum efficiencies.
[[nodiscard]] std::optional<std::vector<Channel>> load_camera(const std::string& name,
                                                              const SourcePosition& where,
                                                              Diagnostics& diagnostics);

/// The standard observer as a sensor: X, Y, Z with weight 683.002 times the colour-matching functions, so Y
/// is in lx s.
[[nodiscard]] std::vector<Channel> observer_channels(Observer observer);

}  // namespace abbe
