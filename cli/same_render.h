#pragma once

#include <optional>

#include "transport/render/crew.h"
#include "transport/render/part.h"
#include "transport/render/render.h"

namespace abbe::cli {

/// Ends a crew of which not all processes are about to render the same samples of the same film, going on
/// from the same ones: their sums would be of no film, or of other sizes. All call it before their first
/// pass. Throws Error{input} in those whose render is not that of the first.
void require_same_render(const Crew& crew, const FilmIdentity& identity, const abbe::RenderOptions& how,
                         const std::optional<RenderResult>& start);

}  // namespace abbe::cli
