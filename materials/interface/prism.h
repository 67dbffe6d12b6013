#pragma once

#include <optional>

namespace abbe {

/// A ray through a prism in its principal section, refracted at two faces without internal reflections.
struct PrismPassage {
  double incidence_deg;  ///< At the first face; positive if the ray arrives from the side of the base.
  double deviation_deg;  ///< Positive towards the base.
  double Ts, Tp;         ///< Product of the transmittances of both faces.
};

/// Passage through a prism. The incidence is in (-90, 90) degrees, the apex angle in (0, 180) degrees. `n` is
/// the index relative to the surrounding medium. deviation = i + e - A, sin i = n sin r, sin e = n sin(A - r)
/// [Born1999, sec. 4.7.2]. Empty if the second face reflects totally.
[[nodiscard]] std::optional<PrismPassage> prism_passage(double n, double apex_deg, double incidence_deg);

/// Passage of minimum deviation, which is symmetric: i = asin(n sin(A/2)), deviation = 2i - A [Born1999, sec.
/// 4.7.2]. Empty if n sin(A/2) >= 1.
[[nodiscard]] std::optional<PrismPassage> prism_minimum(double n, double apex_deg);

}  // namespace abbe
