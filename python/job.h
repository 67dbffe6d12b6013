#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <pybind11/pybind11.h>

#include "transport/render/render.h"
#include "transport/render/sample_ranges.h"

namespace abbe::python {

/// Renders `scene` with the options `how` on another thread, while the calling thread lets Python handle its
/// signals. The latter also calls `progress`, unless it is None, with the latest Progress at most every 50
/// ms. An exception from `progress` or a signal ends the render after the current pass and is thrown; the
/// film is lost. Otherwise throws what `render` throws. Requires that the caller has released the GIL by
/// `GilReleased`.
[[nodiscard]] RenderResult render_listening(const abbe::Scene& scene, RenderOptions how,
                                            const pybind11::object& progress);

/// Sampling parameters of a call; absent ones are those of the scene, or no limit.
struct Request {
  std::optional<std::int64_t> spp;  ///< Samples per pixel.
  std::optional<std::int64_t> seed;
  std::int64_t threads = 0;  ///< 0 for one per processor.
  /// Relative error that ends the render, in (0, 1): of a film the median, of a meter the largest.
  std::optional<double> error;
  std::optional<double> time;               ///< Time limit [s], above 0.
  std::optional<SampleRange> samples = {};  ///< Samples to render of those of the whole render.
};

/// Throws Error{usage} with the name of an argument that is out of range, or of two that exclude each other:
/// `spp` or `sample_range` with `error` or `time`. It does not check the range `samples`.
void require_valid(const Request& request);

/// Throws Error{usage} with the argument `seed` unless it is absent or a valid seed of a scene.
void require_seed(const std::optional<std::int64_t>& seed);

/// Throws Error{usage} unless `holds`: "`argument`: got `got`, allowed `allowed`".
void require(bool holds, const char* argument, const std::string& got, const char* allowed);

/// Render options with the threads, the target error and the time limit of a request alone.
[[nodiscard]] RenderOptions render_limits(const Request& request);

}  // namespace abbe::python
