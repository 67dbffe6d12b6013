#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/diagnostics.h"

namespace abbe {

inline constexpr std::size_t kMaxTextBytes = std::size_t{1} << 28;
/// What spreadsheets write before UTF-8 text.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Reads a regular file of at most `limit_bytes` of valid UTF-8 text. A missing file, a folder, a FIFO or
/// device, an oversized file, a NUL byte or invalid UTF-8 is reported and gives nullptr.
[[nodiscard]] std::shared_ptr<const SourceText> read_text(const std::filesystem::path& path,
                                                          Diagnostics& diagnostics,
                                                          ErrorCode code = ErrorCode::input,
                                                          std::size_t limit_bytes = kMaxTextBytes);
/// The same of a file that may be UTF-16 as well, which is told by its byte order mark, or by the zeros that
/// the letters of plain text have in it, or Windows-1252, which holds Latin-1 and is what any other text is
/// that is not UTF-8. Unpaired surrogates, and bytes that no letter has, are reported. The text given is
/// UTF-8.
[[nodiscard]] std::shared_ptr<const SourceText> read_unicode_text(const std::filesystem::path& path,
                                                                  Diagnostics& diagnostics,
                                                                  ErrorCode code = ErrorCode::input);
/// Reads standard input, whatever kind of file it is, under the name "<stdin>", with the limits and errors of
/// a file.
[[nodiscard]] std::shared_ptr<const SourceText> read_standard_input(Diagnostics& diagnostics, ErrorCode code);

/// The reason why `path` is not read: "no such file", or "not a regular file" for what may block its reader
/// or has no end. These are folders, devices, FIFOs, sockets, and what the kernel shows as files in /proc,
/// /sys and the like. Nothing for a file that a disk holds.
[[nodiscard]] std::optional<std::string> file_fault(const std::filesystem::path& path);
/// Throws Error{input} with that reason, if there is one.
void require_file(const std::filesystem::path& path);
/// True if there is none; else the path is reported at `where`, as what names it.
[[nodiscard]] bool is_file(const std::filesystem::path& path, const SourcePosition& where,
                           Diagnostics& diagnostics);

/// How many leading bytes of `text` are valid UTF-8 without NUL; all of them for a proper text.
[[nodiscard]] std::size_t valid_prefix(std::string_view text);

/// `text` with `instead` in place of each byte that valid UTF-8 has not there, and of NUL: a name that is in
/// another encoding, for files that say they are UTF-8.
[[nodiscard]] std::string valid_utf8(std::string_view text, std::string_view instead = "\uFFFD");

/// A finite number in the C locale's syntax, whatever the process's locale; nothing unless all of `text` is
/// one.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// `text` cut at every `separator`, each piece without surrounding blanks.
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

/// `text` with the capitals of ASCII as small letters.
[[nodiscard]] std::string lower_case(std::string_view text);

/// The bytes in base64, as data URLs hold them [RFC4648, sec. 4].
[[nodiscard]] std::string base64(std::string_view bytes);

/// The source of a user's file: its name and the hash of its text.
[[nodiscard]] std::string user_source(const SourceText& text);

/// SHA-256 of the bytes, as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace abbe
