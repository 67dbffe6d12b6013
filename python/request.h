#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "transport/render/render.h"
#include "transport/render/sample_ranges.h"

namespace abbe::python {

/// How a call asks for light to be sampled; what is absent is as the scene says.
struct Request {
  std::optional<std::int64_t> spp;
  std::optional<std::int64_t> seed;
  std::int64_t threads = 0;
  std::optional<double> error;
  std::optional<double> time;
  std::optional<SampleRange> samples = {};
};

/// Throws Error{usage} naming the argument that is out of its range, or that another excludes.
void require_valid(const Request& request);

/// Throws Error{usage} naming the argument `seed` unless it is one that scenes may have, or not given.
void require_seed(const std::optional<std::int64_t>& seed);

/// Throws Error{usage} unless it holds: "`argument`: got `got`, allowed `allowed`".
void require(bool holds, const char* argument, const std::string& got, const char* allowed);

/// Its threads, and when to stop.
[[nodiscard]] RenderOptions how_to_stop(const Request& request);

}  // namespace abbe::python
