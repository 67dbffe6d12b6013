#include "validation/bench/soak/check.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cfenv>
#include <cmath>
#include <csignal>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <ucontext.h>

#include "description/load.h"
#include "io/error.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/render.h"

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

// Starts counting the floating-point exceptions (invalid, division by zero, overflow) of this thread and of
// the threads that it starts, for the life of the process. The exceptions are unmasked, and the processor
// steps over each. A thread is watched up to its 1,000th exception and all threads together up to about
// 100,000, so the counts are lower bounds.
// Two kinds are not reported. Embree's tests of boxes and spheres rely on exceptions. Instructions on half
// of a vector register have undefined values in the unused lanes; the compiler generates them for single
// additions and products.
void watch_fp_exceptions() {
  handle(SIGFPE, step_over);
  handle(SIGTRAP, rearm);
  std::feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(kWatched);
}

// Report of the exceptions since `watch_fp_exceptions`, with one line per instruction: kind, offset in its
// file, symbol if known, and count. At most 512 instructions are recorded. Empty if there was none.
std::string raised_fp_exceptions() {
  std::string all;
  for (const Site& site : sites)
    if (const std::uint8_t* at = site.at; at != nullptr && is_scalar(at) && !in_embree(at))
      all += describe(site);
  return all;
}

// A scene rendered by two threads, and the guiding data that its pilot rays trained.
struct ReferenceRender {
  RenderResult result;
  std::shared_ptr<const GuidingData> guides;
};

// True for a component of the Stokes vector other than the intensity.
bool may_be_negative(const std::string& plane) {
  return plane.starts_with("S1.") || plane.starts_with("S2.") || plane.starts_with("S3.");
}

// Description of the first invalid value; empty if there is none.
std::string invalid_value(const Film& film, const std::vector<std::string>& planes, const DrawnScene& drawn) {
  const auto width = static_cast<std::size_t>(film.width());
  for (std::size_t pixel = 0; pixel < width * static_cast<std::size_t>(film.height()); ++pixel)
    for (int plane = 0; plane < film.channels(); ++plane) {
      const double value = film.mean(pixel, plane);
      const std::string& name = planes[static_cast<std::size_t>(plane)];
      const char* fault = !std::isfinite(value) || !std::isfinite(film.variance(pixel, plane))
                              ? "is not finite"
                          : value < 0 && !drawn.signed_response && !may_be_negative(name) ? "is negative"
                          : value != 0 && drawn.closed && name.ends_with(kOutsideChannel)
                              ? "shows light from outside a closed box"
                              : nullptr;
      if (fault != nullptr)
        return fmt::format("{} of pixel ({}, {}) {}: {}", name, pixel % width, pixel / width, fault, value);
    }
  return "";
}

constexpr int kBounces = 2;  // longer paths go to one further layer

// Bound on the value that single contributions may lose by underflow of float energies [J/nm]. A channel
// multiplies energies by its weight, here for wavelengths sampled uniformly over the whole range.
double faintest_value(const Scene& scene) {
  constexpr double kContributions = 64.0;
  double weight = 0;
  for (const Channel& channel : scene.channels)
    weight = std::max(weight, static_cast<double>(envelope(channel).max()));
  return kContributions * std::numeric_limits<float>::min() *
         (1 + weight * (kMaxWavelengthNm - kMinWavelengthNm));
}

// The layers must sum to the film within three tolerances: float rounding of single paths, underflow of the
// faintest ones, and the fixed-point units to which each path is rounded in the film and in every layer.
std::string layer_sum_failure(const Film& film, const Film& layers, double faintest) {
  constexpr double kRounding = 1e-5;
  const int films = 1 + layers.channels() / film.channels();
  const double rounded = std::ldexp(0.5, film.shape().unit_exponent) * films;
  const auto pixels = static_cast<std::size_t>(film.width()) * static_cast<std::size_t>(film.height());
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    std::vector<double> sums(static_cast<std::size_t>(film.channels()), 0.0);
    double all = 0;
    for (int plane = 0; plane < layers.channels(); ++plane) {
      const double value = layers.mean(pixel, plane);
      sums[static_cast<std::size_t>(plane % film.channels())] += value;
      all += std::abs(value);
    }
    for (int plane = 0; plane < film.channels(); ++plane) {
      const double sum = sums[static_cast<std::size_t>(plane)];
      const double film_value = film.mean(pixel, plane);
      if (!(std::abs(sum - film_value) <= kRounding * all + faintest + rounded))
        return fmt::format("plane {} of pixel {} is {}, but its layers sum to {}, in units of 2^{}", plane,
                           pixel, film_value, sum, film.shape().unit_exponent);
    }
  }
  return "";
}

