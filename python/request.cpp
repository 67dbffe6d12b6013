#include "python/request.h"

#include <utility>

#include <fmt/format.h>

#include "description/render.h"
#include "io/error.h"

namespace abbe::python {
namespace {

void require_within(const char* argument, std::int64_t value, std::int64_t low, std::int64_t high) {
  if (value < low || value > high)
    throw Error(ErrorCode::usage, argument,
                fmt::format("got {}, allowed whole numbers in [{}, {}]", value, low, high));
}

// The number of samples is either given or determined by the limits of time and error.
void require_compatible(const Request& request) {
  const std::pair<bool, const char*> fixed[]{{request.spp.has_value(), "spp"},
                                             {request.samples.has_value(), "sample_range"}};
  const std::pair<bool, const char*> open[]{{request.error.has_value(), "error"},
                                            {request.time.has_value(), "time"}};
  for (const auto& [is_given, argument] : fixed)
    for (const auto& [is_other_given, other] : open)
      if (is_given && is_other_given)
        throw Error(ErrorCode::usage, "", fmt::format("{} excludes {}", argument, other));
}

}  // namespace

void require(bool holds, const char* argument, const std::string& got, const char* allowed) {
  if (!holds) throw Error(ErrorCode::usage, argument, fmt::format("got {}, allowed {}", got, allowed));
}

void require_seed(const std::optional<std::int64_t>& seed) {
  if (seed) require_within("seed", *seed, 0, kMaxSeed);
}

void require_valid(const Request& request) {
  if (request.spp) require_within("spp", *request.spp, 1, kMaxSamples);
  require_seed(request.seed);
  require_within("threads", request.threads, 0, kMaxThreads);
  require(!request.error || (*request.error > 0 && *request.error < 1), "error",
          fmt::format("{}", request.error.value_or(0)), "(0, 1)");
  require(!request.time || *request.time > 0, "time", fmt::format("{}", request.time.value_or(0)), "above 0");
  require_compatible(request);
}

RenderOptions render_limits(const Request& request) {
  RenderOptions how;
  how.threads = static_cast<int>(request.threads);
  how.target_error = request.error;
  how.time_limit_s = request.time;
  return how;
}

}  // namespace abbe::python
