#pragma once

#include <optional>

namespace abbe {

/// The straight way of a ray through a prism in its principal section: refracted at two faces, without
/// reflections between them.
struct PrismPassage {
  double incidence_deg;  ///< At the first face, positive on the side of its normal away from the apex.
  double deviation_deg;  ///< Towards the base.
  double Ts, Tp;         ///< Transmittance of both faces together.
};

/// The passage at an incidence in (-90, 90) degrees through a prism of apex angle in (0, 180) degrees and
/// index `n` relative to what surrounds it. Nothing where the second face reflects totally. deviation = i + e
/// - A, sin i = n sin r, sin e = n sin(A - r) [Born1999, sec. 4.7.2].
[[nodiscard]] std::optional<PrismPassage> prism_passage(double n, double apex_deg, double incidence_deg);

/// The symmetric passage, which deviates least: i = asin(n sin(A/2)), deviation = 2i - A [Born1999,
/// sec. 4.7.2]. Nothing when n sin(A/2) >= 1.
[[nodiscard]] std::optional<PrismPassage> prism_minimum(double n, double apex_deg);

}  // namespace abbe
