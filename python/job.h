#pragma once

#include <pybind11/pybind11.h>

#include "transport/render/render.h"

namespace abbe::python {

/// Renders on a thread of its own while the one that calls lets Python handle its signals, and calls
/// `progress` with a Progress unless it is None. What either raises ends the render after the pass that runs,
/// and is thrown. To be called without Python's lock.
[[nodiscard]] RenderResult render_listening(const abbe::Scene& scene, RenderOptions how,
                                            const pybind11::object& progress);

}  // namespace abbe::python
