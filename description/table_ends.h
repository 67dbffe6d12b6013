#pragma once

#include <span>

#include "description/load_context.h"
#include "spectral/curve_use.h"

namespace abbe::description {

/// A table that is used so, with what is taken to lie beyond its rows; noted where it ends.
[[nodiscard]] NamedCurve with_ends(NamedCurve table, const CurveUse& use, const SourcePosition& where,
                                   TableEnds& ends);

/// A context in which lights and filters go on as their tables end. What it has to complain of, which has
/// been told before, goes to `unheard`, and it remembers no files.
[[nodiscard]] LoadContext going_on(const LoadContext& context, Diagnostics& unheard);

/// Reports each of these tables by whose ends a share of what its channels count is lost that is not
/// negligible. The channels count `light` by their weights, in which lights and filters go on. What is warned
/// of is told once in `context`, however many lamps have the table and lose as much by it.
void check_ends(std::span<const EndedTable> tables, const Curve& light, std::span<const Channel> channels,
                LoadContext& context);

}  // namespace abbe::description
