#pragma once

#include <pybind11/pybind11.h>

#include "transport/render/render.h"

namespace abbe::python {

/// Renders on another thread while the calling thread lets Python handle its signals. It calls `progress`
/// with a Progress unless it is None. An exception from either ends the render after the current pass and is
/// thrown. Requires that the caller does not hold the GIL.
[[nodiscard]] RenderResult render_listening(const abbe::Scene& scene, RenderOptions how,
                                            const pybind11::object& progress);

}  // namespace abbe::python
