#include "io/text.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iconv.h>
#include <linux/magic.h>
#include <openssl/evp.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>
#include <boost/locale/utf.hpp>

#include "io/error.h"

namespace abbe {

namespace {
constexpr const char* kNoRegularFile = "not a regular file";

std::string reason(int error) {
  return std::generic_category().message(error);
}

class Descriptor {
 public:
  /// O_NONBLOCK: does not wait for the writer of a FIFO.
  explicit Descriptor(const std::filesystem::path& path)
      : value_(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (value_ >= 0) ::close(value_);
  }
  [[nodiscard]] int value() const { return value_; }

 private:
  int value_;
};

/// True for a file system whose files the kernel generates when they are read. Reading its regular files may
/// block.
bool is_made_by_kernel(const struct statfs& system) {
  constexpr std::array<std::uint64_t, 10> kMadeByKernel{
      PROC_SUPER_MAGIC,   SYSFS_MAGIC,    DEBUGFS_MAGIC,       TRACEFS_MAGIC, SECURITYFS_MAGIC,
      CGROUP_SUPER_MAGIC, PSTOREFS_MAGIC, CGROUP2_SUPER_MAGIC, BPF_FS_MAGIC,  SELINUX_MAGIC};
  return std::ranges::find(kMadeByKernel, static_cast<std::uint64_t>(system.f_type)) != kMadeByKernel.end();
}

/// Appends bytes until `bytes` has `limit` bytes. Returns the error number, or 0 at the limit or the end of
/// the file.
int read_bytes(int descriptor, std::size_t limit, std::string& bytes) {
  std::array<char, 1 << 16> block;
  while (bytes.size() < limit) {
    const ssize_t got = ::read(descriptor, block.data(), std::min(block.size(), limit - bytes.size()));
    if (got == 0) break;
    if (got > 0)
      bytes.append(block.data(), static_cast<std::size_t>(got));
    else if (errno != EINTR)
      return errno;
  }
  return 0;
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

constexpr std::size_t kFile = SourcePosition::kWholeFile;

std::nullptr_t refuse(const std::shared_ptr<const SourceText>& source, std::size_t offset,
                      std::string message, ErrorCode code, Diagnostics& diagnostics) {
  diagnostics.error({source, offset, ""}, std::move(message), code);
  return nullptr;
}

std::nullptr_t refuse_length(const std::shared_ptr<const SourceText>& source, std::size_t limit_bytes,
                             Diagnostics& diagnostics) {
  return refuse(source, kFile, fmt::format("file too large (allowed {} bytes)", limit_bytes),
                ErrorCode::resource, diagnostics);
}

// Reads the open file into `source`. False after an error.
bool read_source(int descriptor, const std::shared_ptr<SourceText>& source, Diagnostics& diagnostics,
                 ErrorCode code, std::size_t limit_bytes) {
  if (const int error = read_bytes(descriptor, limit_bytes + 1, source->text)) {
    refuse(source, kFile, fmt::format("cannot read the file ({})", reason(error)), code, diagnostics);
    return false;
  }
  if (source->text.size() <= limit_bytes) return true;
  refuse_length(source, limit_bytes, diagnostics);
  return false;
}

std::shared_ptr<SourceText> read_source(const std::filesystem::path& path, Diagnostics& diagnostics,
                                        ErrorCode code, std::size_t limit_bytes) {
  auto source = std::make_shared<SourceText>(SourceText{path.string(), {}});
  const Descriptor file(path);
  struct stat status {};
  if (file.value() < 0 || ::fstat(file.value(), &status) != 0)
    return refuse(source, kFile, fmt::format("cannot open the file ({})", reason(errno)), code, diagnostics);
  if (!S_ISREG(status.st_mode)) return refuse(source, kFile, kNoRegularFile, code, diagnostics);
  if (status.st_size > 0 && static_cast<std::size_t>(status.st_size) > limit_bytes)
    return refuse_length(source, limit_bytes, diagnostics);
  if (!read_source(file.value(), source, diagnostics, code, limit_bytes)) return nullptr;
  return source;
}

// The source, if its bytes are valid UTF-8; otherwise reports and returns nullptr.
std::shared_ptr<const SourceText> checked(const std::shared_ptr<SourceText>& source, Diagnostics& diagnostics,
                                          ErrorCode code) {
  if (source->text.starts_with(kByteOrderMark)) source->text.erase(0, kByteOrderMark.size());
  const std::size_t valid = valid_prefix(source->text);
  if (valid == source->text.size()) return source;
  const auto byte = static_cast<unsigned char>(source->text[valid]);
  source->text.resize(valid);  // Excerpts must not show the invalid bytes.
  return refuse(source, valid,
                byte == 0 ? "NUL byte in a text" : fmt::format("invalid UTF-8 (got byte 0x{:02X})", byte),
                code, diagnostics);
}

enum class ByteOrder { little, big };

// Byte order of UTF-16, from its mark or from the byte of the first letter that is zero. Nothing for other
// encodings.
std::optional<ByteOrder> utf16_order(std::string_view bytes) {
  if (bytes.size() < 2) return std::nullopt;
  if (bytes.starts_with("\xFF\xFE")) return ByteOrder::little;
  if (bytes.starts_with("\xFE\xFF")) return ByteOrder::big;
  if (bytes[0] != 0 && bytes[1] == 0) return ByteOrder::little;
  if (bytes[0] == 0 && bytes[1] != 0) return ByteOrder::big;
  return std::nullopt;
}

// The code units of a UTF-16 text, without its mark.
std::u16string utf16_units(std::string_view bytes, ByteOrder order) {
  std::u16string units;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    units += static_cast<char16_t>(order == ByteOrder::little ? first | second << 8 : first << 8 | second);
  }
  if (units.starts_with(u'\uFEFF')) units.erase(0, 1);
  return units;
}

// Appends the text as UTF-8, up to the first unpaired surrogate. False if there is one.
bool append_utf8(const std::u16string& units, std::string& text) {
  using Utf16 = boost::locale::utf::utf_traits<char16_t>;
  const char16_t* at = units.data();
  const char16_t* const end = at + units.size();
  while (at != end) {
    const boost::locale::utf::code_point point = Utf16::decode(at, end);
    if (!boost::locale::utf::is_valid_codepoint(point)) return false;
    boost::locale::utf::utf_traits<char>::encode(point, std::back_inserter(text));
  }
  return true;
}

// Converts the source from Windows-1252 to UTF-8. Reports the first byte that is not a letter, and returns
// nullptr.
std::shared_ptr<const SourceText> from_windows_1252(const std::shared_ptr<SourceText>& source,
                                                    Diagnostics& diagnostics, ErrorCode code) {
  const iconv_t converter = ::iconv_open("UTF-8", "WINDOWS-1252");
  // iconv reports an error by this pointer value.
  if (std::bit_cast<std::intptr_t>(converter) == -1)
    throw Error(ErrorCode::input, "", "the C library of this system does not convert Windows-1252");
  std::string bytes = std::move(source->text);
  std::string text(3 * bytes.size(), '\0');  // A letter takes at most three bytes.
  char* from = bytes.data();
  std::size_t left = bytes.size();
  char* to = text.data();
  std::size_t space_left = text.size();
  ::iconv(converter, &from, &left, &to, &space_left);
  ::iconv_close(converter);
  text.resize(text.size() - space_left);
  source->text = std::move(text);
  if (left == 0) return checked(source, diagnostics, code);
  return refuse(
      source, source->text.size(),
      fmt::format("neither UTF-8 nor Windows-1252 (got byte 0x{:02X})", static_cast<unsigned char>(*from)),
      code, diagnostics);
}
}  // namespace

std::shared_ptr<const SourceText> read_text(const std::filesystem::path& path, Diagnostics& diagnostics,
                                            ErrorCode code, std::size_t limit_bytes) {
  const auto source = read_source(path, diagnostics, code, limit_bytes);
  return source ? checked(source, diagnostics, code) : nullptr;
}

std::shared_ptr<const SourceText> read_unicode_text(const std::filesystem::path& path,
                                                    Diagnostics& diagnostics, ErrorCode code) {
  const auto source = read_source(path, diagnostics, code, kMaxTextBytes);
  if (!source) return nullptr;
  const auto order = utf16_order(source->text);
  if (!order) {
    const std::size_t valid = valid_prefix(source->text);
    const bool utf8 =
        valid == source->text.size() || source->text[valid] == 0 || source->text.starts_with(kByteOrderMark);
    return utf8 ? checked(source, diagnostics, code) : from_windows_1252(source, diagnostics, code);
  }
  const bool whole = source->text.size() % 2 == 0;
  const std::u16string units = utf16_units(source->text, *order);
  source->text.clear();
  if (!append_utf8(units, source->text) || !whole)
    return refuse(source, source->text.size(), "invalid UTF-16 (half of a character)", code, diagnostics);
  return checked(source, diagnostics, code);
}

std::shared_ptr<const SourceText> read_standard_input(Diagnostics& diagnostics, ErrorCode code) {
  const auto source = std::make_shared<SourceText>(SourceText{kStandardInputName, {}});
  if (!read_source(STDIN_FILENO, source, diagnostics, code, kMaxTextBytes)) return nullptr;
  return checked(source, diagnostics, code);
}

std::optional<std::string> file_fault(const std::filesystem::path& path) {
  struct stat status {};
  struct statfs system {};
  if (::stat(path.c_str(), &status) != 0 || ::statfs(path.c_str(), &system) != 0) return "no such file";
  if (!S_ISREG(status.st_mode) || is_made_by_kernel(system)) return kNoRegularFile;
  return std::nullopt;
}

void require_file(const std::filesystem::path& path) {
  if (const auto fault = file_fault(path)) throw Error(ErrorCode::input, path.string(), *fault);
}

bool is_file(const std::filesystem::path& path, const SourcePosition& where, Diagnostics& diagnostics) {
  const auto fault = file_fault(path);
  if (fault) diagnostics.error(where, fmt::format("{} \"{}\"", *fault, path.string()), ErrorCode::input);
  return !fault;
}

std::size_t valid_prefix(std::string_view text) {
  using Utf8 = boost::locale::utf::utf_traits<char>;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at != end) {
    const char* const start = at;
    const boost::locale::utf::code_point point = Utf8::decode(at, end);
    if (point == 0 || !boost::locale::utf::is_valid_codepoint(point))
      return static_cast<std::size_t>(start - text.data());
  }
  return text.size();
}

