#pragma once

#include <filesystem>
#include <initializer_list>
#include <string>

namespace abbe {

/// The extension of a file's name in small letters, as ".exr": names tell kinds of files by it in either
/// case, since cameras write capitals. "" of a name without one.
[[nodiscard]] std::string extension_of(const std::filesystem::path& path);

/// Throws Error{usage} unless the extension, in either case, is one of the allowed, as ".exr".
void require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed);

}  // namespace abbe
