#include "description/light.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr Range kDiameter{0.01, 60};   // degrees: what looks smaller is as good as directional
constexpr Range kHalfAngle{0.1, 180};  // degrees: below, a float's cosine no longer tells cones apart

constexpr char kEmission[] = "What the light sends out.";
constexpr char kTowards[] = "Direction from the scene to where the light comes from, of any length.";

template <typename T>
Field strength(DaylightStrength T::*member) {
  return at_most_one(
      member, "a light has one strength",
      under<DaylightIrradiance>(
          "irradiance", number(kPower),
          "Of a surface that faces the light [W/m2] over 300-1100 nm, as D65; in place of an emission."),
      under<DaylightIlluminance>("illuminance", number(kPower),
                                 "Of a surface that faces the light [lx], as D65; in place of an emission."));
}

template <typename Surface>
Fields describe_lamp(std::string_view key, std::string_view name, std::string_view text) {
  using Lamp = AreaLamp<Surface>;
  return describe<Lamp>(
      name, "",
      {field(key, &Lamp::surface, thing<Surface>(), text),
       field("emission", &Lamp::emission, thing<LampEmission>(), kEmission),
       field("two_sided", &Lamp::two_sided, boolean(), "Whether it emits from both sides.").or_default(),
       field("material", &Lamp::material, schema::text(), "Material of its surface; black when absent.")});
}

}  // namespace

static const Fields& fields(Tag<AreaLamp<Quad>>) {
  static const Fields kFields = describe_lamp<Quad>("quad", "quad_lamp", "The light is a parallelogram.");
  return kFields;
}
static const Fields& fields(Tag<AreaLamp<Sphere>>) {
  static const Fields kFields = describe_lamp<Sphere>("sphere", "sphere_lamp", "The light is a sphere.");
  return kFields;
}
static const Fields& fields(Tag<AreaLamp<Disc>>) {
  static const Fields kFields = describe_lamp<Disc>("disc", "disc_lamp", "The light is a disc.");
  return kFields;
}

static const Fields& fields(Tag<Point>) {
  static const Fields kFields =
      describe<Point>("point", "A point that sends out the same intensity everywhere.",
                      {field("at", &Point::at, point(), "Its position.")});
  return kFields;
}
static const Fields& fields(Tag<PointLamp>) {
  static const Fields kFields =
      describe<PointLamp>("point_lamp", "",
                          {field("point", &PointLamp::point, thing<Point>(), "The light is a point."),
                           field("emission", &PointLamp::emission, thing<PointEmission>(), kEmission)});
  return kFields;
}

static const Fields& fields(Tag<Spot>) {
  static const Fields kFields = describe<Spot>(
      "spot", "A point that sends out the same intensity within a cone, and none outside.",
      {field("at", &Spot::at, point(), "Its position."),
       field("direction", &Spot::direction, direction(), "Axis of the cone."),
       field("half_angle_deg", &Spot::half_angle_deg, number(kHalfAngle), "Angle between axis and cone.")});
  return kFields;
}
static const Fields& fields(Tag<SpotLamp>) {
  static const Fields kFields =
      describe<SpotLamp>("spot_lamp", "",
                         {field("spot", &SpotLamp::spot, thing<Spot>(), "The light is a spot."),
                          field("emission", &SpotLamp::emission, thing<PointEmission>(), kEmission)});
  return kFields;
}

static const Fields& fields(Tag<Beam>) {
  static const Fields kFields =
      describe<Beam>("directional", "A parallel beam from infinity.",
                     {field("towards", &Beam::towards, direction(), kTowards), strength(&Beam::strength)});
  return kFields;
}
static const Fields& fields(Tag<BeamLamp>) {
  static const Fields kFields = describe<BeamLamp>(
      "beam_lamp", "",
      {field("directional", &BeamLamp::beam, thing<Beam>(), "The light is a parallel beam."),
       field("emission", &BeamLamp::emission, thing<BeamEmission>(), kEmission)});
  return kFields;
}

static const Fields& fields(Tag<Sun>) {
  static const Fields kFields = describe<Sun>(
      "sun",
      "A disc at infinity of the same radiance all over, seen by cameras, in mirrors and through glass.",
      {field("towards", &Sun::towards, direction(), kTowards),
       field("angular_diameter_deg", &Sun::angular_diameter_deg, number(kDiameter), "How large it looks.")
           .or_default(),
       strength(&Sun::strength)});
  return kFields;
}
static const Fields& fields(Tag<SunLamp>) {
  static const Fields kFields =
      describe<SunLamp>("sun_lamp", "",
                        {field("sun", &SunLamp::sun, thing<Sun>(), "The light is a sun."),
                         field("emission", &SunLamp::emission, thing<SunEmission>(), kEmission)});
  return kFields;
}

static const Fields& fields(Tag<Sky>) {
  static const Fields kFields =
      describe<Sky>("environment", "The same radiance from all directions, or an image's; one per scene.",
                    {field("image", &Sky::image, text(),
                           "An equirectangular EXR or HDR file with linear channels R, G, B, or Y."),
                     field("up", &Sky::up, direction(), "Direction of its top row, [0, 0, 1] when absent."),
                     field("rotate_deg", &Sky::rotate_deg, number(kValue),
                           "Right-handed turn about `up`, 0 when absent.")});
  return kFields;
}
static const Fields& fields(Tag<SkyLamp>) {
  static const Fields kFields = describe<SkyLamp>(
      "sky_lamp", "",
      {field("environment", &SkyLamp::sky, thing<Sky>(), "The light comes from all around."),
       field("emission", &SkyLamp::emission, thing<SkyEmission>(), kEmission)});
  return kFields;
}

const Fields& fields(Tag<Light>) {
  static const Fields kFields = describe<Light>(
      "light", "A light.",
      {field("name", &Light::name, text(), "For messages, and to name it as a white."),
       one_of(&Light::kind, beside<AreaLamp<Quad>>("quad"), beside<AreaLamp<Sphere>>("sphere"),
              beside<AreaLamp<Disc>>("disc"), beside<PointLamp>("point"), beside<SpotLamp>("spot"),
              beside<BeamLamp>("directional"), beside<SunLamp>("sun"), beside<SkyLamp>("environment"))});
  return kFields;
}

Kind lights() {
  return list<Light>(thing<Light>(), "lights", 0);
}

}  // namespace abbe::spec
