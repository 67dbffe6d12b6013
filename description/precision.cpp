#include <cmath>

#include <fmt/format.h>

#include "description/checks.h"
#include "scene/extent.h"

namespace abbe::description {
namespace {

// A ray leaves a surface four float steps off it, so that a body of fewer steps than these is hardly one.
constexpr double kLeastSteps = 64;
// An opaque one of fewer steps than these is elsewhere than it is described by a part of itself.
constexpr double kLeastOpaqueSteps = 8;
// A pixel of fewer steps than these is one of the few directions that floats tell apart.
constexpr double kLeastPixelSteps = 8;
constexpr double kDirectionStep = 0x1p-24;  // of a component near 1, and so [rad] of a direction

void check_shapes(const LoadContext& context, const Scene& scene) {
  std::vector<bool> emitting_mesh(scene.shapes.size(), false);
  for (const Light& light : scene.lights)
    if (const auto* emitter = std::get_if<AreaLight>(&light.kind))
      emitting_mesh[emitter->shape] = plain<Mesh>(scene.shapes[emitter->shape].shape) != nullptr;
  const double far_from = extent_of(scene.camera, scene.shapes).far_from;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const ShapeInstance& instance = scene.shapes[i];
    const Imath::Box3d box = bounds(instance.shape);
    const bool body = encloses_medium(scene.materials[instance.material]);
    const bool opaque = !emitting_mesh[i] && !body;
    if (opaque && distance_to(box, position(scene.camera)) > far_from) continue;
    const double size = box.size().length();
    const double step = float_step(largest_coordinate(box));
    const double least = opaque ? kLeastOpaqueSteps : kLeastSteps;
    if (size >= least * step) continue;
    context.diagnostics.error(
        context.shape_places[i],
        fmt::format(
            "shape \"{}\" is {:.3g} m large and {:.3g} m from the middle of the scene, where floats are "
            "{:.3g} m apart: too few for {} (got {:.3g} of them, allowed [{}, inf))",
            instance.name, size, box.center().length(), step,
            emitting_mesh[i] ? "a mesh that emits"
            : body           ? "matter that light enters"
                             : "a shape that is near",
            size / step, least));
  }
}

}  // namespace

void check_precision(const SourcePosition& where, const LoadContext& context, const Scene& scene) {
  check_shapes(context, scene);
  const CameraTraits camera = traits(scene.camera);
  const std::optional<double> distance_of_film =
      camera.pinhole_distance ? camera.pinhole_distance : camera.image_distance;
  if (!distance_of_film) return;
  const double pixel = scene.camera.pixel_pitch / *distance_of_film;
  if (pixel < kLeastPixelSteps * kDirectionStep)
    context.diagnostics.error(
        where,
        fmt::format("a pixel sees {:.3g} of a radian, and floats tell directions {:.3g} apart (got {:.3g} "
                    "of them, allowed [{}, inf))",
                    pixel, kDirectionStep, pixel / kDirectionStep, kLeastPixelSteps));
  const Imath::Box3d near = extent_of(scene.camera, scene.shapes).near;
  if (near.isEmpty()) return;
  const double distance = distance_to(near, position(scene.camera));
  const double steps = near.size().length() / (distance * kDirectionStep);
  if (steps < kLeastSteps)
    context.diagnostics.error(
        where,
        fmt::format("the camera is {:.3g} m from what it sees, which is {:.3g} m large: floats tell too few "
                    "directions apart there (got {:.3g}, allowed [{}, inf))",
                    distance, near.size().length(), steps, kLeastSteps));
}

}  // namespace abbe::description
