#include "description/light.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "description/material.h"
#include "description/shape.h"
#include "scene/shapes/basic.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr Range kDiameter = Range{0.01, 60}.in("degrees");  // Smaller discs are practically directional.
constexpr Range kHalfAngle =
    Range{0.1, 180}.in("degrees");  // Below, the cosines of cones are equal in single precision.

constexpr char kTowards[] = "Direction from the scene to where the light comes from, of any length.";

template <typename T>
Field strength(DaylightStrength T::*member) {
  return at_most_one(
      member, "a light has one strength",
      under<DaylightIrradiance>("irradiance", kPower.in("W/m2"),
                                "Irradiance of a surface that faces the light, over 300-1100 nm, with the "
                                "spectrum D65; replaces an emission."),
      under<DaylightIlluminance>(
          "illuminance", kPower.in("lx"),
          "Illuminance of a surface that faces the light, with the spectrum D65; replaces an emission."));
}

// Keys that may give the strength of a light, one of which is required. Most lights require an emission
// anyway.
std::vector<std::string_view> strengths(const auto&) {
  return {};
}
std::vector<std::string_view> strengths(const DirectionalLight&) {
  return {"emission", "directional/irradiance", "directional/illuminance"};
}
std::vector<std::string_view> strengths(const Sun&) {
  return {"emission", "sun/irradiance", "sun/illuminance"};
}

}  // namespace

// The key of the source is the name of its table.
template <typename Source, typename Emission>
Fields fields(Tag<LightSource<Source, Emission>>) {
  using L = LightSource<Source, Emission>;
  return describe("", "", {field(fields_of<Source>().name, &L::source), field("emission", &L::emission)},
                  strengths(Source{}), true);
}
template <typename Surface>
Fields fields(Tag<AreaLight<Surface>>) {
  using L = AreaLight<Surface>;
  return describe("", "",
                  {field(fields_of<Surface>().name, &L::surface), field("emission", &L::emission),
                   defaulted("two_sided", &L::two_sided, "True to emit from both sides."),
                   field("material", &L::material, "Material of its surface; black if absent.")});
}

static Fields fields(Tag<Point>) {
  return describe("point", "A point with the same intensity in all directions.",
                  {field("at", &Point::at, kCoordinate, "Its position.")});
}

static Fields fields(Tag<Spot>) {
  return describe("spot", "A point with constant intensity within a cone, and zero outside.",
                  {field("at", &Spot::at, kCoordinate, "Its position."),
                   field("direction", &Spot::direction, direction(), "Axis of the cone."),
                   field("half_angle_deg", &Spot::half_angle_deg, kHalfAngle, "Half-angle of the cone.")});
}

static Fields fields(Tag<Photometric>) {
  return describe(
      "photometric",
      "A point with the intensity distribution of a luminaire. Without a scale, its emission has the "
      "luminous flux of the file. An intensity that scales it is that along the axis.",
      {field("at", &Photometric::at, kCoordinate, "Its position."),
       field("file", &Photometric::file,
             "An IES LM-63 file (.ies) with type C photometry, or an EULUMDAT file (.ldt)."),
       defaulted("axis", &Photometric::axis, direction(),
                 "Direction of the vertical angle 0: that in which a ceiling luminaire shines."),
       defaulted("c0", &Photometric::c0, direction(),
                 "Direction of the horizontal angle 0, made perpendicular to the axis. These angles increase "
                 "counter-clockwise as viewed against the axis, from above a ceiling luminaire.")});
}

static Fields fields(Tag<DirectionalLight>) {
  return describe("directional", "Parallel light from infinity.",
                  {field("towards", &DirectionalLight::towards, direction(), kTowards),
                   strength(&DirectionalLight::strength)});
}

static Fields fields(Tag<Sun>) {
  return describe(
      "sun", "A disc at infinity with uniform radiance, visible to cameras, in mirrors and through glass.",
      {field("towards", &Sun::towards, direction(), kTowards),
       defaulted("angular_diameter_deg", &Sun::angular_diameter_deg, kDiameter,
                 "Angular diameter of the disc."),
       strength(&Sun::strength)});
}

