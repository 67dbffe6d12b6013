// Reads the chunks of a PNG: verifies their checksums and finds chunks that OpenImageIO does not report.
#include <array>
#include <fstream>
#include <optional>

#include <boost/crc.hpp>

#include "io/picture_module.h"

namespace abbe::picture_module {
namespace {

struct Chunk {
  std::string type;
  std::vector<std::uint8_t> data;
};

/// Reads a file chunk by chunk, if it is a PNG.
class PngFile {
 public:
  explicit PngFile(const std::string& path) : file_(path, std::ios::binary | std::ios::ate) {
    constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
    size_ = static_cast<std::uint64_t>(file_.tellg());
    file_.seekg(0);
    std::string begin(kSignature.size(), '\0');
    is_png_ = file_.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == kSignature;
  }
  /// True if the file has a PNG signature.
  [[nodiscard]] bool is_png() const { return is_png_; }

  /// The next chunk. Nothing if it is truncated or its checksum is wrong.
  std::optional<Chunk> next() {
    constexpr std::uint64_t kAround = 12;  // Length, type and checksum [bytes].
    const std::uint64_t left = size_ - static_cast<std::uint64_t>(file_.tellg());
    const std::uint32_t length = left < kAround ? 0 : number();
    if (left < kAround || length > left - kAround) return std::nullopt;
    Chunk chunk{std::string(4, '\0'), std::vector<std::uint8_t>(length)};
    file_.read(chunk.type.data(), 4);
    if (length > 0) file_.read(reinterpret_cast<char*>(chunk.data.data()), length);
    boost::crc_32_type crc;
    crc.process_bytes(chunk.type.data(), chunk.type.size());
    crc.process_bytes(chunk.data.data(), chunk.data.size());
    const bool is_sound = number() == crc.checksum() && file_;
    return is_sound ? std::optional(std::move(chunk)) : std::nullopt;
  }

 private:
  std::uint32_t number() {
    std::array<std::uint8_t, 4> bytes{};
    file_.read(reinterpret_cast<char*>(bytes.data()), 4);
    return big_endian(bytes, 0);
  }

  std::ifstream file_;
  std::uint64_t size_ = 0;
  bool is_png_ = false;
};

}  // namespace

bool is_damaged_png(const std::string& path) {
  PngFile file(path);
  if (!file.is_png()) return false;
  for (auto chunk = file.next(); chunk; chunk = file.next())
    if (chunk->type == "IEND") return false;
  return true;
}

std::optional<std::vector<std::uint8_t>> png_chunk(const std::string& path, std::string_view type) {
  PngFile file(path);
  for (auto chunk = file.next(); chunk && chunk->type != "IDAT"; chunk = file.next())
    if (chunk->type == type) return std::move(chunk->data);
  return std::nullopt;
}

}  // namespace abbe::picture_module
