#pragma once

#include <optional>

#include "transport/render/mpi_group.h"
#include "transport/render/part.h"
#include "transport/render/render.h"

namespace abbe::cli {

/// Checks that all processes of a group are about to render the same samples of the same film, continuing
/// from the same ones (`start`, empty for none). Otherwise their sums would be invalid. All processes must
/// call it before their first pass. Throws Error{input} in those whose render differs from that of the root.
/// Does nothing for a single process.
void require_same_render(const MpiGroup& mpi_group, const FilmIdentity& identity,
                         const abbe::RenderOptions& render_options, const std::optional<RenderResult>& start);

}  // namespace abbe::cli
