#pragma once

#include <string>
#include <utility>
#include <vector>

#include "validation/cases/case.h"

namespace abbe {

/// A figure without sampling error. `what` is its name within the case.
[[nodiscard]] inline Figure exact_figure(std::string what, double reference, double measured) {
  return {std::move(what), reference, {measured, 0}};
}

/// A case measured by `Computed`; the arguments are the members of `Case`.
[[nodiscard]] inline Case computed_case(Suite suite, std::string id, std::string title, std::string source,
                                        std::string unit, Margin margin, std::vector<Figure> (*figures)()) {
  return {suite,           std::move(id), std::move(title), std::move(source),
          std::move(unit), margin,        Computed{figures}};
}

/// Spectral lines C, d, F, g and h: wavelengths in air. `kLineD_nm` is the helium line d, not the sodium line
/// D.
inline constexpr double kLineC_nm = 656.2725;
inline constexpr double kLineD_nm = 587.5618;
inline constexpr double kLineF_nm = 486.1327;
inline constexpr double kLineG_nm = 435.8343;
inline constexpr double kLineH_nm = 404.6561;

}  // namespace abbe