std::string valid_utf8(std::string_view text, std::string_view replacement) {
  std::string valid;
  for (;;) {
    const std::size_t size = valid_prefix(text);
    valid += text.substr(0, size);
    if (size == text.size()) return valid;
    valid += replacement;
    text.remove_prefix(size + 1);
  }
}

std::optional<double> parse_number(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> pieces;
  for (;;) {
    const std::size_t cut = text.find(separator);
    pieces.emplace_back(trimmed(text.substr(0, cut)));
    if (cut == std::string_view::npos) return pieces;
    text.remove_prefix(cut + 1);
  }
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
}

std::string base64(std::string_view bytes) {
  std::string text((bytes.size() + 2) / 3 * 4 + 1,
                   '\0');  // Includes the terminating zero that OpenSSL writes.
  const auto* from = reinterpret_cast<const unsigned char*>(bytes.data());
  auto* to = reinterpret_cast<unsigned char*>(text.data());
  text.resize(static_cast<std::size_t>(EVP_EncodeBlock(to, from, static_cast<int>(bytes.size()))));
  return text;
}

std::string user_source(const SourceText& text) {
  return fmt::format("{} (SHA-256 {})", text.file, sha256(text.text));
}

std::string sha256(std::string_view bytes) {
  return sha256_of_pieces(std::span(&bytes, 1));
}

std::string extension_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

void require_extension(const std::filesystem::path& path, std::initializer_list<const char*> allowed) {
  if (std::find(allowed.begin(), allowed.end(), extension_of(path)) == allowed.end())
    throw Error(
        ErrorCode::usage, path.string(),
        fmt::format("got extension \"{}\", allowed {}", path.extension().string(), fmt::join(allowed, ", ")));
}

std::string sha256_of_pieces(std::span<const std::string_view> pieces) {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), EVP_MD_CTX_free);
  bool good = context && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1;
  for (const std::string_view piece : pieces)
    good = good && EVP_DigestUpdate(context.get(), piece.data(), piece.size()) == 1;
  std::array<unsigned char, 32> digest;
  if (!good || EVP_DigestFinal_ex(context.get(), digest.data(), nullptr) != 1)
    throw Error(ErrorCode::internal, "", "SHA-256 is not available");
  return fmt::format("{:02x}", fmt::join(digest, ""));
}

}  // namespace abbe
