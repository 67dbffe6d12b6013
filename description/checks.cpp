#include "description/checks.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

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
    if (const auto surface = surface_of(light))
      emitting_mesh[*surface] = plain<Mesh>(scene.shapes[*surface].shape) != nullptr;
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

void extend(Support& support, const Curve& curve) {
  const auto knots = curve.knots();
  if (curve.is_constant() && curve.max() != 0) support = {kMinWavelengthNm, kMaxWavelengthNm};
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    if (knots[i].value == 0 && knots[i + 1].value == 0) continue;
    const double from = knots[i].wavelength_nm;
    const double to = knots[i + 1].wavelength_nm;
    support.low = std::min(support.low, from);
    // A table that is 0 outside drops to 0 at the number after its last row, where its support ends
    // (`table_curve`).
    support.high = std::max(support.high, to > std::nextafter(from, to) ? to : from);
  }
}

void check_validity(const IndexUse& use, const Support& sensor, const SourcePosition& where,
                    Diagnostics& diagnostics) {
  const RefractiveIndex& index = *use.index;
  const DataRange n{index.low_nm(), index.high_nm()};
  const auto& k = index.k_range();
  const bool k_ends_first =
      k && (std::max(sensor.low, n.low_nm) < k->low_nm || k->high_nm < std::min(sensor.high, n.high_nm));
  if (n.low_nm <= sensor.low && sensor.high <= n.high_nm && !k_ends_first) return;
  diagnostics.warning(
      where, fmt::format("{} has data on [{:g}, {:g}] nm{}, but the sensor responds on [{:g}, {:g}] nm: "
                         "outside its data, the index of the nearer end is used",
                         *use.name, n.low_nm, n.high_nm,
                         k_ends_first ? fmt::format(", its k on [{:g}, {:g}] nm", k->low_nm, k->high_nm) : "",
                         sensor.low, sensor.high));
}

void check_validity(const spec::Materials& materials, const LoadContext& context, const Scene& scene) {
  Support sensor;
  for (const Channel& channel : scene.channels) extend(sensor, envelope(channel));
  for (const Material& material : scene.materials) {
    const auto spec = std::ranges::find(materials, material.name, &spec::Materials::value_type::name);
    const SourcePosition where = spec != materials.end() ? spec->where : SourcePosition{};
    for (const IndexUse& use : indices(material)) check_validity(use, sensor, where, context.diagnostics);
    std::optional<std::string> fault;
    for (double nm = sensor.low; nm <= sensor.high && !fault; ++nm) fault = transparency_fault(material, nm);
    if (fault) context.diagnostics.error(where, *fault);
  }
}

void check_lights(const LoadContext& context, const Scene& scene) {
  std::map<const Curve*, bool> visible;  // For each spectrum, which several lights may have.
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const Curve& spectrum = light.emission.base();
    const bool dark = light.emission.max() <= 0;
    if (!visible.contains(&spectrum))
      visible[&spectrum] =
          std::any_of(scene.channels.begin(), scene.channels.end(), [&](const Channel& channel) {
            const Curve exposed = product(spectrum, envelope(channel));
            return exposed.max() > 0 || exposed.min() < 0;
          });
    if (!dark && visible[&spectrum]) continue;
    context.diagnostics.error_if_strict(
        context.emission_positions.at(i),
        fmt::format("\"{}\" emits nothing{}", light.name, dark ? "" : " that the sensor records"));
  }
}

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
