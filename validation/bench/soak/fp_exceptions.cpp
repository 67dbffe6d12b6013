#include "validation/bench/soak/fp_exceptions.h"

#include <dlfcn.h>
#include <ucontext.h>

#include <array>
#include <atomic>
#include <cfenv>
#include <csignal>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

namespace abbe::soak {
namespace {

constexpr int kWatched = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW;
constexpr std::uint32_t kFlags = 0x3f;  // MXCSR: flags of raised exceptions
// MXCSR: shift from the flags to the masks of exceptions that do not trap.
constexpr std::uint32_t kMasksAbove = 7;
constexpr std::uint16_t kX87Flags = 0x80ff;   // flags of the x87 unit, which computes long doubles
constexpr std::uint64_t kSingleStep = 0x100;  // trap flag of RFLAGS
// A step takes microseconds, and Embree raises some hundred exceptions per path that hits spheres. A thread
// stops trapping after this number. The total limit applies if threads are restarted for every sample.
constexpr std::uint32_t kMaxSteps = 1'000;
constexpr std::uint32_t kMaxTotalSteps = 100 * kMaxSteps;

// Counter of an instruction that raised exceptions. Signal handlers may not allocate.
struct Site {
  std::atomic<const std::uint8_t*> at{nullptr};
  std::atomic<std::uint32_t> count{0};
  std::atomic<int> code{0};
};
std::array<Site, 512> sites;
thread_local std::uint32_t steps = 0;
std::atomic<std::uint32_t> total_steps = 0;

// True if an instruction operates on a single number. The VEX prefix shows this, except for comparisons that
// set the processor's flags.
bool is_scalar(const std::uint8_t* at) {
  if (*at != 0xc4 && *at != 0xc5) return true;  // C library code without vectors
  const std::uint8_t* kind = *at == 0xc5 ? at + 1 : at + 2;
  const bool compares = (kind[1] & 0xfeU) == 0x2e;
  return (*kind & 2U) != 0 || compares;
}

bool in_embree(const std::uint8_t* at) {
  Dl_info info;
  return dladdr(at, &info) != 0 && std::strstr(info.dli_fname, "embree") != nullptr;
}

void record(const std::uint8_t* at, int code) {
  for (Site& site : sites) {
    const std::uint8_t* none = nullptr;
    if (site.at.compare_exchange_strong(none, at) || none == at) {
      ++site.count;
      site.code = code;
      return;
    }
  }
}

// Enables or disables trapping in the vector and x87 units of a thread, and clears the exception flags.
void set_traps(_libc_fpstate& unit, bool on) {
  constexpr auto kMasks = static_cast<std::uint32_t>(kWatched) << kMasksAbove;
  constexpr auto kX87Masks = static_cast<std::uint16_t>(kWatched);
  unit.mxcsr = (on ? unit.mxcsr & ~kMasks : unit.mxcsr | kMasks) & ~kFlags;
  unit.cwd = static_cast<std::uint16_t>(on ? unit.cwd & ~kX87Masks : unit.cwd | kX87Masks);
  unit.swd = static_cast<std::uint16_t>(unit.swd & ~kX87Flags);
}

// Disables trapping, so that the instruction completes, and requests a single-step trap after it.
void step_over(int, siginfo_t* info, void* context) {
  auto& machine = static_cast<ucontext_t*>(context)->uc_mcontext;
  record(static_cast<const std::uint8_t*>(info->si_addr), info->si_code);
  set_traps(*machine.fpregs, false);
  if (++steps < kMaxSteps && ++total_steps < kMaxTotalSteps)
    machine.gregs[REG_EFL] |= static_cast<greg_t>(kSingleStep);
}

void rearm(int, siginfo_t*, void* context) {
  auto& machine = static_cast<ucontext_t*>(context)->uc_mcontext;
  set_traps(*machine.fpregs, true);
  machine.gregs[REG_EFL] &= ~static_cast<greg_t>(kSingleStep);
}

void handle(int signal, void (*handler)(int, siginfo_t*, void*)) {
  struct sigaction action = {};
  action.sa_flags = SA_SIGINFO;
  action.sa_sigaction = handler;
  sigaction(signal, &action, nullptr);
}

std::string describe(const Site& site) {
  const std::uint8_t* at = site.at;
  Dl_info info = {};
  dladdr(at, &info);
  const char* what = site.code == FPE_FLTDIV   ? "division by zero"
                     : site.code == FPE_FLTOVF ? "overflow"
                                               : "invalid operation";
  return fmt::format("{} at {}+{:#x}{}{}, {} times\n", what, info.dli_fname == nullptr ? "?" : info.dli_fname,
                     at - static_cast<const std::uint8_t*>(info.dli_fbase),
                     info.dli_sname == nullptr ? "" : " in ", info.dli_sname == nullptr ? "" : info.dli_sname,
                     site.count.load());
}

}  // namespace

void watch_fp_exceptions() {
  handle(SIGFPE, step_over);
  handle(SIGTRAP, rearm);
  std::feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(kWatched);
}

std::string raised_fp_exceptions() {
  std::string all;
  for (const Site& site : sites)
    if (const std::uint8_t* at = site.at; at != nullptr && is_scalar(at) && !in_embree(at))
      all += describe(site);
  return all;
}

}  // namespace abbe::soak
