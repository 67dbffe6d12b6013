#include "io/part_file.h"

#include <fmt/format.h>

#include <fstream>
#include <sstream>
#include <vector>

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

// Limit for format line and header; a longer header is damaged.
constexpr std::size_t kMaxHeaderBytes = std::size_t{1} << 24;

std::string header_text(const std::map<std::string, std::string>& header) {
  std::string text;
  for (const auto& [key, value] : header) {
    if (key.find_first_of(":\n") != std::string::npos || value.find('\n') != std::string::npos)
      throw Error(ErrorCode::internal, key, "a line break or colon in the header of a part file");
    text += fmt::format("{}: {}\n", key, value);
  }
  return text;
}

std::string hash(const std::map<std::string, std::string>& header, std::span<const std::string_view> pieces) {
  return sha256(sha256(header_text(header)) + sha256_of_pieces(pieces));
}

// Reads the format line, then `key: value` lines up to an empty one.
std::map<std::string, std::string> read_header(std::istream& file, const fs::path& path) {
  std::string text(kMaxHeaderBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (!text.starts_with(fmt::format("{}\n", kFormat)))
    refuse(path, fmt::format("not a part file (expected the first line \"{}\")", kFormat));
  const std::size_t end = text.find("\n\n");
  if (end == std::string::npos) refuse(path, "damaged header");
  file.clear();
  file.seekg(static_cast<std::streamoff>(end + 2));
  std::map<std::string, std::string> header;
  std::istringstream lines(text.substr(0, end));
  std::string line;
  std::getline(lines, line);  // The format line.
  while (std::getline(lines, line)) {
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

/// A part file, read up to its bytes. The file holds exactly `byte_count` of them.
struct OpenPartFile {
  std::ifstream file;
  std::map<std::string, std::string> header;  ///< Without the length and the hash.
  std::string hash;
  std::size_t byte_count = 0;
};

// Number of bytes that follow in the open file. The path is not used: another file may have its name by now.
std::size_t rest_of(std::ifstream& file) {
  const std::streampos here = file.tellg();
  file.seekg(0, std::ios::end);
  const std::streamoff rest = file.tellg() - here;
  file.seekg(here);
  return static_cast<std::size_t>(rest);
}

OpenPartFile open_part_file(const fs::path& path) {
  require_file(path);
  OpenPartFile open{std::ifstream(path, std::ios::binary), {}, {}};
  if (!open.file) refuse(path, "cannot open the file");
  open.header = read_header(open.file, path);
  open.hash = take(open.header, kHash, path);
  const std::string length = take(open.header, kBytes, path);
  open.byte_count = rest_of(open.file);
  if (length != fmt::format("{}", open.byte_count))  // Checked before memory of that length is allocated.
    refuse(path, fmt::format("truncated or extended: the header declares {} bytes of sums, the file has {}",
                             length, open.byte_count));
  return open;
}

}  // namespace

void write_part_file(const fs::path& path, const std::map<std::string, std::string>& header,
                     std::span<const std::string_view> pieces) {
  std::size_t size = 0;
  for (const std::string_view piece : pieces) size += piece.size();
  const std::string start = fmt::format("{}\n{}{}: {}\n{}: {}\n\n", kFormat, header_text(header), kBytes,
                                        size, kHash, hash(header, pieces));
  if (start.size() > kMaxHeaderBytes)
    throw Error(ErrorCode::internal, path.string(), "a header too long for a part file");
  std::vector<std::string_view> all{start};
  all.insert(all.end(), pieces.begin(), pieces.end());
  write_atomically(path, all);
}

void write_part_file(const fs::path& path, const std::map<std::string, std::string>& header,
                     std::string_view bytes) {
  write_part_file(path, header, std::span(&bytes, 1));
}

PartFile read_part_file(const fs::path& path) {
  OpenPartFile open = open_part_file(path);
  PartFile part{std::move(open.header), std::string(open.byte_count, '\0')};
  open.file.read(part.bytes.data(), static_cast<std::streamsize>(open.byte_count));
  const std::string_view bytes = part.bytes;
  if (!open.file || hash(part.header, std::span(&bytes, 1)) != open.hash)
    refuse(path, "damaged: the contents do not match the declared hash");
  return part;
}

std::map<std::string, std::string> read_part_file_header(const fs::path& path) {
  return open_part_file(path).header;
}

}  // namespace abbe
