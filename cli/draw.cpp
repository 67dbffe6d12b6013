#include "cli/draw.h"

#include <array>
#include <utility>

#include "cli/answer.h"
#include "cli/output_files.h"
#include "cli/warnings.h"
#include "description/load.h"
#include "io/atomic_file.h"
#include "io/text.h"
#include "report/layout.h"
#include "report/light_rays.h"

namespace abbe::cli {
namespace {

// The requested ray, or those of the lights, in the coordinates of the scene [m].
std::vector<BasicRay<double>> rays_of(const Scene& scene, const DrawOptions& options) {
  if (options.origin)
    return {{*options.origin * scene.unit_m - scene.origin_m, options.direction.normalized()}};
  std::vector<BasicRay<double>> rays;
  if (options.rays == 0) return rays;
  for (const Light& light : scene.lights)
    for (const BasicRay<double>& ray : light_rays(scene, light, options.rays)) rays.push_back(ray);
  return rays;
}

}  // namespace

int draw(const DrawOptions& options) {
  require_extension(options.output, {".svg"});
  require_writable(options.output);
  if (options.origin && !(options.direction.length() > 0))
    throw Error(ErrorCode::usage, "--dir", "a direction must not be zero");
  Diagnostics diagnostics;
  Inputs inputs(options.max_memory_bytes);
  const Scene scene =
      accepted(load_scene(options.scene, options.overrides, diagnostics, &inputs), diagnostics);
  require_distinct(std::array{options.output}, inputs.files());
  const FollowLimits limits{.max_events = options.max_events, .min_power_fraction = kMinDrawnFraction};
  std::vector<DrawnRay> drawn;
  std::optional<std::string> warning;
  for (const double nm : options.wavelengths_nm)
    for (const BasicRay<double>& ray : rays_of(scene, options)) {
      const RayTree tree = follow_ray(scene, ray, nm, options.follow, limits);
      if (!warning) warning = extrapolated_index_warning(scene, tree, nm);
      for (DrawnRay& drawn_ray : drawn_rays(scene, tree, nm)) drawn.push_back(std::move(drawn_ray));
    }
  const std::string name = options.scene == kStandardStream ? "stdin" : options.scene.filename().string();
  write_atomically(options.output, layout_drawing(scene, drawn, name));
  if (warning) print_message("warning: " + *warning);
  return 0;
}

}  // namespace abbe::cli
