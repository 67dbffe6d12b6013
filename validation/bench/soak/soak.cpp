#include "validation/bench/soak/soak.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <exception>

#include <fmt/format.h>

#include "io/error.h"
#include "validation/bench/soak/check.h"

namespace abbe {
namespace {

namespace fs = std::filesystem;

// A soft limit on CPU time, so that the signal that ends a scene identifies the limit.
constexpr rlim_t kMaxCpuSeconds = 600;
// Failed scenes may trace no path, so the number of paths alone may never end a soak.
constexpr std::uint64_t kMaxFailures = 100;
constexpr std::uint64_t kScenesBetweenReports = 100;

void require(bool good, const char* what) {
  if (!good) throw Error(ErrorCode::resource, "soak", fmt::format("{}: {}", what, std::strerror(errno)));
}

soak::Outcome check_scene(std::uint64_t seed, const fs::path& folder) {
  try {
    return soak::check(soak::draw_scene(seed, folder));
  } catch (const std::exception& error) {
    return {0, 0, error.what()};
  }
}

// Sends the path count, the ray count and the failure text through a pipe.
void write_outcome(int pipe, const soak::Outcome& outcome) {
  const std::string text = fmt::format("{} {} {}", outcome.paths, outcome.rays, outcome.failure);
  if (::write(pipe, text.data(), text.size()) < 0) ::_exit(1);
}

std::string read_all(int pipe) {
  std::string text;
  std::array<char, 4096> piece;
  for (ssize_t n = 0; (n = ::read(pipe, piece.data(), piece.size())) > 0;)
    text.append(piece.data(), static_cast<std::size_t>(n));
  return text;
}

soak::Outcome outcome_of(const std::string& text, int status) {
  if (WIFSIGNALED(status))
    return {0, 0, fmt::format("ended by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))};
  soak::Outcome outcome;
  std::size_t first = 0;
  std::size_t second = 0;
  if (WEXITSTATUS(status) != 0 || text.empty()) return {0, 0, "ended without a result"};
  outcome.paths = std::stoull(text, &first);
  outcome.rays = std::stoull(text.substr(first), &second);
  outcome.failure = text.substr(first + second + 1);
  return outcome;
}

// Checks a scene in a child process, so that a crash counts as a failure.
soak::Outcome check_in_child_process(std::uint64_t seed, const fs::path& folder) {
  std::array<int, 2> ends;
  require(::pipe(ends.data()) == 0, "cannot create a pipe");
  const pid_t child = ::fork();
  require(child >= 0, "cannot create a process");
  if (child == 0) {
    const rlimit limit{kMaxCpuSeconds, RLIM_INFINITY};
    ::setrlimit(RLIMIT_CPU, &limit);
    write_outcome(ends[1], check_scene(seed, folder));
    ::_exit(0);
  }
  ::close(ends[1]);
  const std::string text = read_all(ends[0]);
  ::close(ends[0]);
  int status = 0;
  require(::waitpid(child, &status, 0) == child, "cannot wait for a process");
  return outcome_of(text, status);
}

}  // namespace

SoakResult run_soak(const SoakSettings& settings) {
  SoakResult result;
  for (std::uint64_t seed = settings.seed; result.paths < settings.paths && result.failures < kMaxFailures;
       ++seed) {
    const fs::path folder = settings.folder / fmt::format("soak_{}", seed);
    fs::create_directories(folder);
    const soak::Outcome outcome = check_in_child_process(seed, folder);
    ++result.scenes;
    result.paths += outcome.paths;
    result.rays += outcome.rays;
    if (outcome.failure.empty()) {
      fs::remove_all(folder);
    } else {
      ++result.failures;
      settings.say(fmt::format("{}/soak_{}.json: {}", folder.string(), seed, outcome.failure));
    }
    if (result.scenes % kScenesBetweenReports == 0)
      settings.say(
          fmt::format("{} scenes, {} paths, {} failures", result.scenes, result.paths, result.failures));
  }
  return result;
}

}  // namespace abbe
