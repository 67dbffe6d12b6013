#include "scene/lights/light.h"

#include <numbers>
#include <type_traits>

#include "io/error.h"
#include "scene/shapes/ray.h"

namespace abbe {
namespace {

// The answer of the light's model to `question`; `otherwise` for models that lack the function it calls.
template <typename Result, typename Question>
Result answer(const Light& light, const Result& otherwise, const Question& question) {
  return std::visit(
      [&](const auto& model) -> Result {
        if constexpr (std::is_invocable_v<const Question&, decltype(model)>)
          return question(model);
        else
          return otherwise;
      },
      light.kind);
}

}  // namespace

void measure(Light& light, const Shapes& shapes) {
  std::visit(
      [&shapes](auto& model) {
        if constexpr (requires { model.measure(shapes); }) model.measure(shapes);
      },
      light.kind);
}

const Imath::V3f* light_position(const Light& light) {
  return answer(light, static_cast<const Imath::V3f*>(nullptr),
                []<PointLightModel Model>(const Model& model) { return &model.position; });
}

std::optional<Imath::V3f> position_at(const Light& light, float time) {
  return answer(light, std::optional<Imath::V3f>(), [time]<PointLightModel Model>(const Model& model) {
    return std::optional(moved_position(model.position, model.motion.get(), time));
  });
}

std::optional<DirectionCone> cone_at(const Light& light, float time) {
  return answer(light, std::optional<DirectionCone>(),
                [time](const auto& model) -> decltype(model.cone_at(time)) { return model.cone_at(time); });
}

const Motion* motion_of(const Light& light, const Shapes& shapes) {
  return std::visit(
      [&]<LightModel Model>(const Model& model) -> const Motion* {
        if constexpr (PointLightModel<Model>)
          return model.motion.get();
        else if constexpr (Model::kAtInfinity)
          return nullptr;
        else
          return model.motion_in(shapes);
      },
      light.kind);
}

Imath::Box3d bounds_of(const Light& light, const Shapes& shapes) {
  return std::visit(
      [&]<LightModel Model>(const Model& model) -> Imath::Box3d {
        if constexpr (PointLightModel<Model>)
          return box_of_point(model.position, model.motion.get());
        else if constexpr (Model::kAtInfinity)
          throw Error(ErrorCode::internal, "light \"" + light.name + "\"", "a light at infinity has no box");
        else
          return model.box(shapes);
      },
      light.kind);
}

LightBounds light_bounds(const Light& light, const Shapes& shapes, double emission) {
  return std::visit([&](const auto& model) { return model.bounds(shapes, emission); }, light.kind);
}

std::optional<DirectionCone> beam_of(const Light& light) {
  return answer(light, std::optional<DirectionCone>(),
                [](const auto& model) -> decltype(model.beam()) { return model.beam(); });
}

bool is_visible_along(const Light& light, const Imath::V3f& wi) {
  return answer(light, true, [&wi](const auto& model) -> decltype(model.is_visible_along(wi)) {
    return model.is_visible_along(wi);
  });
}

double solid_angle(const Light& light) {
  return answer(light, 0.0,
                [](const auto& model) -> decltype(model.solid_angle()) { return model.solid_angle(); });
}

SampledSpectrum emission_from(const Light& light, const Imath::V3f& wi,
                              const SampledSpectrum& wavelengths_nm) {
  return std::visit(
      [&](const auto& model) {
        if constexpr (requires { model.emission_from(light.emission, wi, wavelengths_nm); })
          return model.emission_from(light.emission, wi, wavelengths_nm);
        else
          return light.emission(wavelengths_nm);
      },
      light.kind);
}

float emission_factor(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo, float time) {
  return answer(light, 1.0F, [&](const auto& model) -> decltype(model.emission_factor(normal, wo, time)) {
    return model.emission_factor(normal, wo, time);
  });
}

bool emits_towards(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo) {
  return answer(light, true, [&](const auto& model) -> decltype(model.emits_towards(normal, wo)) {
    return model.emits_towards(normal, wo);
  });
}

std::optional<PolarisationState> polarisation_of(const Light& light, const Imath::V3f& travels) {
  if (!light.polarisation) return std::nullopt;
  const auto& [degree, kind] = *light.polarisation;
  if (const auto* circular = std::get_if<CircularPolarisation>(&kind))
    return PolarisationState{Basis<float>(travels).x, 0, 0, circular->right ? degree : -degree};
  constexpr float kAlong = 1e-6F;  // below this length, the perpendicular component of the axis is rounding
  const Imath::V3f& axis = std::get<LinearPolarisation>(kind).axis;
  const Imath::V3f across = axis - travels * axis.dot(travels);
  if (!(across.length() > kAlong)) return std::nullopt;
  return PolarisationState{across.normalized(), degree, 0, 0};
}

std::optional<LightSample> sample_light(const Light& light, const Shapes& shapes,
                                        const LightSampleContext& context, Imath::V2f u, float time) {
  const LightQuery query{shapes, context, u, time};
  return std::visit([&query](const auto& model) { return model.sample(query); }, light.kind);
}

float light_pdf(const Light& light, const Shapes& shapes, const LightSampleContext& context,
                const Imath::V3f& wi, const Imath::V3f& hit_point, const Imath::V3f& hit_normal, float time) {
  if (!emits_towards(light, hit_normal, -wi)) return 0;
  return std::visit(
      [&]<LightModel Model>(const Model& model) {
        if constexpr (Model::kIsDelta)
          return 0.0F;
        else
          return model.pdf(shapes, LightHit{context, wi, hit_point, hit_normal, time});
      },
      light.kind);
}

EmissionPoint sample_emission_point(const Light& light, const Shapes& shapes, Imath::V2f u, float time) {
  return std::visit(
      [&]<LightModel Model>(const Model& model) -> EmissionPoint {
        if constexpr (PointLightModel<Model>)
          return {moved_position(model.position, model.motion.get(), time), Imath::V3f(0), 1};
        else if constexpr (Model::kAtInfinity)
          throw Error(ErrorCode::internal, "light \"" + light.name + "\"",
                      "a light at infinity has no point to emit from");
        else
          return model.sample_emission_point(shapes, u, time);
      },
      light.kind);
}

EmissionDensity emission_density(const Light& light, const Imath::V3f& normal, const Imath::V3f& wo,
                                 float scene_radius_m, float time) {
  const EmissionQuery query{normal, wo, scene_radius_m, time};
  return std::visit([&query](const auto& model) { return model.emission_density(query); }, light.kind);
}

Imath::V3f emission_direction(const Light& light, const Imath::V3f& normal, Imath::V2f u, float time) {
  return std::visit(
      [&]<LightModel Model>(const Model& model) -> Imath::V3f {
        if constexpr (Model::kAtInfinity)
          throw Error(ErrorCode::internal, "light \"" + light.name + "\"",
                      "a light at infinity has no position");
        else
          return model.emission_direction(normal, u, time);
      },
      light.kind);
}

double etendue(const Light& light, double scene_radius_m) {
  const double across = std::numbers::pi * scene_radius_m * scene_radius_m;
  return std::visit([across](const auto& model) { return model.etendue(across); }, light.kind);
}

ScaledCurve mean_emission(const Light& light) {
  return answer(light, light.emission,
                [&](const auto& model) -> decltype(model.mean_emission(light.emission)) {
                  return model.mean_emission(light.emission);
                });
}

Curve power(const Light& light, double scene_radius_m) {
  return scaled(mean_emission(light).curve(), etendue(light, scene_radius_m));
}

std::size_t memory_bytes(const Light& light) {
  std::size_t bytes = sizeof(Light);
  if (light.name.capacity() > std::string().capacity()) bytes += light.name.capacity() + 1;
  return bytes + answer(light, std::size_t{0}, [](const auto& model) -> decltype(model.memory_bytes()) {
           return model.memory_bytes();
         });
}

std::optional<BasicRay<double>> central_ray(const Light& light, const Ball& sphere) {
  return answer(
      light, std::optional<BasicRay<double>>(),
      [&](const auto& model) -> decltype(model.central_ray(sphere)) { return model.central_ray(sphere); });
}

double fan_of(const Light& light) {
  return answer(light, std::numbers::pi / 3,
                [](const auto& model) -> decltype(model.fan()) { return model.fan(); });
}

}  // namespace abbe
