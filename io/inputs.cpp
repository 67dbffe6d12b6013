#include "io/inputs.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>

#include <fmt/format.h>

#include "io/error.h"
#include "io/text.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

// Smallest number in the files called `name`, from a control group up to the root of its hierarchy.
std::uint64_t min_in_hierarchy(const fs::path& root, const std::string& group, const char* name) {
  std::uint64_t limit = UINT64_MAX;
  for (fs::path at = root / group; at.string().size() >= root.string().size(); at = at.parent_path()) {
    std::uint64_t bytes = 0;
    if (std::ifstream(at / name) >> bytes)
      limit = std::min(limit, bytes);  // Otherwise there is no file, or it has the word "max".
  }
  return limit;
}

// Memory limit of the control groups of this process, version 2 or 1. Their lines are "0::/GROUP" or
// "4:memory:/GROUP".
std::uint64_t control_group_limit() {
  const fs::path root = "/sys/fs/cgroup";
  std::uint64_t limit = UINT64_MAX;
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::vector<std::string> parts = split(line, ':');
    if (parts.size() != 3 || !parts[2].starts_with('/')) continue;
    const std::string group = parts[2].substr(1);
    if (parts[1].empty()) limit = std::min(limit, min_in_hierarchy(root, group, "memory.max"));
    if (parts[1] == "memory")
      limit = std::min(limit, min_in_hierarchy(root / "memory", group, "memory.limit_in_bytes"));
  }
  return limit;
}

}  // namespace

std::size_t default_memory_limit() {
  constexpr double kFraction = 0.8;
  std::uint64_t bytes = static_cast<std::uint64_t>(::sysconf(_SC_PHYS_PAGES)) *
                        static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  bytes = std::min(bytes, control_group_limit());
  rlimit space{};
  if (::getrlimit(RLIMIT_AS, &space) == 0) bytes = std::min<std::uint64_t>(bytes, space.rlim_cur);
  return static_cast<std::size_t>(kFraction * static_cast<double>(bytes));
}

std::string bytes_text(std::size_t bytes) {
  constexpr std::array kUnits{"kB", "MB", "GB", "TB"};
  if (bytes < 1000) return fmt::format("{} B", bytes);
  double count = static_cast<double>(bytes) / 1000;
  std::size_t unit = 0;
  for (; count >= 999.95 && unit + 1 < kUnits.size(); ++unit) count /= 1000;
  return fmt::format("{:.1f} {}", count, kUnits.at(unit));
}

void Inputs::reserve_memory(const std::string& what, std::size_t bytes) {
  const std::size_t left = limit_ - std::min(reserved_, limit_);
  if (bytes > left)
    throw Error(ErrorCode::resource, what,
                fmt::format("needs {} of memory (allowed {}, of {} in all; --max-memory allows more)",
                            bytes_text(bytes), bytes_text(left), bytes_text(limit_)));
  reserved_ += bytes;
}

}  // namespace abbe
