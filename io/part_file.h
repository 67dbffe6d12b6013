#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace abbe {

/// Named texts and bytes that belong together. A file of them is read back whole or refused: its header
/// carries the length of the bytes and a SHA-256 of everything.
struct PartFile {
  std::map<std::string, std::string> header;  ///< Keys without ':', keys and values without line breaks.
  std::string bytes;
};

/// Writes header and bytes, of pieces one after another, to `path`, atomically. Throws Error{output}, and
/// Error{internal} for a header that could not be read back.
void write_part_file(const std::filesystem::path& path, const std::map<std::string, std::string>& header,
                     std::span<const std::string_view> pieces);
void write_part_file(const std::filesystem::path& path, const std::map<std::string, std::string>& header,
                     std::string_view bytes);

/// Throws Error{input} for a file that is missing, of another format, torn or changed.
[[nodiscard]] PartFile read_part_file(const std::filesystem::path& path);
/// The header alone, which costs the same whatever the length of the bytes. Throws Error{input} as
/// `read_part_file` does, but for changes, which the whole file alone tells.
[[nodiscard]] std::map<std::string, std::string> read_part_file_header(const std::filesystem::path& path);

}  // namespace abbe
