#include "description/light.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "description/material.h"
#include "description/shape.h"
#include "scene/shapes/quad.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr Range kDiameter = Range{0.01, 60}.in("degrees");  // what looks smaller is as good as directional
constexpr Range kHalfAngle =
    Range{0.1, 180}.in("degrees");  // below, a float's cosine no longer tells cones apart

constexpr char kTowards[] = "Direction from the scene to where the light comes from, of any length.";

template <typename T>
Field strength(DaylightStrength T::*member) {
  return at_most_one(
      member, "a light has one strength",
      under<DaylightIrradiance>(
          "irradiance", kPower.in("W/m2"),
          "Of a surface that faces the light, over 300-1100 nm, as D65; in place of an emission."),
      under<DaylightIlluminance>("illuminance", kPower.in("lx"),
                                 "Of a surface that faces the light, as D65; in place of an emission."));
}

// Where a light may say how strong it is: in its emission, which most need.
std::vector<std::string_view> strengths(const auto&) {
  return {};
}
std::vector<std::string_view> strengths(const Beam&) {
  return {"emission", "directional/irradiance", "directional/illuminance"};
}
std::vector<std::string_view> strengths(const Sun&) {
  return {"emission", "sun/irradiance", "sun/illuminance"};
}

}  // namespace

// The name of what shines is its key.
template <typename Source, typename Emission>
Fields fields(Tag<Lamp<Source, Emission>>) {
  using L = Lamp<Source, Emission>;
  return describe("", "", {field(fields_of<Source>().name, &L::source), field("emission", &L::emission)},
                  strengths(Source{}), true);
}
template <typename Surface>
Fields fields(Tag<AreaLamp<Surface>>) {
  using L = AreaLamp<Surface>;
  return describe("", "",
                  {field(fields_of<Surface>().name, &L::surface), field("emission", &L::emission),
                   defaulted("two_sided", &L::two_sided, "Whether it emits from both sides."),
                   field("material", &L::material, "Material of its surface; black when absent.")});
}

static Fields fields(Tag<Point>) {
  return describe("point", "A point that sends out the same intensity everywhere.",
                  {field("at", &Point::at, kCoordinate, "Its position.")});
}

static Fields fields(Tag<Spot>) {
  return describe(
      "spot", "A point that sends out the same intensity within a cone, and none outside.",
      {field("at", &Spot::at, kCoordinate, "Its position."),
       field("direction", &Spot::direction, direction(), "Axis of the cone."),
       field("half_angle_deg", &Spot::half_angle_deg, kHalfAngle, "Angle between axis and cone.")});
}

static Fields fields(Tag<Beam>) {
  return describe("directional", "A parallel beam from infinity.",
                  {field("towards", &Beam::towards, direction(), kTowards), strength(&Beam::strength)});
}

static Fields fields(Tag<Sun>) {
  return describe(
      "sun",
      "A disc at infinity of the same radiance all over, seen by cameras, in mirrors and through glass.",
      {field("towards", &Sun::towards, direction(), kTowards),
       defaulted("angular_diameter_deg", &Sun::angular_diameter_deg, kDiameter, "How large it looks."),
       strength(&Sun::strength)});
}

static Fields fields(Tag<SkyImage>) {
  return describe("", "",
                  {field("image", &SkyImage::file,
                         "An equirectangular EXR or HDR file with linear Rec.709 channels R, G, B, or Y."),
                   defaulted("up", &SkyImage::up, direction(), "Direction of its top row."),
                   defaulted("rotate_deg", &SkyImage::rotate_deg, kAngle, "Right-handed turn about `up`.")});
}
static Fields fields(Tag<Sky>) {
  return describe("environment", "The same radiance from all directions, or an image's; one per scene.",
                  {at_most_one(&Sky::image, "", beside<SkyImage>("image"))});
}

Fields fields(Tag<Light>) {
  return describe(
      "light", "A light.",
      {field("name", &Light::name, "For messages, and to name it as a white."),
       one_of(&Light::kind, beside<AreaLamp<Quad>>("quad"), beside<AreaLamp<Sphere>>("sphere"),
              beside<AreaLamp<Disc>>("disc"), beside<PointLamp>("point"), beside<SpotLamp>("spot"),
              beside<BeamLamp>("directional"), beside<SunLamp>("sun"), beside<SkyLamp>("environment")),
       field("motion", &Light::motion,
             "How it moves, from where it is described; light from infinity does not.")});
}

}  // namespace abbe::spec

