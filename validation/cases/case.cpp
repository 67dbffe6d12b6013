#include "validation/cases/case.h"

#include <cmath>

#include "io/data_directory.h"
#include "transport/render/render.h"

namespace abbe {
namespace {

constexpr int kDoublings = 4;

Scene load_case(const Case& item) {
  Diagnostics diagnostics;
  std::optional<Scene> scene =
      load_scene(data_directory() / "scenes" / "validation" / item.scene, item.settings, diagnostics);
  if (!scene) throw Error(ErrorCode::internal, item.id, diagnostics.text());
  return std::move(*scene);
}

int channel_index(const Scene& scene, const std::string& name) {
  for (std::size_t i = 0; i < scene.channels.size(); ++i)
    if (scene.channels[i].name == name) return static_cast<int>(i);
  throw Error(ErrorCode::internal, "case", "no channel " + name);
}

// Mean over the film; pixels are independent, and each knows its variance.
Estimate film_mean(const Film& film, int channel) {
  const std::size_t pixels = static_cast<std::size_t>(film.width()) * static_cast<std::size_t>(film.height());
  double sum = 0;
  double variance = 0;
  for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
    sum += film.mean(pixel, channel);
    variance += film.variance(pixel, channel);
  }
  const auto n = static_cast<double>(pixels);
  return {sum / n, std::sqrt(variance) / n};
}

}  // namespace

CaseResult run_case(const Case& item, double margin) {
  Scene scene = load_case(item);
  const int channel = channel_index(scene, item.channel);
  const double ratio = item.margin / margin;
  scene.render.samples = static_cast<int>(std::lround(item.samples * ratio * ratio));
  CaseResult result{};
  for (int doubling = 0; doubling <= kDoublings; ++doubling, scene.render.samples *= 2) {
    const RenderResult rendered = render(scene, {});
    result.measured = film_mean(rendered.film, channel);
    result.samples = scene.render.samples;
    result.cpu_s += rendered.stats.cpu_s;
    result.verdict = equivalence(result.measured, item.expected, margin);
    if (result.verdict != Verdict::inconclusive) break;
  }
  return result;
}

}  // namespace abbe
