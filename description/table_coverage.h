#pragma once

#include <span>

#include "description/load_context.h"
#include "spectral/curve_use.h"

namespace abbe::description {

/// Returns the table, extrapolated with its end values if `coverage.extrapolate`. Adds it to
/// `coverage.partial_tables` if it ends within the rendered wavelengths without declaring `clamp`.
[[nodiscard]] NamedCurve with_extrapolation(NamedCurve table, const CurveUse& use,
                                            const SourcePosition& where, TableCoverage& coverage);

/// A context in which lights and filters are extrapolated with their end values. Its diagnostics, which have
/// been reported before, go to `discarded`. It records no files.
[[nodiscard]] LoadContext extrapolating_context(const LoadContext& context, Diagnostics& discarded);

/// Reports each table that ends where a channel would record more than a negligible fraction of its total.
/// `light` and the weights of `channels` must be extrapolated. The context reports each warning once, even if
/// several lights use the table.
void check_table_range(std::span<const PartialTable> tables, const Curve& light,
                       std::span<const Channel> channels, LoadContext& context);

}  // namespace abbe::description
