#include "validation/bench/soak/check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "description/load.h"
#include "io/error.h"
#include "transport/render/choose_integrator.h"
#include "transport/render/render.h"
#include "validation/bench/soak/drawing.h"
#include "validation/bench/soak/traps.h"

namespace abbe::soak {
namespace {

// A scene rendered by two threads, and what its pilots have taught.
struct Whole {
  RenderResult result;
  std::shared_ptr<const Guides> guides;
};

// A component of the Stokes vector but the intensity, which may be negative.
bool has_sign(const std::string& plane) {
  return plane.starts_with("S1.") || plane.starts_with("S2.") || plane.starts_with("S3.");
}

// The first value that may not be, in words.
std::string faulty_value(const Film& film, const std::vector<std::string>& planes, const DrawnScene& drawn) {
  const auto width = static_cast<std::size_t>(film.width());
  for (std::size_t pixel = 0; pixel < width * static_cast<std::size_t>(film.height()); ++pixel)
    for (int plane = 0; plane < film.channels(); ++plane) {
      const double value = film.mean(pixel, plane);
      const std::string& name = planes[static_cast<std::size_t>(plane)];
      const char* fault =
          !std::isfinite(value) || !std::isfinite(film.variance(pixel, plane)) ? "is not finite"
          : value < 0 && !drawn.signed_response && !has_sign(name)             ? "is negative"
          : value != 0 && drawn.closed && name.ends_with(kOutsideChannel)      ? "came out of a closed box"
                                                                               : nullptr;
      if (fault != nullptr)
        return fmt::format("{} of pixel ({}, {}) {}: {}", name, pixel % width, pixel / width, fault, value);
    }
  return "";
}

constexpr int kBounces = 2;  // and all beyond in one layer

// What single contributions may lose of a film value: floats hold no energy [J/nm] below the least of them,
// and a channel makes values of energies by its weight, here as of lanes drawn evenly over all wavelengths.
double faintest_value(const Scene& scene) {
  constexpr double kContributions = 64.0;
  double weight = 0;
  for (const Channel& channel : scene.channels)
    weight = std::max(weight, static_cast<double>(envelope(channel).max()));
  return kContributions * std::numeric_limits<float>::min() *
         (1 + weight * (kMaxWavelengthNm - kMinWavelengthNm));
}

// The layers add up to the film, but for what floats round of the light of single paths, of the faintest all,
// and for the units of the film to which each path rounds in it and in every layer.
std::string fault_of_layers(const Film& film, const Film& layers, double faintest) {
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
      const double whole = film.mean(pixel, plane);
      if (!(std::abs(sum - whole) <= kRounding * all + faintest + rounded))
        return fmt::format("plane {} of pixel {} is {}, its layers {}, in units of 2^{}", plane, pixel, whole,
                           sum, film.shape().unit_exponent);
    }
  }
  return "";
}

// The first part learns by itself, on one thread, what the others are told.
std::string difference_of_parts(const Scene& scene, const Whole& whole) {
  const auto samples = static_cast<std::uint64_t>(scene.render.samples);
  RenderOptions options;
  options.threads = 1;
  options.layers = bounce_layers(kBounces);
  options.samples = SampleRange{0, samples / 3};
  std::optional<RenderResult> first;
  if (samples / 3 > 0) first = render(scene, options);
  options.guides = whole.guides;
  options.samples = SampleRange{samples / 3, samples};
  RenderResult sum = render(scene, options);
  const std::uint64_t rays = sum.stats.rays + (first ? first->stats.rays : 0);
  if (first) {
    sum.film.add(first->film);
    sum.layers->add(*first->layers);
  }
  const RenderResult& together = whole.result;
  if (sum.film.bytes() == together.film.bytes() && rays == together.stats.rays)
    return fault_of_layers(sum.film, *sum.layers, faintest_value(scene));
  return fmt::format("other bits in parts of {} and {} samples, by one thread: {} rays instead of {}",
                     samples / 3, samples - samples / 3, rays, together.stats.rays);
}

// Of the values that a crop to the first quarter has.
std::string difference_of_crop(const Scene& scene, const Whole& whole) {
  RenderOptions options;
  options.threads = 1;
  options.guides = whole.guides;
  const int width = (scene.camera.width + 1) / 2;
  const int height = (scene.camera.height + 1) / 2;
  options.crop = Crop{0, 0, width, height};
  const Film film = render(scene, options).film;
  const Film& all = whole.result.film;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.camera.width) +
                         static_cast<std::size_t>(x);
      for (int plane = 0; plane < film.channels(); ++plane)
        if (film.mean(pixel, plane) != all.mean(pixel, plane))
          return fmt::format("plane {} of pixel ({}, {}) is {}, in a crop {}", plane, x, y,
                             all.mean(pixel, plane), film.mean(pixel, plane));
    }
  return "";
}

std::string failure_of(const Scene& scene, const Whole& whole, const DrawnScene& drawn) {
  const RenderResult& result = whole.result;
  if (result.stats.nonfinite_samples > 0)
    return fmt::format("{} samples were left out", result.stats.nonfinite_samples);
  if (std::string fault = faulty_value(result.film, scene.film_planes(), drawn); !fault.empty()) return fault;
  if (std::string fault = difference_of_parts(scene, whole); !fault.empty()) return fault;
  if (std::string fault = difference_of_crop(scene, whole); !fault.empty()) return fault;
  return traps_seen();
}

// Photons refuse some lamps, with an error that says so: such scenes are for path tracing.
Whole rendered(Scene& scene) {
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
  if (!scene) return {0, 0, "refused: " + diagnostics.text()};
  watch_traps();
  const Whole whole = rendered(*scene);
  return {whole.result.stats.paths, whole.result.stats.rays, failure_of(*scene, whole, drawn)};
}

}  // namespace abbe::soak