static Fields fields(Tag<EnvironmentImage>) {
  return describe(
      "", "",
      {field("image", &EnvironmentImage::file,
             "An equirectangular EXR or HDR file with linear Rec.709 channels R, G, B, or Y."),
       defaulted("up", &EnvironmentImage::up, direction(), "Direction of the top row of the image."),
       defaulted("rotate_deg", &EnvironmentImage::rotate_deg, kAngle, "Right-handed rotation about `up`.")});
}
static Fields fields(Tag<EnvironmentLight>) {
  return describe("environment",
                  "Uniform radiance from all directions, or that of an image; at most one per scene.",
                  {at_most_one(&EnvironmentLight::image, "", inlined_by<EnvironmentImage>("image"))});
}

template <typename... Surfaces>
static Field kinds_of_light(Tag<std::variant<Surfaces...>>) {
  return one_of(&Light::kind, inlined_by<AreaLight<Surfaces>>(fields_of<Surfaces>().name)...,
                inlined_by<PointLightSource>("point"), inlined_by<SpotLightSource>("spot"),
                inlined_by<PhotometricLightSource>("photometric"),
                inlined_by<DirectionalLightSource>("directional"), inlined_by<SunLightSource>("sun"),
                inlined_by<EnvironmentLightSource>("environment"));
}

