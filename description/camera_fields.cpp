#include "description/camera.h"
#include "description/kinds.h"

namespace abbe::spec {
namespace {

using namespace schema;

constexpr Range kFNumber{0, 1e6, true, false};

}  // namespace

static const Fields& fields(Tag<Aperture>) {
  static const Fields kFields =
      describe<Aperture>("aperture", "How much light a lens passes.",
                         {field("f_number", &Aperture::f_number, number(kFNumber),
                                "Focal length over the diameter of the opening; of a pinhole, which is sharp "
                                "everywhere, it sets the exposure only."),
                          field("t_stop", &Aperture::t_stop, number(kFNumber),
                                "f-number over the root of the lens's transmittance, at least the f-number: "
                                "it exposes as a lens without losses "
                                "of that f-number does, and alone stands for both.")});
  return kFields;
}

static const Fields& fields(Tag<Pinhole>) {
  static const Fields kFields = describe<Pinhole>(
      "pinhole", "A camera without a lens, sharp everywhere.",
      {one_of(&Pinhole::view,
              under<FocalLength>("focal_length", length(), "Distance from the hole to the film."),
              under<FieldOfView>("fov_deg", number({0, 180, true, true}),
                                 "Field of view along the shorter image axis.")),
       lent(&Pinhole::aperture)});
  return kFields;
}

static const Fields& fields(Tag<ThinLens>) {
  using Focus = std::variant<double, Far>;
  static const Fields kFields = describe<ThinLens>(
      "thin_lens", "A camera with an ideal lens.",
      {field("focal_length", &ThinLens::focal_length, length(), "The focal length."),
       lent(&ThinLens::aperture),
       field("focus_distance", &ThinLens::focus_distance,
             forms<Focus>("", "a distance", form<Far>(Json::text, word<Far>("distance", {"infinity"})),
                          form<double>(Json::any, length())),
             "Distance from the lens to the plane in focus, beyond the focal length; that from `from` to "
             "`to` when absent.")},
      {"f_number", "t_stop"});
  return kFields;
}

static const Fields& fields(Tag<View>) {
  static const Fields kFields =
      describe<View>("view", "Where a camera stands.",
                     {field("from", &View::from, point(), "Position of the camera."),
                      field("to", &View::to, point(), "Position it looks at."),
                      field("up", &View::up, direction(), "Direction that is up in the image.")});
  return kFields;
}

static const Fields& fields(Tag<PinholeCamera>) {
  static const Fields kFields = describe<PinholeCamera>(
      "pinhole_camera", "",
      {field("pinhole", &PinholeCamera::pinhole, thing<Pinhole>(), "The camera is a pinhole."),
       lent(&PinholeCamera::view)});
  return kFields;
}

static const Fields& fields(Tag<ThinLensCamera>) {
  static const Fields kFields = describe<ThinLensCamera>(
      "thin_lens_camera", "",
      {field("thin_lens", &ThinLensCamera::lens, thing<ThinLens>(), "The camera has a thin lens."),
       lent(&ThinLensCamera::view)});
  return kFields;
}

static const Fields& fields(Tag<PointProbe>) {
  static const Fields kFields = describe<PointProbe>(
      "point_probe", "",
      {field("at", &PointProbe::at, point(), "Position of a point that measures irradiance."),
       field("normal", &PointProbe::normal, direction(), "Direction the point faces.")});
  return kFields;
}

static const Fields& fields(Tag<IrradianceProbe>) {
  static const Fields kFields = describe<IrradianceProbe>(
      "irradiance_probe", "A meter of irradiance.",
      {one_of(
          &IrradianceProbe::surface, beside<PointProbe>("at"),
          under<Quad>(
              "quad", thing<Quad>(),
              "A parallelogram that measures irradiance, one patch per pixel; it faces edge_u x edge_v."))});
  return kFields;
}

const Fields& fields(Tag<Camera>) {
  static const Fields kFields = describe<Camera>(
      "camera", "What looks at the scene.",
      {one_of(&Camera::kind, beside<PinholeCamera>("pinhole"), beside<ThinLensCamera>("thin_lens"),
              under<IrradianceProbe>("irradiance_probe", thing<IrradianceProbe>(),
                                     "The camera is a meter of irradiance."))});
  return kFields;
}

}  // namespace abbe::spec
