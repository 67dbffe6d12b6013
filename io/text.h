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
/// UTF-8 byte order mark, which spreadsheets write at the start of a text.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Reads a regular file of at most `limit_bytes` of UTF-8 text. Reports and returns nullptr for a missing
/// file, a folder, a FIFO or device, an oversized file, a NUL byte and invalid UTF-8.
[[nodiscard]] std::shared_ptr<const SourceText> read_text(const std::filesystem::path& path,
                                                          Diagnostics& diagnostics,
                                                          ErrorCode code = ErrorCode::input,
                                                          std::size_t limit_bytes = kMaxTextBytes);
/// Reads a text in UTF-8, UTF-16 or Windows-1252 and converts it to UTF-8.
/// - UTF-16 is recognised by its byte order mark, or by a zero byte in the first letter.
/// - Any other text that is not UTF-8 is taken as Windows-1252, which includes Latin-1.
/// Reports unpaired surrogates and bytes that are not letters.
[[nodiscard]] std::shared_ptr<const SourceText> read_unicode_text(const std::filesystem::path& path,
                                                                  Diagnostics& diagnostics,
                                                                  ErrorCode code = ErrorCode::input);
/// Reads standard input under the name "<stdin>", with the limits and errors of a file.
[[nodiscard]] std::shared_ptr<const SourceText> read_standard_input(Diagnostics& diagnostics, ErrorCode code);

/// The reason why `path` cannot be read. "no such file", or "not a regular file" for a folder, device, FIFO
/// or socket. Files in /proc, /sys and the like are not regular: reading them may block or never end. Nothing
/// for a regular file on disk.
[[nodiscard]] std::optional<std::string> file_fault(const std::filesystem::path& path);
/// Throws Error{input} with the text of `file_fault`, if there is one.
void require_file(const std::filesystem::path& path);
/// True if `path` is a regular file. Otherwise reports `file_fault` at `where`, the position that names the
/// path.
[[nodiscard]] bool is_file(const std::filesystem::path& path, const SourcePosition& where,
                           Diagnostics& diagnostics);

/// Number of leading bytes that are valid UTF-8 without NUL; the whole size for valid text.
[[nodiscard]] std::size_t valid_prefix(std::string_view text);

/// `text` with each invalid UTF-8 byte and NUL replaced by `replacement`, for names in other encodings.
[[nodiscard]] std::string valid_utf8(std::string_view text, std::string_view replacement = "\uFFFD");

/// Parses all of `text` as a finite number in the syntax of the C locale, whatever the process's locale.
/// Nothing if that fails.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// The pieces of `text` between separators, without surrounding blanks.
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

/// `text` with ASCII letters in lower case.
[[nodiscard]] std::string lower_case(std::string_view text);

/// The bytes in base64, as in data URLs [RFC4648, sec. 4].
[[nodiscard]] std::string base64(std::string_view bytes);

/// Provenance of a user's file: its name and the hash of its text.
[[nodiscard]] std::string user_source(const SourceText& text);

/// SHA-256 of the bytes, as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace abbe
