#pragma once

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/diagnostics.h"

namespace abbe {

/// Largest text that is read [bytes], if the caller gives no other limit.
inline constexpr std::size_t kMaxTextBytes = std::size_t{1} << 28;
/// UTF-8 byte order mark, which spreadsheets write at the start of a text.
inline constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// Reads a regular file of at most `limit_bytes` of UTF-8 text, without its byte order mark. Reports with
/// `code` and returns nullptr for a missing file, a folder, a FIFO or device, a NUL byte and invalid UTF-8.
/// An oversized file has the code `resource`.
[[nodiscard]] std::shared_ptr<const SourceText> read_text(const std::filesystem::path& path,
                                                          Diagnostics& diagnostics,
                                                          ErrorCode code = ErrorCode::input,
                                                          std::size_t limit_bytes = kMaxTextBytes);
/// Reads a text in UTF-8, UTF-16 or Windows-1252 and converts it to UTF-8 without a byte order mark. UTF-16
/// is recognised by its byte order mark, or by a zero byte in the first letter; any other text that is not
/// UTF-8 is taken as Windows-1252. Reports and returns nullptr as `read_text`, and for unpaired surrogates
/// and bytes without a letter in Windows-1252. Throws Error{input} if the C library cannot convert
/// Windows-1252.
[[nodiscard]] std::shared_ptr<const SourceText> read_unicode_text(const std::filesystem::path& path,
                                                                  Diagnostics& diagnostics,
                                                                  ErrorCode code = ErrorCode::input);
/// The path that means standard input for reading and standard output for writing.
inline constexpr const char* kStandardStream = "-";

/// Name of standard input in messages.
inline constexpr const char* kStandardInputName = "<stdin>";

/// Name in messages of a path that is read.
[[nodiscard]] inline std::string input_name(const std::filesystem::path& path) {
  return path == kStandardStream ? kStandardInputName : path.string();
}

/// Reads standard input to its end under the name "<stdin>". Limit, reports and result are those of
/// `read_text`.
[[nodiscard]] std::shared_ptr<const SourceText> read_standard_input(Diagnostics& diagnostics, ErrorCode code);

/// The reason why `path` cannot be read. "no such file" also if a folder on the way is not accessible. "not a
/// regular file" for a folder, device, FIFO or socket, and in /proc, /sys and the like, which may block.
/// Nothing for a regular file on disk; its permissions are not checked.
[[nodiscard]] std::optional<std::string> file_fault(const std::filesystem::path& path);
/// Throws Error{input} with the text of `file_fault`, if there is one.
void require_file(const std::filesystem::path& path);
/// True if `path` has no `file_fault`. Otherwise reports it with the code `input` at `where`, the position
/// that names the path.
[[nodiscard]] bool is_file(const std::filesystem::path& path, const SourcePosition& where,
                           Diagnostics& diagnostics);

/// The extension of a file name in lower case, such as ".exr"; "" if there is none.
[[nodiscard]] std::string extension_of(const std::filesystem::path& path);

/// Throws Error{usage} unless the extension, in either case, is one of `allowed`, which are such as ".exr".
void require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed);

/// Number of leading bytes that are valid UTF-8 without NUL; the whole size for valid text.
[[nodiscard]] std::size_t valid_prefix(std::string_view text);

/// `text` with each invalid UTF-8 byte and NUL replaced by `replacement`, by default U+FFFD; for names in
/// other encodings.
[[nodiscard]] std::string valid_utf8(std::string_view text, std::string_view replacement = "\uFFFD");

/// Parses all of `text` as a finite decimal number in the syntax of the C locale. A leading sign is allowed,
/// blanks and hexadecimal digits are not. Nothing if that fails, or if the number is outside the range of
/// double.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

/// The pieces of `text` between separators, without surrounding blanks, tabs and line ends. Pieces may be
/// empty; there is one more than separators.
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

/// `text` with ASCII letters in lower case.
[[nodiscard]] std::string lower_case(std::string_view text);

/// The bytes in base64 with padding and without line breaks, as in data URLs [RFC4648, sec. 4]. At most 1
/// GiB.
[[nodiscard]] std::string base64(std::string_view bytes);

[[nodiscard]] std::string user_source(const SourceText& text);

/// SHA-256 of the bytes, as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);
/// SHA-256 of the concatenated pieces, as 64 lower-case hexadecimal digits. Throws Error{internal} if OpenSSL
/// does not provide it.
[[nodiscard]] std::string sha256_of_pieces(std::span<const std::string_view> pieces);

}  // namespace abbe
