#include "validation/bench/soak/check.h"

#include <cmath>

#include <fmt/format.h>

#include "description/load.h"
#include "io/error.h"
#include "transport/render/render.h"
#include "validation/bench/soak/drawing.h"
#include "validation/bench/soak/traps.h"

namespace abbe::soak {
namespace {

// The first value that may not be, in words.
std::string faulty_value(const Film& film, const std::vector<std::string>& planes, const DrawnScene& drawn) {
  const auto width = static_cast<std::size_t>(film.width());
  for (std::size_t pixel = 0; pixel < width * static_cast<std::size_t>(film.height()); ++pixel)
    for (int plane = 0; plane < film.channels(); ++plane) {
      const double value = film.mean(pixel, plane);
      const std::string& name = planes[static_cast<std::size_t>(plane)];
      const char* fault = !std::isfinite(value) || !std::isfinite(film.variance(pixel, plane))
                              ? "is not finite"
                          : value < 0 && !drawn.signed_response                   ? "is negative"
                          : value != 0 && drawn.closed && name == kOutsideChannel ? "came out of a closed box"
                                                                                  : nullptr;
      if (fault != nullptr)
        return fmt::format("{} of pixel ({}, {}) {}: {}", name, pixel % width, pixel / width, fault, value);
    }
  return "";
}

std::string difference_of_parts(const Scene& scene, const RenderResult& whole) {
  const auto samples = static_cast<std::uint64_t>(scene.render.samples);
  RenderOptions options;
  options.threads = 1;
  options.samples = SampleRange{0, samples / 3};
  std::optional<RenderResult> parts;
  if (samples / 3 > 0) parts = render(scene, options);
  options.samples = SampleRange{samples / 3, samples};
  const RenderResult rest = render(scene, options);
  const std::uint64_t rays = rest.stats.rays + (parts ? parts->stats.rays : 0);
  const Film* sum = &rest.film;
  if (parts) {
    parts->film.add(rest.film);
    sum = &parts->film;
  }
  if (sum->bytes() == whole.film.bytes() && rays == whole.stats.rays) return "";
  return fmt::format("other bits in parts of {} and {} samples, by one thread: {} rays instead of {}",
                     samples / 3, samples - samples / 3, rays, whole.stats.rays);
}

std::string failure_of(const Scene& scene, const RenderResult& whole, const DrawnScene& drawn) {
  if (whole.stats.nonfinite_samples > 0)
    return fmt::format("{} samples are not finite", whole.stats.nonfinite_samples);
  if (std::string fault = faulty_value(whole.film, scene.film_planes(), drawn); !fault.empty()) return fault;
  if (std::string traps = traps_seen(); !traps.empty()) return traps;
  return difference_of_parts(scene, whole);
}

// Photons refuse some lamps, with an error that says so: such scenes are for path tracing.
RenderResult rendered(Scene& scene) {
  RenderOptions options;
  options.threads = 2;
  try {
    return render(scene, options);
  } catch (const Error& error) {
    if (error.code != ErrorCode::scene) throw;
    scene.render.integrator = Integrator::path;
    return render(scene, options);
  }
}

}  // namespace

Outcome check(const DrawnScene& drawn) {
  Diagnostics diagnostics;
  std::optional<Scene> scene = load_scene(drawn.path, {}, diagnostics);
  if (!scene) return {0, 0, "refused: " + diagnostics.text()};
  watch_traps();
  const RenderResult whole = rendered(*scene);
  return {whole.stats.paths, whole.stats.rays, failure_of(*scene, whole, drawn)};
}

}  // namespace abbe::soak
