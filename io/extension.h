#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

namespace abbe {

/// The extension of a file name in lower case, such as ".exr"; "" if there is none. File types are recognised
/// in either case, since cameras write upper-case extensions.
[[nodiscard]] std::string extension_of(const std::filesystem::path& path);

/// Throws Error{usage} unless the extension is one of `allowed`, which are in lower case with a dot, such as
/// ".exr". The path may have it in either case.
void require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed);

}  // namespace abbe
