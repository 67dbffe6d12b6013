#pragma once

#include <span>

#include "description/load_context.h"
#include "spectral/curve_use.h"

namespace abbe::description {

/// Returns the table for the use `use`, with these effects on a partial table. A table is partial if it ends
/// within the rendered wavelengths, 300 to 1100 nm, and does not declare `clamp`. A table that declares 0 is
/// partial only if `use.extrapolates_constant`.
/// - If `coverage.partial_tables` is set, a partial table is added to it with its position `where`.
/// - If `coverage.extrapolate`, a partial table is returned extrapolated with its end values.
/// Any other table is returned unchanged. Reports nothing.
[[nodiscard]] NamedCurve with_extrapolation(NamedCurve table, const CurveUse& use,
                                            const SourcePosition& where, TableCoverage& coverage);

/// A context to build a light or sensor again, in which `with_extrapolation` extrapolates partial tables. Its
/// diagnostics go to `discarded`, which must outlive it, because the first build has reported them. It has
/// only the folder and the unit of length of `context`: it records no files and counts no memory.
[[nodiscard]] LoadContext extrapolating_context(const LoadContext& context, Diagnostics& discarded);

/// Reports each partial table that ends where a channel would record more than a negligible fraction of its
/// total for the spectrum `light`: a warning if the table declares 0, else an error. A table of one channel
/// is checked for that channel only. Tables of a light must be extrapolated in `light`, those of a sensor in
/// the weights of `channels`; see `extrapolating_context`. Diagnostics go to `context.diagnostics`, each
/// warning once, even if several lights use the table.
void check_table_range(std::span<const PartialTable> tables, const Curve& light,
                       std::span<const Channel> channels, LoadContext& context);

}  // namespace abbe::description