// The first range trains its own guiding data on one thread; the second uses those of the reference.
std::string partition_failure(const Scene& scene, const ReferenceRender& reference) {
  const auto samples = static_cast<std::uint64_t>(scene.render.samples);
  RenderOptions options;
  options.threads = 1;
  options.layers = bounce_layers(kBounces);
  options.samples = SampleRange{0, samples / 3};
  std::optional<RenderResult> first;
  if (samples / 3 > 0) first = render(scene, options);
  options.guides = reference.guides;
  options.samples = SampleRange{samples / 3, samples};
  RenderResult sum = render(scene, options);
  const std::uint64_t rays = sum.stats.rays + (first ? first->stats.rays : 0);
  if (first) {
    sum.film.add(first->film);
    sum.layers->add(*first->layers);
  }
  const RenderResult& together = reference.result;
  if (sum.film.bytes() == together.film.bytes() && rays == together.stats.rays)
    return layer_sum_failure(sum.film, *sum.layers, faintest_value(scene));
  return fmt::format(
      "different bits if rendered in ranges of {} and {} samples by one thread: {} rays instead of {}",
      samples / 3, samples - samples / 3, rays, together.stats.rays);
}

// A crop to the first quarter of the film must give the same values.
std::string crop_failure(const Scene& scene, const ReferenceRender& reference) {
  RenderOptions options;
  options.threads = 1;
  options.guides = reference.guides;
  const int width = (scene.camera.width + 1) / 2;
  const int height = (scene.camera.height + 1) / 2;
  options.crop = Crop{0, 0, width, height};
  const Film film = render(scene, options).film;
  const Film& all = reference.result.film;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.camera.width) +
                         static_cast<std::size_t>(x);
      for (int plane = 0; plane < film.channels(); ++plane)
        if (film.mean(pixel, plane) != all.mean(pixel, plane))
          return fmt::format("plane {} of pixel ({}, {}) is {}, but {} in a crop", plane, x, y,
                             all.mean(pixel, plane), film.mean(pixel, plane));
    }
  return "";
}

std::string failure_of(const Scene& scene, const ReferenceRender& reference, const DrawnScene& drawn) {
  const RenderResult& result = reference.result;
  if (result.stats.nonfinite_samples > 0)
    return fmt::format("{} samples were discarded: not finite, or too large for the film",
                       result.stats.nonfinite_samples);
  if (std::string fault = invalid_value(result.film, scene.film_planes(), drawn); !fault.empty())
    return fault;
  if (std::string fault = partition_failure(scene, reference); !fault.empty()) return fault;
  if (std::string fault = crop_failure(scene, reference); !fault.empty()) return fault;
  return raised_fp_exceptions();
}

// Photon integrators reject some lights with an error. Such scenes are rendered by path tracing.
ReferenceRender render_reference(Scene& scene) {
  RenderOptions options;
  options.threads = 2;
  try {
    const IntegratorChoice choice = choose_integrator(scene, options.threads);
    scene.render.integrator = choice.integrator;
    options.guides = choice.guides;
    return {render(scene, options), choice.guides};
  } catch (const Error& error) {
    if (error.code != ErrorCode::scene) throw;
    scene.render.integrator = Integrator::path;
    options.guides = {};
    return {render(scene, options), {}};
  }
}

}  // namespace

Outcome check(const DrawnScene& drawn) {
  Diagnostics diagnostics;
  std::optional<Scene> scene = load_scene(drawn.path, {}, diagnostics);
  if (!scene) return {0, 0, "the scene does not load: " + diagnostics.text()};
  watch_fp_exceptions();
  const ReferenceRender reference = render_reference(*scene);
  return {reference.result.stats.paths, reference.result.stats.rays, failure_of(*scene, reference, drawn)};
}

}  // namespace abbe::soak
