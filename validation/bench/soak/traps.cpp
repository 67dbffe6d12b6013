#include "validation/bench/soak/traps.h"

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
constexpr std::uint32_t kFlags = 0x3f;        // MXCSR: what has been raised,
constexpr std::uint32_t kMasksAbove = 7;      // and, so many bits above, what does not trap
constexpr std::uint16_t kX87Flags = 0x80ff;   // what the x87 unit, which long doubles are for, has raised
constexpr std::uint64_t kSingleStep = 0x100;  // of RFLAGS
// Steps cost microseconds, and Embree raises some hundred exceptions for a path that meets balls: a thread
// that has made so many is left alone, and so are all where those of every sample are started anew.
constexpr std::uint32_t kMostSteps = 1'000;
constexpr std::uint32_t kMostStepsOfAll = 100 * kMostSteps;

// An instruction that raised something. Handlers may not allocate.
struct Site {
  std::atomic<const std::uint8_t*> at{nullptr};
  std::atomic<std::uint32_t> count{0};
  std::atomic<int> code{0};
};
std::array<Site, 512> sites;
thread_local std::uint32_t steps = 0;
std::atomic<std::uint32_t> steps_of_all = 0;

// Whether an instruction works on one number. Of those that VEX encodes, their prefix says so; comparisons
// that set the flags of the processor do without.
bool is_scalar(const std::uint8_t* at) {
  if (*at != 0xc4 && *at != 0xc5) return true;  // of the C library, which has no vectors
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

// Whether what is watched traps in a thread, of vectors and of the x87 unit; forgets what has been raised.
void set_traps(_libc_fpstate& unit, bool on) {
  constexpr auto kMasks = static_cast<std::uint32_t>(kWatched) << kMasksAbove;
  constexpr auto kX87Masks = static_cast<std::uint16_t>(kWatched);
  unit.mxcsr = (on ? unit.mxcsr & ~kMasks : unit.mxcsr | kMasks) & ~kFlags;
  unit.cwd = static_cast<std::uint16_t>(on ? unit.cwd & ~kX87Masks : unit.cwd | kX87Masks);
  unit.swd = static_cast<std::uint16_t>(unit.swd & ~kX87Flags);
}

// Lets the instruction do as it would have, and comes back after it.
void step_over(int, siginfo_t* info, void* context) {
  auto& machine = static_cast<ucontext_t*>(context)->uc_mcontext;
  record(static_cast<const std::uint8_t*>(info->si_addr), info->si_code);
  set_traps(*machine.fpregs, false);
  if (++steps < kMostSteps && ++steps_of_all < kMostStepsOfAll)
    machine.gregs[REG_EFL] |= static_cast<greg_t>(kSingleStep);
}

void watch_again(int, siginfo_t*, void* context) {
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

void watch_traps() {
  handle(SIGFPE, step_over);
  handle(SIGTRAP, watch_again);
  std::feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(kWatched);
}

std::string traps_seen() {
  std::string all;
  for (const Site& site : sites)
    if (const std::uint8_t* at = site.at; at != nullptr && is_scalar(at) && !in_embree(at))
      all += describe(site);
  return all;
}

}  // namespace abbe::soak
