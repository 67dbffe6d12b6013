#include "description/meshes/gzip.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <zlib.h>

namespace abbe {
namespace {

constexpr std::size_t kPiece = std::size_t{1} << 20;

struct Close {
  void operator()(gzFile file) const { (void)gzclose(file); }
};
using File = std::unique_ptr<gzFile_s, Close>;

std::string fault_of(gzFile file) {
  int code = Z_OK;
  const char* message = gzerror(file, &code);
  return code == Z_BUF_ERROR ? "truncated: the compressed data are incomplete"
                             : fmt::format("damaged ({})", message);
}

}  // namespace

std::optional<std::string> read_gzip_bytes(const std::filesystem::path& path, std::size_t limit,
                                           std::string& bytes, MemoryReservation& memory) {
  const File file(gzopen(path.c_str(), "rb"));
  if (!file) return "cannot open the file";
  for (;;) {
    const std::size_t previous_size = bytes.size();
    if (bytes.capacity() < previous_size + kPiece) {
      const std::size_t room = std::max(2 * bytes.capacity(), previous_size + kPiece);
      memory.reserve(path.string(), room - bytes.capacity());
      bytes.reserve(room);
    }
    bytes.resize(previous_size + kPiece);
    const int read = gzread(file.get(), bytes.data() + previous_size, static_cast<unsigned>(kPiece));
    bytes.resize(previous_size + static_cast<std::size_t>(std::max(read, 0)));
    int code = Z_OK;
    (void)gzerror(file.get(), &code);
    if (read < 0 || code == Z_BUF_ERROR) return fault_of(file.get());
    if (gzdirect(file.get()) != 0) return "is not a gzip file";
    if (bytes.size() > limit) return fmt::format("unpacks to more than {} bytes", limit);
    if (read == 0) return std::nullopt;
  }
}

}  // namespace abbe
