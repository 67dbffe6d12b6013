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
#include "validation/bench/soak/fp_exceptions.h"

namespace abbe::soak {
namespace {

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
