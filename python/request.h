#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "transport/render/render.h"
#include "transport/render/sample_ranges.h"

namespace abbe::python {

/// Sampling parameters of a call; absent ones are those of the scene.
struct Request {
  std::optional<std::int64_t> spp;
  std::optional<std::int64_t> seed;
  std::int64_t threads = 0;
  std::optional<double> error;
  std::optional<double> time;
  std::optional<SampleRange> samples = {};
};

/// Throws Error{usage} with the name of an argument that is out of range, or of two that exclude each other.
void require_valid(const Request& request);

/// Throws Error{usage} with the argument `seed` unless it is absent or a valid seed of a scene.
void require_seed(const std::optional<std::int64_t>& seed);

/// Throws Error{usage} unless `holds`: "`argument`: got `got`, allowed `allowed`".
void require(bool holds, const char* argument, const std::string& got, const char* allowed);

/// Render options with the threads and the stopping criteria of a request.
[[nodiscard]] RenderOptions render_limits(const Request& request);

}  // namespace abbe::python
