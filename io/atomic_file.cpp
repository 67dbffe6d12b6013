#include "io/atomic_file.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/error.h"
#include "io/text.h"

namespace abbe {

namespace {
namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& message) {
  throw Error(ErrorCode::output, path.string(), message);
}

std::string reason() {
  return std::generic_category().message(errno);
}

// Stem of the temporary files and the lock of a file: its name, or the hash of a long one.
std::string companion_stem(const std::string& name) {
  constexpr std::size_t kMaxNameBytes = 200;  // File systems allow 255 bytes.
  return name.size() > kMaxNameBytes ? sha256(name) : name;
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

std::string temporary_prefix(const fs::path& path) {
  return fmt::format(".{}.abbe-", companion_stem(path.stem().string()));
}

/// Name of a temporary file. It keeps the extension, from which image libraries choose the format, and is
/// unique among processes and threads.
fs::path temporary_for(const fs::path& path) {
  static std::atomic<unsigned> count = 0;
  return folder_of(path) /
         fmt::format("{}{}-{}{}", temporary_prefix(path), ::getpid(), count++, path.extension().string());
}

/// Waits until a file or folder has been written to disk.
void flush(const fs::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) fail(path, fmt::format("cannot reopen ({})", reason()));
  const bool flushed = ::fsync(descriptor) == 0;
  const std::string why = flushed ? "" : reason();
  ::close(descriptor);
  if (!flushed) fail(path, fmt::format("cannot flush to disk ({})", why));
}

/// True if the next bytes of the file are `bytes`; reads as many.
bool starts_with(std::istream& file, std::string_view bytes) {
  std::array<char, 1 << 16> block;
  while (!bytes.empty()) {
    const std::string_view part = bytes.substr(0, block.size());
    file.read(block.data(), static_cast<std::streamsize>(part.size()));
    if (!file || std::string_view(block.data(), part.size()) != part) return false;
    bytes.remove_prefix(part.size());
  }
  return true;
}

/// Removes its file when destroyed; after the rename there is none.
struct Removal {
  explicit Removal(fs::path file) : path(std::move(file)) {}
  Removal(const Removal&) = delete;
  Removal& operator=(const Removal&) = delete;
  ~Removal() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }

  fs::path path;
};

// True if `path` still names the locked file: its last owner may have removed it in between.
bool is_current(int descriptor, const std::filesystem::path& path) {
  struct stat locked_file {};
  struct stat named_file {};
  return ::fstat(descriptor, &locked_file) == 0 && ::stat(path.c_str(), &named_file) == 0 &&
         locked_file.st_ino == named_file.st_ino && locked_file.st_dev == named_file.st_dev;
}

// Removes temporary files whose processes no longer run, except those that cannot be removed.
void remove_leftovers(const fs::path& name) {
  const fs::path path = destination(name);
  const std::string prefix = temporary_prefix(path);
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_of(path), ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix) || entry.path().extension() != path.extension()) continue;
    const auto process = parse_number(split(std::string_view(name).substr(prefix.size()), '-').front());
    if (process && ::kill(static_cast<pid_t>(*process), 0) != 0 && errno == ESRCH)
      fs::remove(entry.path(), ignored);
  }
}
}  // namespace

fs::path destination(const fs::path& path) {
  constexpr int kMaxLinks = 40;  // Limit of the operating system.
  std::error_code ignored;
  fs::path end = path;
  for (int links = 0; links < kMaxLinks && fs::is_symlink(end, ignored); ++links)
    end = folder_of(end) / fs::read_symlink(end, ignored);
  return end;
}

void write_atomically(const fs::path& name, const std::function<void(const fs::path&)>& write,
                      const std::function<bool(const fs::path&)>& verify) {
  require_writable(name);
  const fs::path path = destination(name);
  const Removal temporary(temporary_for(path));
  try {
    write(temporary.path);
    flush(temporary.path);
    if (!verify(temporary.path)) fail(path, "the written file does not read back; is the disk full?");
    fs::rename(temporary.path, path);
    flush(folder_of(path));
  } catch (const Error& error) {
    if (error.code != ErrorCode::input) throw;  // A file that cannot be read back is an output failure.
    fail(path, error.what());
  } catch (const std::exception& error) {
    fail(path, error.what());
  }
}

void write_atomically(const fs::path& path, std::span<const std::string_view> pieces) {
  write_atomically(
      path,
      [&](const fs::path& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        for (const std::string_view piece : pieces)
          file.write(piece.data(), static_cast<std::streamsize>(piece.size()));
        file.close();
        if (!file) fail(path, fmt::format("cannot write ({})", reason()));
      },
      [&](const fs::path& temporary) {
        std::ifstream file(temporary, std::ios::binary);
        return std::all_of(pieces.begin(), pieces.end(),
                           [&file](std::string_view piece) { return starts_with(file, piece); }) &&
               file.peek() == std::ifstream::traits_type::eof();
      });
}

void write_atomically(const fs::path& path, std::string_view bytes) {
  write_atomically(path, std::span(&bytes, 1));
}

void require_writable(const fs::path& name) {
  std::error_code ignored;
  const fs::path path = destination(name);
  const fs::path folder = folder_of(path);
  if (!path.has_filename()) fail(path, "no file name");
  if (!fs::is_directory(folder, ignored)) fail(path, fmt::format("no such folder \"{}\"", folder.string()));
  std::error_code unknown;
  const fs::file_status status = fs::status(path, unknown);
  if (unknown == std::errc::filename_too_long) fail(path, "the name is longer than the file system allows");
  if (fs::is_directory(status)) fail(path, "is a folder");
  if (fs::is_symlink(path, ignored)) fail(path, "is a cycle of symbolic links");
  if (fs::exists(status) && !fs::is_regular_file(status)) fail(path, "is a device, not a regular file");
  if (fs::exists(status) && ::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
    fail(path, fmt::format("cannot be replaced ({})", reason()));
  const Removal trial(temporary_for(path));
  const int descriptor = ::open(trial.path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (descriptor < 0) fail(path, fmt::format("cannot create a file in its folder ({})", reason()));
  ::close(descriptor);
}

FileLock::FileLock(const std::filesystem::path& path) : descriptor_(-1) {
  const std::filesystem::path end = destination(path);
  lock_ = end.parent_path() / fmt::format(".{}.lock", companion_stem(end.filename().string()));
  while (true) {
    descriptor_ = ::open(lock_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    const bool locked = descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    if (locked && is_current(descriptor_, lock_)) break;
    const int error = errno;
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!locked)
      throw Error(ErrorCode::output, path.string(),
                  error == EWOULDBLOCK
                      ? "another process is writing it"
                      : fmt::format("cannot lock it ({})", std::generic_category().message(error)));
  }
  remove_leftovers(path);
}

FileLock::~FileLock() {
  ::unlink(lock_.c_str());
  ::close(descriptor_);
}

}  // namespace abbe
