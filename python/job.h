#pragma once

#include <pybind11/pybind11.h>

#include "transport/render/render.h"

namespace abbe::python {

/// Renders `scene` with the options `how` on another thread, while the calling thread lets Python handle its
/// signals. It calls `progress` with the latest Progress, at most every 50 ms, on the calling thread, unless
/// it is None.
/// An exception from `progress` or a signal ends the render after the current pass and is thrown; the film is
/// lost. Otherwise throws what `render` throws. Requires that the caller has released the GIL by
/// `GilReleased`.
[[nodiscard]] RenderResult render_listening(const abbe::Scene& scene, RenderOptions how,
                                            const pybind11::object& progress);

}  // namespace abbe::python
