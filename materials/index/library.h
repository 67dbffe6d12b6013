#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "materials/index/named_index.h"

namespace abbe {

/// Finds a material by name: the dispersion formulas of `data/glass/dielectrics.csv` (with the k(lambda)
/// table of the same glass where there is one); the n, k tables of `data/glass` and `data/metal`; the makers'
/// glasses of `data/glass/makers.csv` as "maker/glass" (the maker in any case) or as "glass" where one maker
/// alone sells it; a user's `.csv` with columns wavelength_nm, n and perhaps k, or `.yml` of
/// refractiveindex.info. Reports an unknown name with the nearest one, a name of several makers' glasses with
/// all of them, and a formula with a pole or n^2 <= 1 inside its range.
[[nodiscard]] std::optional<NamedIndex> load_index(const std::string& name, const SourcePosition& where,
                                                   Diagnostics& diagnostics);

/// Throws Error{usage} naming `where` for a wavelength [nm] at which the material has no data, or that Abbe
/// does not carry.
void require_data_at(const NamedIndex& material, std::span<const double> wavelengths_nm,
                     const std::string& where);

/// Throws Error{usage} naming `where` for a wavelength [nm] at which k is not measured, and is held at more
/// than a glass has, so that what the surface reflects hangs on it.
void require_k_at(const NamedIndex& material, std::span<const double> wavelengths_nm,
                  const std::string& where);

/// Throws Error{usage} naming `where` for a wavelength [nm] outside [low_nm, high_nm], between which `name`
/// has data.
void require_between(const std::string& name, double low_nm, double high_nm,
                     std::span<const double> wavelengths_nm, const std::string& where);

/// Whether a name is that of a file in the format of refractiveindex.info.
[[nodiscard]] bool is_refractiveindex_info(const std::string& name);

/// All names of dielectrics and of tables, aliases included, sorted.
[[nodiscard]] std::vector<std::string> index_names();
/// All makers' glasses, as "maker/glass", sorted.
[[nodiscard]] std::vector<std::string> glass_names();

}  // namespace abbe
