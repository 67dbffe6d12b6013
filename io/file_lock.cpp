#include "io/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "io/atomic_file.h"
#include "io/error.h"

namespace abbe {
namespace {

// True if `path` still names the locked file: its last owner may have removed it in between.
bool is_current(int descriptor, const std::filesystem::path& path) {
  struct stat locked_file {};
  struct stat named_file {};
  return ::fstat(descriptor, &locked_file) == 0 && ::stat(path.c_str(), &named_file) == 0 &&
         locked_file.st_ino == named_file.st_ino && locked_file.st_dev == named_file.st_dev;
}

}  // namespace

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
