#include "validation/bench/soak/scene.h"

#include <fmt/format.h>

#include "io/atomic_file.h"
#include "validation/bench/soak/drawing.h"

namespace abbe::soak {
namespace {

// Draws the unit, the size and the center of the scene.
void draw_scale_and_position(Drawing& drawing) {
  Random& random = drawing.random;
  struct Unit {
    const char* name;
    double metres;
  };
  const Unit unit = one_of(random, {Unit{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}, {"in", 0.0254}});
  drawing.scene["units"] = unit.name;
  drawing.unit_m = unit.metres;
  drawing.size = decades(random, 1e-2, 1e5);
  if (chance(random, 0.5))
    for (double& x : drawing.center) x = drawing.size * signed_decades(random, 1e-3, 1e3);
}

}  // namespace

DrawnScene draw_scene(std::uint64_t seed, const std::filesystem::path& folder) {
  Drawing drawing;
  drawing.random.seed(seed);
  drawing.folder = folder;
  drawing.closed = chance(drawing.random, 0.3);
  drawing.signed_response = chance(drawing.random, 0.1);
  drawing.brightness = decades(drawing.random, 1e-15, 1e8);
  drawing.uses_probe = chance(drawing.random, 0.1);
  drawing.moves = chance(drawing.random, 0.3);
  drawing.open_s = drawing.moves ? uniform(drawing.random, -5, 5) : 0;
  drawing.exposure_s = decades(drawing.random, 1e-6, kMaxExposure_s);
  drawing.scene["abbe"] = 1;
  draw_scale_and_position(drawing);
  draw_materials(drawing);
  draw_shapes(drawing);
  draw_sensor(drawing);
  draw_camera(drawing);
  draw_lights(drawing);
  draw_render(drawing);
  const std::filesystem::path path = folder / fmt::format("soak_{}.json", seed);
  write_atomically(path, drawing.scene.dump(1) + "\n");
  return {path, drawing.closed, drawing.signed_response};
}

}  // namespace abbe::soak
