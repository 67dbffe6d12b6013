#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>

namespace abbe {

/// A header of named texts and a block of bytes. The file also stores the number of bytes and a SHA-256 of
/// everything, so that a damaged file is rejected.
struct PartFile {
  /// Keys contain no ':' and are not "bytes" or "sha256". Keys and values contain no line breaks.
  std::map<std::string, std::string> header;
  std::string bytes;
};

/// Writes a header and the concatenated `pieces` to `path`, atomically. Throws Error{output} if it cannot be
/// written, and Error{internal} for a header that contains forbidden characters or is longer than 16 MiB.
void write_part_file(const std::filesystem::path& path, const std::map<std::string, std::string>& header,
                     std::span<const std::string_view> pieces);
void write_part_file(const std::filesystem::path& path, const std::map<std::string, std::string>& header,
                     std::string_view bytes);

/// Reads a file, all of it into memory. Throws Error{input} if it is missing, has another format, is
/// truncated or does not match its hash.
[[nodiscard]] PartFile read_part_file(const std::filesystem::path& path);
/// Reads the header only, without the length and the hash. Throws Error{input} like `read_part_file`, except
/// that changed contents are not detected.
[[nodiscard]] std::map<std::string, std::string> read_part_file_header(const std::filesystem::path& path);

}  // namespace abbe