Fields fields(Tag<Light>) {
  return describe("light", "A light.",
                  {field("name", &Light::name, "Name for messages and for references to it as a white."),
                   kinds_of_light(Tag<PlainSurface>()),
                   field("motion", &Light::motion,
                         "Motion relative to the described pose; a light at infinity cannot move.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

double inverse_square(double distance) {
  return 1 / (distance * distance);
}

LightKind area_light_kind(const Shape& shape, bool two_sided) {
  LightKind kind{schema::fields_of<spec::MeshEmission>, CurveUnit::spectral_radiance,
                 std::numbers::pi * area(shape) * (two_sided ? 2 : 1)};
  visit_plain(
      [&kind](const auto& s) {
        if constexpr (requires { axial_irradiance(s, 1.0); }) {
          kind.fields = schema::fields_of<spec::AreaLightEmission>;
          kind.irradiance = [s](double distance) { return axial_irradiance(s, distance); };
        }
      },
      shape);
  return kind;
}

std::string name_of(const spec::Light& light, std::size_t i) {
  return light.name.value_or(fmt::format("light {}", i));
}

// Adds the surface of an area light. Returns the index of its shape; nothing after an error.
template <typename Surface>
std::optional<std::uint32_t> add_surface(const spec::AreaLight<Surface>& spec, const PoseAndMotion& moving,
                                         const std::string& name, LoadContext& context, Scene& scene) {
  const std::optional surface = build(spec.surface, context);
  const auto material =
      spec.material ? find_material(*spec.material, context, scene) : black_material(context, scene);
  if (!surface || !material) return std::nullopt;
  scene.shapes.push_back(
      {name, shape_at_opening(*surface, true, scene.materials[*material], moving, context), *material});
  return static_cast<std::uint32_t>(scene.shapes.size() - 1);
}

/// Adds each kind of light to the scene.
struct LightBuilder {
  const SourcePosition& where;
  std::string name;
  std::optional<std::uint32_t> surface;  ///< Index of its shape, if it has one.
  const std::optional<spec::Motion>& motion;
  LoadContext& context;
  Scene& scene;

  void add(decltype(Light::kind) kind, const spec::Emission& emission, const LightKind& light_kind) {
    if (auto curve = build(emission, light_kind, context))
      scene.lights.push_back(
          {std::move(name), std::move(kind), *std::move(curve), polarisation_of(emission)});
  }
  // Motion of a point light in a scene that has been recentred.
  [[nodiscard]] PoseAndMotion point_motion() const {
    const std::size_t before = context.motions.size();
    PoseAndMotion moving = build(motion, context);
    if (context.motions.size() > before) context.motions.back()->recentre(scene.origin_m);
    return moving;
  }
  [[nodiscard]] Imath::V3f position(const Imath::V3d& at, const PoseAndMotion& moving) const {
    return Imath::V3f(at * context.unit_m * moving.pose_at_opening - scene.origin_m);
  }
  // Reports a motion of a light at infinity, and returns true then.
  [[nodiscard]] bool refuse_to_move() const {
    if (motion) context.diagnostics.error(motion->where, "a light at infinity cannot move");
    return motion.has_value();
  }

  void operator()(std::monostate) const {}
  template <typename Surface>
  void operator()(const spec::AreaLight<Surface>& spec) {
    if (surface) add_area_light(spec.emission, spec.two_sided, *surface, context, scene);
  }
  void operator()(const spec::PointLightSource& spec) {
    const PoseAndMotion moving = point_motion();
    add(PointLight{position(spec.source.at, moving), moving.motion}, spec.emission,
        {schema::fields_of<spec::PointEmission>, CurveUnit::spectral_intensity, 4 * std::numbers::pi,
         inverse_square});
  }
  void operator()(const spec::SpotLightSource& spec) {
    // The cap of the cone is 1 - cos a = 2 sin^2(a/2) for the half-angle a. This form has no cancellation.
    const double sine = std::sin(spec.source.half_angle_deg * std::numbers::pi / 360);
    const PoseAndMotion moving = point_motion();
    const Imath::V3d axis = moved_direction(spec.source.direction.normalized(), moving.pose_at_opening);
    const SpotLight spot{position(spec.source.at, moving), Imath::V3f(axis),
                         static_cast<float>(2 * sine * sine), moving.motion};
    const double solid_angle = 2 * std::numbers::pi * static_cast<double>(spot.cap);
    add(spot, spec.emission,
        {schema::fields_of<spec::PointEmission>, CurveUnit::spectral_intensity, solid_angle, inverse_square});
  }
  void operator()(const spec::PhotometricLightSource& spec) {
    using enum spec::Quantity;
    const auto distribution = read_photometric_file(spec.source.file, context);
    const Imath::V3d axis = spec.source.axis.normalized();
    const Imath::V3d c0 = spec.source.c0.normalized() - axis * axis.dot(spec.source.c0.normalized());
    if (!(c0.length() > 1e-6))
      return context.diagnostics.error(where, "c0 must not be parallel to the axis of the luminaire");
    if (!distribution) return;
    const double on_axis = static_cast<double>(distribution->relative_intensity({0, 0, 1}));
    spec::Emission emission = spec.emission;
    const bool scaled = !std::holds_alternative<std::monostate>(emission.scale);
    const bool by_flux = std::holds_alternative<spec::Amount<radiant_flux>>(emission.scale) ||
                         std::holds_alternative<spec::Amount<luminous_flux>>(emission.scale);
    if (scaled && !by_flux && !(on_axis > 0))
      return context.diagnostics.error(
          emission.where, "the luminaire emits nothing along its axis: scale its emission by a flux");
    if (!scaled && !std::holds_alternative<spec::SpectralFlux>(emission.spectrum))
      emission.scale = spec::Amount<luminous_flux>{{distribution->luminous_flux()}};
    const PoseAndMotion moving = point_motion();
    const auto posed = [&moving](const Imath::V3d& direction) {
      return Imath::V3f(moved_direction(direction, moving.pose_at_opening));
    };
    add(PhotometricLight{position(spec.source.at, moving), posed(axis), posed(c0.normalized()), distribution,
                         moving.motion},
        emission,
        {schema::fields_of<spec::PointEmission>, CurveUnit::spectral_intensity, 4 * std::numbers::pi,
         [on_axis](double distance) { return on_axis * inverse_square(distance); }});
  }
  // Adds a light at infinity. Without an emission its own strength applies, with the spectrum D65.
  void add_from_infinity(decltype(Light::kind) kind, const spec::DaylightStrength& strength,
                         const spec::Emission* emission, const LightKind& light_kind) {
    if (refuse_to_move()) return;
    const auto* irradiance = std::get_if<spec::DaylightIrradiance>(&strength);
    const auto* illuminance = std::get_if<spec::DaylightIlluminance>(&strength);
    const SourcePosition& strength_where = irradiance    ? irradiance->where
                                           : illuminance ? illuminance->where
                                                         : where;
    if (emission != nullptr) return add(std::move(kind), *emission, light_kind);
    spec::Emission daylight;
    daylight.where = strength_where;
    daylight.spectrum = spec::Illuminant{{{"D65"}, strength_where}};
    if (irradiance) daylight.scale = spec::Amount<spec::Quantity::irradiance>{{irradiance->value}};
    if (illuminance) daylight.scale = spec::Amount<spec::Quantity::illuminance>{{illuminance->value}};
    add(std::move(kind), daylight, light_kind);
  }
  void operator()(const spec::DirectionalLightSource& spec) {
    add_from_infinity(DirectionalLight{Imath::V3f(spec.source.towards.normalized())}, spec.source.strength,
                      spec.emission ? &*spec.emission : nullptr,
                      {schema::fields_of<spec::DirectionalLightEmission>, CurveUnit::spectral_irradiance, 0,
                       [](double) { return 1.0; }});
  }
  void operator()(const spec::SunLightSource& spec) {
    // The cap of the disc is 1 - cos a = 2 sin^2(a/2) for the angular radius a.
    const double sine = std::sin(spec.source.angular_diameter_deg * std::numbers::pi / 720);
    const SunLight sun{Imath::V3f(spec.source.towards.normalized()), static_cast<float>(2 * sine * sine)};
    const double of_unit = sun.projected_solid_angle();
    add_from_infinity(sun, spec.source.strength, spec.emission ? &*spec.emission : nullptr,
                      {schema::fields_of<spec::SunEmission>, CurveUnit::spectral_radiance, 0,
                       [of_unit](double) { return of_unit; }});
  }
  void operator()(const spec::EnvironmentLightSource& spec) {
    if (refuse_to_move()) return;
    auto environment = build(spec.source, context);
    for (const Light& light : scene.lights)
      if (light.is_environment())
        return context.diagnostics.error(
            spec.source.where,
            fmt::format("a scene has at most one environment light (got another besides \"{}\")",
                        light.name));
    if (!environment) return;
    auto curve =
        build(spec.emission,
              {schema::fields_of<spec::EnvironmentLightEmission>, CurveUnit::spectral_radiance, 0}, context);
    if (!curve) return;
    EnvironmentLight light;
    if (!environment->texels.empty())
      light.image = std::make_shared<const EnvironmentImage>(
          environment->width, environment->height, std::move(environment->texels), environment->frame,
          curve->curve(), scene.channels);
    scene.lights.push_back(
        {std::move(name), std::move(light), *std::move(curve), polarisation_of(spec.emission)});
  }
};

}  // namespace

void add_area_light(const spec::Emission& emission, bool two_sided, std::uint32_t shape, LoadContext& context,
                    Scene& scene) {
  const ShapeInstance& instance = scene.shapes[shape];
  if (is_boundary(scene.materials[instance.material])) {
    context.diagnostics.error(emission.where, "a medium has no surface that could emit");
    return;
  }
  auto curve = build(emission, area_light_kind(instance.shape, two_sided), context);
  if (!curve) return;
  scene.lights.push_back(
      {instance.name, AreaLight{shape, two_sided}, std::move(*curve), polarisation_of(emission)});
}

AreaLightShapes build_area_light_shapes(const std::vector<spec::Light>& lights, LoadContext& context,
                                        Scene& scene) {
  AreaLightShapes surfaces(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto add = [&](const auto& kind) {
      if constexpr (requires { kind.surface; })
        surfaces[i] =
            add_surface(kind, build(lights[i].motion, context), name_of(lights[i], i), context, scene);
    };
    std::visit(add, lights[i].kind);
    context.shape_positions.resize(scene.shapes.size(), lights[i].where);
  }
  return surfaces;
}

void build_lights(const std::vector<spec::Light>& lights, const AreaLightShapes& surfaces,
                  LoadContext& context, Scene& scene) {
  for (std::size_t i = 0; i < lights.size(); ++i)
    std::visit(
        LightBuilder{lights[i].where, name_of(lights[i], i), surfaces[i], lights[i].motion, context, scene},
        lights[i].kind);
}

}  // namespace abbe::description