namespace abbe::description {
namespace {

double inverse_square(double distance) {
  return 1 / (distance * distance);
}

// Of a surface on the axis that faces the lamp, for unit radiance [sr]; 0 within it.
double axial_irradiance(const Sphere& sphere, double distance) {
  const double sine = sphere.radius / distance;
  return sine < 1 ? std::numbers::pi * sine * sine : 0;
}
double axial_irradiance(const Disc& disc, double distance) {
  const double r2 = disc.radius * disc.radius;
  return std::numbers::pi * r2 / (r2 + distance * distance);
}
// Half the sum over the edges of the angle each takes up, times how it leans [Lambert1760]: with a and b from
// the middle to the corners and n the normal, the plane through an edge and the point has the normal (a + n
// d) x (b + n d), whose part along n is that of a x b. Taken so, nothing cancels however far the point is.
double axial_irradiance(const Quad& quad, double distance) {
  const Imath::V3d normal = normal_of(quad);
  const Imath::V3d first = (quad.edge_u + quad.edge_v) / -2;
  const std::array corners{first, first + quad.edge_u, -first, first + quad.edge_v};
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Imath::V3d& a = corners.at(i);
    const Imath::V3d& b = corners.at((i + 1) % corners.size());
    const double along = a.cross(b).dot(normal);
    const double across = std::hypot(along, distance * (b - a).length());
    sum += std::atan2(across, a.dot(b) + distance * distance) * along / across;
  }
  return std::abs(sum) / 2;
}

LampKind area_lamp(const Shape& shape, bool two_sided) {
  LampKind kind{schema::fields_of<spec::MeshEmission>, CurveUnit::spectral_radiance,
                std::numbers::pi * area(shape) * (two_sided ? 2 : 1)};
  const auto lamp = [&kind](const auto& plain_shape) {
    kind.fields = schema::fields_of<spec::LampEmission>;
    kind.irradiance = [plain_shape](double distance) { return axial_irradiance(plain_shape, distance); };
  };
  if (const auto* sphere = plain<Sphere>(shape)) lamp(*sphere);
  if (const auto* disc = plain<Disc>(shape)) lamp(*disc);
  if (const auto* quad = plain<Quad>(shape)) lamp(*quad);
  return kind;
}

std::string name_of(const spec::Light& light, std::size_t i) {
  return light.name.value_or(fmt::format("light {}", i));
}

// Adds the surface of a lamp, which it tells the number of; nothing after an error.
template <typename Surface>
std::optional<std::uint32_t> add_surface(const spec::AreaLamp<Surface>& said, const Moving& moving,
                                         const std::string& name, LoadContext& context, Scene& scene) {
  const std::optional surface = build(said.surface, context);
  const auto material =
      said.material ? find_material(*said.material, context, scene) : black_material(context, scene);
  if (!surface || !material) return std::nullopt;
  scene.shapes.push_back(
      {name, in_motion(*surface, true, scene.materials[*material], moving, context), *material});
  return static_cast<std::uint32_t>(scene.shapes.size() - 1);
}

/// Adds each kind of light to the scene.
struct LightBuilder {
  const SourcePosition& where;
  std::string name;
  std::optional<std::uint32_t> surface;  ///< Its shape, if it has one.
  const std::optional<spec::Motion>& motion;
  LoadContext& context;
  Scene& scene;

  void add(decltype(Light::kind) kind, const spec::Emission& emission, const LampKind& lamp) {
    if (auto curve = build(emission, lamp, context))
      scene.lights.push_back(
          {std::move(name), std::move(kind), *std::move(curve), polarisation_of(emission)});
  }
  // Of a lamp at a point, in a scene that has been recentred.
  [[nodiscard]] Moving moving_point() const {
    const std::size_t before = context.motions.size();
    Moving moving = build(motion, context);
    if (context.motions.size() > before) context.motions.back()->recentre(scene.origin_m);
    return moving;
  }
  [[nodiscard]] Imath::V3f position(const Imath::V3d& at, const Moving& moving) const {
    return Imath::V3f(at * context.unit_m * moving.opening - scene.origin_m);
  }
  // Whether light from infinity is asked to move.
  [[nodiscard]] bool refuse_to_move() const {
    if (motion) context.diagnostics.error(motion->where, "light from infinity does not move");
    return motion.has_value();
  }

