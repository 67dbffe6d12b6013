#include "io/extension.h"

#include <algorithm>

#include <fmt/format.h>

#include "io/error.h"
#include "io/text.h"

namespace abbe {

std::string extension_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

void require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed) {
  if (std::find(allowed.begin(), allowed.end(), extension_of(path)) == allowed.end())
    throw Error(
        ErrorCode::usage, path.string(),
        fmt::format("got extension \"{}\", allowed {}", path.extension().string(), fmt::join(allowed, ", ")));
}

}  // namespace abbe
