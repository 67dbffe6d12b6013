#include "io/extension.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/error.h"

namespace abbe {

void require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed) {
  const auto same = [&path](const char* extension) { return path.extension() == extension; };
  if (std::none_of(allowed.begin(), allowed.end(), same))
    throw Error(
        ErrorCode::usage, path.string(),
        fmt::format("got extension \"{}\", allowed {}", path.extension().string(), fmt::join(allowed, ", ")));
}

}  // namespace abbe