  void operator()(std::monostate) const {}
  template <typename Surface>
  void operator()(const spec::AreaLamp<Surface>& said) {
    if (surface) add_area_light(said.emission, said.two_sided, *surface, context, scene);
  }
  void operator()(const spec::PointLamp& said) {
    const Moving moving = moving_point();
    add(PointLight{position(said.source.at, moving), moving.motion}, said.emission,
        {schema::fields_of<spec::PointEmission>, CurveUnit::spectral_intensity, 4 * std::numbers::pi,
         inverse_square});
  }
  void operator()(const spec::SpotLamp& said) {
    const double sine = std::sin(said.source.half_angle_deg * std::numbers::pi / 360);
    const Moving moving = moving_point();
    Imath::V3d axis;
    moving.opening.multDirMatrix(said.source.direction.normalized(), axis);
    const SpotLight spot{position(said.source.at, moving), Imath::V3f(axis),
                         static_cast<float>(2 * sine * sine), moving.motion};
    const double solid_angle = 2 * std::numbers::pi * static_cast<double>(spot.cap);
    add(spot, said.emission,
        {schema::fields_of<spec::PointEmission>, CurveUnit::spectral_intensity, solid_angle, inverse_square});
  }
  // A light from infinity may say its strength itself, by daylight, without an emission beside it.
  void add_from_infinity(decltype(Light::kind) kind, const spec::DaylightStrength& strength,
                         const spec::Emission* emission, const LampKind& lamp) {
    if (refuse_to_move()) return;
    const auto* irradiance = std::get_if<spec::DaylightIrradiance>(&strength);
    const auto* illuminance = std::get_if<spec::DaylightIlluminance>(&strength);
    const SourcePosition& own = irradiance ? irradiance->where : illuminance ? illuminance->where : where;
    if (emission != nullptr) return add(std::move(kind), *emission, lamp);
    spec::Emission daylight;
    daylight.where = own;
    daylight.spectrum = spec::Illuminant{{{"D65"}, own}};
    if (irradiance) daylight.scale = spec::Amount<spec::Quantity::irradiance>{{irradiance->value}};
    if (illuminance) daylight.scale = spec::Amount<spec::Quantity::illuminance>{{illuminance->value}};
    add(std::move(kind), daylight, lamp);
  }
  void operator()(const spec::BeamLamp& said) {
    add_from_infinity(DirectionalLight{Imath::V3f(said.source.towards.normalized())}, said.source.strength,
                      said.emission ? &*said.emission : nullptr,
                      {schema::fields_of<spec::BeamEmission>, CurveUnit::spectral_irradiance, 0,
                       [](double) { return 1.0; }});
  }
  void operator()(const spec::SunLamp& said) {
    const double sine = std::sin(said.source.angular_diameter_deg * std::numbers::pi / 720);
    const SunLight sun{Imath::V3f(said.source.towards.normalized()), static_cast<float>(2 * sine * sine)};
    const double of_unit = sun.projected_solid_angle();
    add_from_infinity(sun, said.source.strength, said.emission ? &*said.emission : nullptr,
                      {schema::fields_of<spec::SunEmission>, CurveUnit::spectral_radiance, 0,
                       [of_unit](double) { return of_unit; }});
  }
  void operator()(const spec::SkyLamp& said) {
    if (refuse_to_move()) return;
    auto sky = build(said.source, context);
    for (const Light& light : scene.lights)
      if (light.is_environment())
        return context.diagnostics.error(
            said.source.where,
            fmt::format("a scene has one environment (got another beside \"{}\")", light.name));
    if (!sky) return;
    auto curve = build(said.emission, {schema::fields_of<spec::SkyEmission>, CurveUnit::spectral_radiance, 0},
                       context);
    if (!curve) return;
    EnvironmentLight light;
    if (!sky->texels.empty())
      light.image = std::make_shared<const EnvironmentImage>(sky->width, sky->height, std::move(sky->texels),
                                                             sky->frame, curve->curve(), scene.channels);
    scene.lights.push_back(
        {std::move(name), std::move(light), *std::move(curve), polarisation_of(said.emission)});
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
  auto curve = build(emission, area_lamp(instance.shape, two_sided), context);
  if (!curve) return;
  scene.lights.push_back(
      {instance.name, AreaLight{shape, two_sided}, std::move(*curve), polarisation_of(emission)});
}

LampSurfaces build_lamp_surfaces(const std::vector<spec::Light>& lights, LoadContext& context, Scene& scene) {
  LampSurfaces surfaces(lights.size());
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto add = [&](const auto& kind) {
      if constexpr (requires { kind.surface; })
        surfaces[i] =
            add_surface(kind, build(lights[i].motion, context), name_of(lights[i], i), context, scene);
    };
    std::visit(add, lights[i].kind);
    context.shape_places.resize(scene.shapes.size(), lights[i].where);
  }
  return surfaces;
}

void build_lights(const std::vector<spec::Light>& lights, const LampSurfaces& surfaces, LoadContext& context,
                  Scene& scene) {
  for (std::size_t i = 0; i < lights.size(); ++i)
    std::visit(
        LightBuilder{lights[i].where, name_of(lights[i], i), surfaces[i], lights[i].motion, context, scene},
        lights[i].kind);
}

}  // namespace abbe::description
