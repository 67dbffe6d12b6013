#include "film/shortcomings.h"

#include <fmt/format.h>

#include "scene/contact.h"
#include "scene/dark_enclosure.h"
#include "transport/path/roulette.h"
#include "transport/plan/techniques.h"

namespace abbe {

std::optional<std::string> lost_light(const Scene& scene) {
  const std::vector<PathClass> lost = unreached(scene);
  if (lost.empty()) return std::nullopt;
  const std::string by =
      scene.render.integrator != Integrator::automatic
          ? fmt::format("integrator \"{}\" does not reach", integrator_name(scene.render.integrator))
          : "no technique reaches";
  return fmt::format("light that {} is missing: {}", by, fmt::join(lost, "; "));
}

std::optional<std::string> dark_camera(const Scene& scene) {
  const auto shape = dark_enclosure(scene);
  if (!shape) return std::nullopt;
  return fmt::format("the camera stands within \"{}\", which is opaque and has no light inside",
                     scene.shapes[*shape].name);
}

std::optional<std::string> hidden_sheet(const Scene& scene) {
  const auto sheet = lost_sheet(scene);
  if (!sheet) return std::nullopt;
  return fmt::format("the thin sheet \"{}\" lies on \"{}\", which is met instead: keep them apart",
                     scene.shapes[sheet->shape].name, scene.shapes[sheet->on].name);
}

std::vector<std::string> left_out(const Scene& scene, const RenderStats& stats) {
  std::vector<std::string> told;
  if (stats.nonfinite_samples > 0)
    told.push_back(fmt::format("{} samples were not finite and were left out", stats.nonfinite_samples));
  if (stats.cut.paths > 0 && !scene.render.max_depth)
    told.push_back(
        fmt::format("{} of {} paths were cut after {} events, with {:.3g} % of what all set out with: their "
                    "light is missing",
                    stats.cut.paths, stats.paths, kMostEvents,
                    100 * stats.cut.throughput() / static_cast<double>(stats.paths)));
  return told;
}

}  // namespace abbe
