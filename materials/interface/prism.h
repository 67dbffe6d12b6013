#pragma once

#include <optional>

namespace abbe {

/// A ray through a prism in its principal section, refracted at two faces without internal reflections.
struct PrismPassage {
  double incidence_deg;  ///< At the first face; positive if the ray arrives from the side of the base.
  double deviation_deg;  ///< Positive towards the base.
  double Ts, Tp;  ///< Product of the transmittances of both faces, for s and p polarisation, in [0, 1].
};

/// Passage through a prism. The incidence is in (-90, 90) degrees, the apex angle in (0, 180) degrees. `n` >
/// 0 is the index relative to the surrounding medium; below 1 the deviation is negative. deviation = i + e -
/// A, sin i = n sin r, sin e = n sin(A - r) [Born1999, sec. 4.7.2]. Empty if a face reflects totally, or if
/// the ray inside does not arrive at the second face (A - r >= 90 degrees).
[[nodiscard]] std::optional<PrismPassage> prism_passage(double n, double apex_deg, double incidence_deg);

/// Symmetric passage through a prism, at which the amount of the deviation is smallest. Arguments are those
/// of `prism_passage`, A is the apex angle: i = asin(n sin(A/2)), deviation = 2i - A [Born1999, sec. 4.7.2].
/// Empty if n sin(A/2) >= 1, because light is then reflected totally.
[[nodiscard]] std::optional<PrismPassage> prism_minimum(double n, double apex_deg);

}  // namespace abbe
