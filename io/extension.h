#pragma once

#include <filesystem>
#include <initializer_list>

namespace abbe {

/// Throws Error{usage} unless the extension is one of the allowed, as ".exr".
void require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed);

}  // namespace abbe
