#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/diagnostics.h"
#include "materials/index/catalogue.h"

namespace abbe {

/// Finds a material by name. Searched in this order:
/// - a user's `.csv` with columns wavelength_nm, n and optionally k, or a `.yml` of refractiveindex.info;
/// - the dispersion formulas of `data/glass/dielectrics.csv`, with the k table of the same glass if there is
///   one;
/// - the n, k tables of `data/glass` and `data/metal`;
/// - the makers' glasses as "maker/glass" (the maker in any case), or as "glass" if only one maker sells it.
/// Reports at `where` an unknown name with the nearest known one, and a glass of several makers with all of
/// them. Also reports a file that cannot be read, values that cannot be an index (`index_fault`), and a
/// formula with a pole or n <= 1 inside its range. The result is then empty.
[[nodiscard]] std::optional<NamedIndex> load_index(const std::string& name, const SourcePosition& where,
                                                   Diagnostics& diagnostics);

/// Throws Error{usage} if the material has no data for n at one of the wavelengths [nm], or Abbe does not
/// support that wavelength. `where` names the option or key in the error.
void require_data_at(const NamedIndex& material, std::span<const double> wavelengths_nm,
                     const std::string& where);

/// Throws Error{usage}, which names `where`, if k is not measured at one of the wavelengths [nm] and its
/// extrapolated value exceeds `kLargestGlassK`. Does nothing for a material whose k was never measured. The
/// error prevents a reflectance that depends on an unknown k.
void require_k_at(const NamedIndex& material, std::span<const double> wavelengths_nm,
                  const std::string& where);

/// Throws Error{usage}, which names `where`, for a wavelength [nm] outside [low_nm, high_nm], the range of
/// the data of `name`.
void require_between(const std::string& name, double low_nm, double high_nm,
                     std::span<const double> wavelengths_nm, const std::string& where);

/// True if `name` has an extension of refractiveindex.info files, `.yml` or `.yaml`.
[[nodiscard]] bool is_refractiveindex_info(const std::string& name);

/// All names of dielectrics and of n, k tables, including aliases, and all makers' glasses as "maker/glass",
/// sorted. Files that cannot be read are left out.
[[nodiscard]] std::vector<std::string> index_names();
[[nodiscard]] std::vector<std::string> glass_names();

}  // namespace abbe
