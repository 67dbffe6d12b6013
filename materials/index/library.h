#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "materials/index/refractive_index.h"

namespace abbe {

/// A refractive index with its identity.
struct NamedIndex {
  std::string name;
  std::string source;
  RefractiveIndex index;
};

/// Finds a material by name: the dispersion formulas of `data/glass` (with the k(lambda) table of the same
/// glass where there is one), the n, k tables of `data/glass` and `data/metal`, and a user's `.csv` with
/// columns wavelength_nm, n and perhaps k. Reports an unknown name with the nearest one, and a formula with a
/// pole or n^2 <= 1 inside its range.
[[nodiscard]] std::optional<NamedIndex> load_index(const std::string& name, const SourcePosition& where,
                                                   Diagnostics& diagnostics);

/// All names, sorted.
[[nodiscard]] std::vector<std::string> index_names();

}  // namespace abbe
