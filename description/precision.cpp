#include <cmath>

#include <fmt/format.h>

#include "description/checks.h"
#include "scene/working_range.h"

namespace abbe::description {
namespace {

// Rays start about four float steps off a surface, so a body of fewer steps than this is not resolved.
constexpr double kMinSteps = 64;
// An opaque shape of fewer steps than this is displaced by a noticeable fraction of its size.
constexpr double kMinOpaqueSteps = 8;
// A pixel of fewer steps than this contains only a few distinguishable directions.
constexpr double kMinPixelSteps = 8;
constexpr double kDirectionStep = 0x1p-24;  // Float step of a component near 1, and so of a direction [rad].

void check_shapes(const LoadContext& context, const Scene& scene) {
  std::vector<bool> emitting_mesh(scene.shapes.size(), false);
  for (const Light& light : scene.lights)
    if (const auto* emitter = std::get_if<AreaLight>(&light.kind))
      emitting_mesh[emitter->shape] = plain<Mesh>(scene.shapes[emitter->shape].shape) != nullptr;
  const double far_threshold = working_range_of(scene.camera, scene.shapes).far_threshold;
  for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
    const ShapeInstance& instance = scene.shapes[i];
    const Imath::Box3d box = bounds(instance.shape);
    const bool body = encloses_medium(scene.materials[instance.material]);
    const bool opaque = !emitting_mesh[i] && !body;
    if (opaque && distance_to(box, position(scene.camera)) > far_threshold) continue;
    const double size = box.size().length();
    const double step = float_step(largest_coordinate(box));
    const double min_steps = opaque ? kMinOpaqueSteps : kMinSteps;
    if (size >= min_steps * step) continue;
    context.diagnostics.error(
        context.shape_positions[i],
        fmt::format("shape \"{}\" is {:.3g} m large and {:.3g} m from the center of the scene, where single "
                    "precision resolves {:.3g} m: too coarse for {} (got {:.3g} steps, allowed [{}, inf))",
                    instance.name, size, box.center().length(), step,
                    emitting_mesh[i] ? "an emitting mesh"
                    : body           ? "a shape with a medium inside"
                                     : "a nearby shape",
                    size / step, min_steps));
  }
}

}  // namespace

void check_precision(const SourcePosition& where, const LoadContext& context, const Scene& scene) {
  check_shapes(context, scene);
  const CameraTraits camera = traits(scene.camera);
  const std::optional<double> film_distance =
      camera.pinhole_distance ? camera.pinhole_distance : camera.image_distance;
  if (!film_distance) return;
  const double pixel = scene.camera.pixel_pitch / *film_distance;
  if (pixel < kMinPixelSteps * kDirectionStep)
    context.diagnostics.error(where,
                              fmt::format("a pixel covers {:.3g} rad, where single precision resolves "
                                          "directions to {:.3g} rad (got {:.3g} steps, allowed [{}, inf))",
                                          pixel, kDirectionStep, pixel / kDirectionStep, kMinPixelSteps));
  const Imath::Box3d near = working_range_of(scene.camera, scene.shapes).near;
  if (near.isEmpty()) return;
  const double distance = distance_to(near, position(scene.camera));
  const double steps = near.size().length() / (distance * kDirectionStep);
  if (steps < kMinSteps)
    context.diagnostics.error(
        where, fmt::format("the camera is {:.3g} m from the visible scene, which is {:.3g} m large: single "
                           "precision resolves too few directions (got {:.3g}, allowed [{}, inf))",
                           distance, near.size().length(), steps, kMinSteps));
}

}  // namespace abbe::description
