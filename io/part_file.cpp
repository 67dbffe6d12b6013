#include "io/part_file.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <system_error>

#include "io/atomic_file.h"
#include "io/error.h"
#include "io/text.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFormat = "abbepart 1";
constexpr std::string_view kBytes = "bytes";
constexpr std::string_view kHash = "sha256";

[[noreturn]] void refuse(const fs::path& path, const std::string& message) {
  throw Error(ErrorCode::input, path.string(), message);
}

std::string header_text(const std::map<std::string, std::string>& header) {
  std::string text;
  for (const auto& [key, value] : header) text += fmt::format("{}: {}\n", key, value);
  return text;
}

std::string hash(const std::map<std::string, std::string>& header, std::string_view bytes) {
  return sha256(sha256(header_text(header)) + sha256(bytes));
}

// The format's line, then `key: value` lines up to an empty one.
std::map<std::string, std::string> read_header(std::istream& file, const fs::path& path) {
  std::string line(kFormat.size() + 1, '\0');
  file.read(line.data(), static_cast<std::streamsize>(line.size()));
  if (line != fmt::format("{}\n", kFormat)) refuse(path, fmt::format("not a part file (\"{}\")", kFormat));
  std::map<std::string, std::string> header;
  while (std::getline(file, line) && !line.empty()) {
    const std::size_t colon = line.find(": ");
    if (colon == std::string::npos) refuse(path, "damaged header");
    header[line.substr(0, colon)] = line.substr(colon + 2);
  }
  return header;
}

std::string take(std::map<std::string, std::string>& header, std::string_view key, const fs::path& path) {
  auto entry = header.extract(std::string(key));
  if (!entry) refuse(path, "damaged header");
  return std::move(entry.mapped());
}

}  // namespace

void write_part_file(const fs::path& path, const std::map<std::string, std::string>& header,
                     std::string_view bytes) {
  const std::string start = fmt::format("{}\n{}{}: {}\n{}: {}\n\n", kFormat, header_text(header), kBytes,
                                        bytes.size(), kHash, hash(header, bytes));
  write_atomically(path, std::array{std::string_view(start), bytes});
}

PartFile read_part_file(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) refuse(path, "no such file");
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, "cannot open the file");
  PartFile part{read_header(file, path), {}};
  const std::string expected = take(part.header, kHash, path);
  const std::string length = take(part.header, kBytes, path);
  const auto rest = fs::file_size(path, ignored) - static_cast<std::uintmax_t>(file.tellg());
  if (length != fmt::format("{}", rest))  // before anything of that length is allocated
    refuse(path, fmt::format("torn: it should hold {} bytes of sums and holds {}", length, rest));
  part.bytes.resize(rest);
  file.read(part.bytes.data(), static_cast<std::streamsize>(rest));
  if (!file || hash(part.header, part.bytes) != expected)
    refuse(path, "damaged: its contents do not have the hash it states");
  return part;
}

}  // namespace abbe
